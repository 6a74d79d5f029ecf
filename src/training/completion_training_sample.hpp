// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <functional>
#include <vector>

#include "networks/completion_shape.hpp"

namespace rhizodont {

/// One pair for the training of the completion network, in the canonical pose (unit 12 mm): what inference would see of
/// a crown, and the tooth it belongs to.
struct CompletionTrainingSample {
  std::vector<Eigen::Vector3f> input;    ///< points on the cropped crown, any order, no duplicates
  std::vector<Eigen::Vector3f> target;   ///< points on the whole tooth, area-uniform, any order
  std::vector<Eigen::Vector3f> normals;  ///< unit outward normals of `target`
  std::vector<std::uint8_t> is_root;     ///< 1 where a target point is on the part that the crop took away
  int type = unknown_type;               ///< 0..15, or unknown_type
  /// x and y of the axis of the crown's form, as laying the type's mean crown on it would say: by how much that form
  /// leans against the border, which gives z.
  Eigen::Vector2f form_axis = Eigen::Vector2f::Zero();

  /// Points of the whole tooth that correspond: in all samples of a type that have them, the same index is the same
  /// anatomical place, and they are equally many. Empty where no correspondence is known.
  std::vector<Eigen::Vector3f> matched;
  std::vector<Eigen::Vector3f> matched_normals;  ///< unit outward normals of `matched`
  std::vector<std::uint8_t> matched_root;        ///< 1 for places on the root, 0 on the crown
};

/// The training pair number `index`: the same index always gives the same sample. Called from several threads at once.
using CompletionSampleProvider = std::function<CompletionTrainingSample(std::uint64_t index)>;

}  // namespace rhizodont
