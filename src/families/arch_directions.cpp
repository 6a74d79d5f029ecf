// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_directions.hpp"

#include <Eigen/Geometry>

namespace rhizodont {

Eigen::Vector3d buccal_direction(const std::vector<Eigen::Vector3d>& arch, std::size_t i) {
  const Eigen::Vector3d before = i == 0 ? Eigen::Vector3d(-arch[1].x(), arch[1].y(), arch[1].z()) : arch[i - 1];
  const Eigen::Vector3d after = i + 1 < arch.size() ? arch[i + 1] : arch[i];
  Eigen::Vector3d along = after - before;  // towards the back of the left side
  along.y() = 0;
  return Eigen::Vector3d(-along.z(), 0, along.x()).normalized();
}

}  // namespace rhizodont
