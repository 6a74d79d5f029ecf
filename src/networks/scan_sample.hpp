// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/scan_shape.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace rhizodont {

inline constexpr int scan_curvature_count = 2;

/// Points that cover a scan's surface evenly and more densely than the network's finest level, in its frame: z towards
/// the other jaw, y to the front as far as known, origin in the middle; millimetres.
struct ScanCloud {
  std::vector<float> positions;   ///< 3 per point
  std::vector<float> normals;     ///< 3 per point, unit, outward
  std::vector<float> curvatures;  ///< scan_curvature_count per point, about -3..3

  std::size_t size() const { return positions.size() / 3; }
};

/// What a vertex can be: 0 gum and all else, 1..8 a tooth by its place from the middle of the arch on the side of the
/// frame's -x, 9..16 on the side of +x.
inline constexpr int scan_kind_count = 17;
/// Columns of what the network says of each point: kinds, offset to the middle of its tooth (3, in units of
/// scan_offset_mm), border (whether another kind or tooth lies within scan_border_mm).
inline constexpr int scan_output_count = scan_kind_count + 4;
inline constexpr float scan_offset_mm = 5;
inline constexpr float scan_border_mm = 1.1F;
/// And of the scan: whether it is an upper jaw, direction to the front (3), direction to the other jaw (3).
inline constexpr int scan_summary_count = 7;

/// Points of one level. Indices "below" are of the next finer level, for the finest of the cloud.
struct ScanLevel {
  std::vector<std::int32_t> from;         ///< per point: itself below
  std::vector<float> positions, normals;  ///< 3 per point
  std::vector<std::int32_t> neighbours;   ///< `ScanShape::neighbours` per point, itself first
  std::vector<std::int32_t> below;        ///< as many, around it below; empty for the finest level
  std::vector<std::int32_t> above;   ///< 3 per point: those of the next coarser level around it; empty for the last
  std::vector<float> above_weights;  ///< 3 per point, sum 1

  std::size_t size() const { return from.size(); }
};

inline constexpr int scan_feature_count = 6 + scan_curvature_count;

/// What the network looks at.
struct ScanPyramid {
  std::vector<float> features;  ///< scan_feature_count per point of the finest level
  std::array<ScanLevel, ScanShape::levels> levels;
};

/// Throws InputError for arrays that do not fit, values that are not finite and for a cloud without points.
ScanPyramid scan_pyramid(const ScanCloud& cloud, const ScanShape& shape);

/// Turns points about their frame's origin. Which of them a pyramid has, and who is whose neighbour, stays as it is: it
/// does not hang on how the points were turned.
void turn(const Eigen::Matrix3d& rotation, ScanCloud& cloud);
void turn(const Eigen::Matrix3d& rotation, ScanPyramid& pyramid);

/// Positions over this and normals go with the features into each level's edges.
inline float scan_edge_unit(const ScanShape& shape, std::size_t level) {
  return 2e-3F * static_cast<float>(shape.spacings_um[level]);
}

}  // namespace rhizodont
