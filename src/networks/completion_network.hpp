// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rhizodont {

/// A completed tooth in the canonical pose (unit 12 mm).
struct CompletedPoints {
  std::vector<Eigen::Vector3f> points;   ///< on the whole tooth, crown included, denser on the root
  std::vector<Eigen::Vector3f> normals;  ///< unit length, outward; as many as points
  std::vector<float> spread;             ///< > 0: how far off a point is expected to be, on average
};

/// A crown as the network takes it: see CompletionNetwork::complete.
struct CrownPoints {
  std::vector<Eigen::Vector3f> points;
  int type = 0;
  Eigen::Vector2f form_axis = Eigen::Vector2f::Zero();
};

/// The completion network with its weights: crown points in, points of the whole tooth out (AdaPoinTr, see
/// `learning/adapointr.hpp` for how it differs from the published one). Holds no state besides the weights: `complete`
/// may be called from several threads at once.
class CompletionNetwork {
 public:
  /// Reads weights written by the trainer. Throws InputError if the file is unreadable, damaged or of another network.
  static CompletionNetwork load(const std::filesystem::path& path);

  CompletionNetwork(CompletionNetwork&&) noexcept;
  CompletionNetwork& operator=(CompletionNetwork&&) noexcept;
  ~CompletionNetwork();

  /// Completes a crown. `crown`: distinct points spread over the crown's surface in the canonical pose, in any order,
  /// at least `input_points()` of them; more are thinned by farthest-point sampling. `type` is 0..15 or `unknown_type`;
  /// `form_axis`: x and y of the axis of the crown's form, where z is that of its border (`CrownFrame::form_axis`).
  /// The result depends neither on the order of the points nor on the number of threads.
  /// Throws InputError for an axis that is not a number and for too few, non-finite or coinciding points or points far
  /// outside of the pose's cube (|x| > 4), UsageError for another type, NoResultError where what comes out is no
  /// number.
  CompletedPoints complete(std::span<const Eigen::Vector3f> crown, int type, const Eigen::Vector2f& form_axis) const;

  /// The same for several crowns at once, say of an arch, side by side: in their order, each to the bit as alone.
  /// Throws as for one crown, of the first that fails.
  std::vector<CompletedPoints> complete(std::span<const CrownPoints> crowns) const;

  /// Number of crown points that the network looks at (1024 in the shipped weights).
  int input_points() const;

  /// Number of points that `complete` returns.
  int output_points() const;

  /// What the weight file says of itself: training data, figures, seed.
  const std::map<std::string, std::string>& metadata() const;

 private:
  struct Impl;
  explicit CompletionNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rhizodont
