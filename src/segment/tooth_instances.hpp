// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "segment/teeth_reading.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace rhizodont {

inline constexpr int arch_place_count = 16;

/// A tooth that was found and has no number yet.
struct ToothInstance {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< in the reading's frame
  /// Probability of each place along the arch, from the last tooth on the side of -x (0) to that on the side of +x.
  std::array<double, arch_place_count> places{};
  double support = 0;  ///< of the reading's points, each by how surely it is tooth
};

/// Teeth, and how far each point belongs to each of them.
struct ToothInstances {
  std::vector<ToothInstance> teeth;
  std::vector<double> shares;  ///< teeth.size() per point, sum 0..1: the rest is gum

  double share(std::size_t point, std::size_t tooth) const { return shares[point * teeth.size() + tooth]; }
};

struct InstanceOptions {
  double least_tooth = 0.4;             ///< 0..1: points that are tooth less surely have no vote
  double width_mm = 1.7;                ///< > 0: of the kernel under which votes gather
  double least_support = 10;            ///< fewer points are no tooth
  std::vector<Eigen::Vector3d> clicks;  ///< places, in the frame, where there is a tooth whatever the network says
};

/// Votes gather where teeth are (mean shift: D. Comaniciu, P. Meer, "Mean shift: a robust approach toward feature space
/// analysis", 2002); gatherings that mean the same tooth are joined. Each click gets a tooth of its own: that to which
/// the points beside it belong, or a new one around it.
ToothInstances find_instances(const TeethReading& reading, const InstanceOptions& options = {});

/// Kind that the network gives a tooth at a place along the arch.
inline int kind_of_place(int place) { return place < 8 ? 8 - place : place + 1; }

}  // namespace rhizodont
