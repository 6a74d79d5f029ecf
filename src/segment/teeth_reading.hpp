// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/scan_network.hpp"
#include "segment/scan_points.hpp"

#include <vector>

namespace rhizodont {

/// What a network says of a scan, and where.
struct TeethReading {
  ScanFrame frame;      ///< z towards the other jaw, y to the front, by the network
  ScanCloud cloud;      ///< the scan's surface, in the frame
  ScanPyramid pyramid;  ///< its finest level has the points that are spoken of, in this frame
  ScanReading said;

  std::size_t size() const { return pyramid.levels[0].size(); }
  Eigen::Vector3d place(std::size_t point) const;
  Eigen::Vector3d normal(std::size_t point) const;
  /// Of a kind, 0..scan_kind_count - 1.
  double probability(std::size_t point, int kind) const;
  double tooth(std::size_t point) const { return 1 - probability(point, 0); }
  /// Where the middle of the point's tooth should be, in the frame.
  Eigen::Vector3d vote(std::size_t point) const;
};

/// Reads a scan in any pose: first as its surface lies, then `turns` times anew as the network says that it stands.
/// Throws InputError for a scan without area, NoResultError where the network fails.
TeethReading read_teeth(const TriangleMesh& scan, const ScanNetwork& network, int turns = 2);

}  // namespace rhizodont
