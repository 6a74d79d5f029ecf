// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/float_bits.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

// Teeth by formula: the axis is z, the crown lies above z = 0, the roots below.
namespace rhizodont::test {

using Shift = std::function<Point(const Point&)>;

inline TriangleMesh changed(TriangleMesh mesh, const Shift& change) {
  for (Point& p : mesh.vertices) p = change(p);
  return mesh;
}

/// As a file of single precision holds it.
inline TriangleMesh as_float(const TriangleMesh& mesh) {
  return changed(
      mesh, [](const Point& p) { return Point(nearest_float(p.x()), nearest_float(p.y()), nearest_float(p.z())); });
}

/// Below the ball's equator the surface sinks into one bump per given apex (x, y, depth in mm below the ball).
inline TriangleMesh tooth_with_roots(const std::vector<Eigen::Vector3d>& apices, int levels = 5) {
  constexpr double radius = 4, width = 1.2;
  return changed(sphere(levels, radius), [&](Point p) {
    if (p.z() >= 0) return Point(1.1 * p.x(), 0.9 * p.y(), p.z() + 0.1 * p.x());
    // Nothing happens at the equator, where the wall is upright.
    const double share = std::min(1.0, -2 * p.z() / radius);
    double sink = 0;
    for (const Eigen::Vector3d& apex : apices)
      sink = std::max(sink, apex.z() * std::exp(-(p - apex).head<2>().squaredNorm() / (2 * width * width)));
    return Point(1.1 * p.x(), 0.9 * p.y(), p.z() + 0.1 * p.x() - share * sink);
  });
}

inline TriangleMesh one_rooted() { return tooth_with_roots({{0.4, -0.3, 9}}); }
inline TriangleMesh two_rooted() { return tooth_with_roots({{-2.2, 0.1, 8}, {2.1, -0.2, 7}}); }

/// The part above the equator, open at its base.
inline TriangleMesh crown_of(const TriangleMesh& tooth) {
  std::vector<bool> above;
  for (const Triangle& t : tooth.triangles)
    above.push_back(std::all_of(t.begin(), t.end(), [&](int v) {
      const Point& p = tooth.vertices[static_cast<std::size_t>(v)];
      return p.z() > 0.1 * p.x() / 1.1 - 1e-9;
    }));
  return submesh(tooth, above).mesh;
}

/// Data beside the project, which is not always there.
inline std::filesystem::path shared_folder() {
  return std::filesystem::path(RHIZODONT_SOURCE_DIR).parent_path() / "shared";
}

}  // namespace rhizodont::test
