// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/tooth_classifier.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// From where on a crown is said not to be the tooth it should be. All are natural logarithms of ratios of
/// probabilities, found on generated crowns (`likeness_bounds`).
struct LikenessBounds {
  double other_tooth = 0;  ///< most probable tooth over the one it should be: above, it is said to be another
  double unlike = 0;       ///< no or little of a crown over any tooth: above, it is hardly like a tooth
  double refused = 0;      ///< likewise, >= unlike: above, it is no crown
};

/// What crowns are judged by.
struct LikenessModel {
  ToothClassifier classifier;
  LikenessBounds bounds;
  std::map<std::string, std::string> metadata;  ///< what the file says of itself
};

/// Reads weights and bounds. Throws InputError if the file is missing, damaged or of another network.
LikenessModel load_likeness(const std::filesystem::path& path);

/// Notes bounds in a file of weights (train_classifier), for `load_likeness`.
void note_bounds(const LikenessBounds& bounds, TensorFile& weights);

/// What a crown looks like.
struct Likeness {
  std::array<double, tooth_count> log_probability{};  ///< ln, among the 32 teeth
  double log_unlike = 0;  ///< ln of how much more probable it is that this is no or little of a crown

  /// ln of how much more probable the most probable tooth is than this one, >= 0. Of a third molar the other molars of
  /// its quadrant do not count: its form varies too much, and it may be like any of them.
  double lead_over(std::size_t tooth) const;
};

/// Looks at an open crown from amid its base, along its growth axis (unit). Deterministic, whatever the crown's place
/// and orientation. Throws InputError for crowns without area or border.
Likeness likeness(const TriangleMesh& open_crown, const Eigen::Vector3d& growth_axis,
                  const ToothClassifier& classifier);

/// Bounds from generated crowns that had no part in the training. Real crowns differ from generated ones in ways that
/// nobody foresaw, so each bound lies as far from the crowns as what it is there for allows: 24 of 25 strangers are
/// found and 81 of 100 wrong sides; but not nearer than lets 199 of 200 of these crowns pass.
/// @param teeth      what the crowns are, one each
/// @param strangers  what is no crown or little of one
/// Throws UsageError for less than 500 crowns, another number of teeth or less than 100 strangers.
LikenessBounds likeness_bounds(const std::vector<Likeness>& crowns, const std::vector<std::size_t>& teeth,
                               const std::vector<Likeness>& strangers);

}  // namespace rhizodont
