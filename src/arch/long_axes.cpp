// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Axes of crown and root through their middles: Tong et al., Am J Orthod Dentofacial Orthop 2012;141:604.
#include "arch/neck.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/arch.hpp"

namespace rhizodont {
LongAxes long_axes(const CompletedTooth& tooth) {
  const Eigen::Vector3d& up = tooth.record.frame.growth_axis;
  const auto [lowest, highest] = extent_along(tooth.mesh.vertices, up);
  const double neck = lowest_of_crown(tooth);
  const Point middle = middle_of_border(tooth);
  const double third = lowest + (neck - lowest) / 3;
  Point sum = Point::Zero();
  double weight = 0;
  for (std::size_t t = 0; t < tooth.mesh.triangles.size(); ++t) {
    const Triangle& corners = tooth.mesh.triangles[t];
    Point centre = Point::Zero();
    for (const int v : corners) centre += tooth.mesh.vertices[static_cast<std::size_t>(v)] / 3;
    if (up.dot(centre) > third) continue;
    const double area = triangle_area(tooth.mesh, t);
    sum += area * centre;
    weight += area;
  }
  const Point end = weight > 0 ? Point(sum / weight) : Point(middle - up);
  const Point top = middle + (highest - up.dot(middle)) * up;
  return {{middle, top, up}, {middle, end, (middle - end).normalized()}};
}

}  // namespace rhizodont
