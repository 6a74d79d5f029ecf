// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/upward.hpp"

#include "mesh/geometry.hpp"

#include <algorithm>

namespace rhizodont {

Eigen::Vector3d upward_of(const MeshFile& file) {
  TriangleMesh crown = file.mesh;
  const auto source = file.vertex_attributes.find(source_attribute);
  if (source != file.vertex_attributes.end())
    std::erase_if(crown.triangles, [&](const Triangle& triangle) {
      return std::any_of(triangle.begin(), triangle.end(),
                         [&](std::int32_t v) { return source->second.values[static_cast<std::size_t>(v)] != 0; });
    });
  const Eigen::Vector3d sum = area_vector(crown);
  return sum.norm() > 1e-3 * surface_area(file.mesh) ? sum.normalized() : Eigen::Vector3d::UnitZ();
}

}  // namespace rhizodont
