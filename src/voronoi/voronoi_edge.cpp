// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// H. Edelsbrunner and N. R. Shah, "Triangulating topological spaces", International Journal of Computational Geometry
//   and Applications 7(4), 1997: a triangle is restricted Delaunay where its Voronoi edge meets the surface.

#include "voronoi/voronoi_edge.hpp"

#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <limits>

namespace rhizodont {
namespace {

/// Six times the signed volume of the tetrahedron of a line's point, a point farther along it, and p, q.
double turn(const Eigen::Vector3d& along, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return along.dot(p.cross(q));
}

}  // namespace

VoronoiEdge voronoi_edge(const std::vector<Point>& sites, const Triangle& triangle) {
  assert(std::all_of(triangle.begin(), triangle.end(),
                     [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < sites.size(); }));
  const auto site = [&](std::int32_t i) -> const Point& { return sites[static_cast<std::size_t>(i)]; };
  const Point& a = site(triangle[0]);
  const Eigen::Vector3d u = site(triangle[1]) - a;
  const Eigen::Vector3d v = site(triangle[2]) - a;
  const Eigen::Vector3d normal = u.cross(v);
  if (!(normal.squaredNorm() > 0)) throw InputError("A triangle has no area.", {triangle[0], triangle[1], triangle[2]});
  const Eigen::Vector3d to_centre =
      (u.squaredNorm() * v.cross(normal) + v.squaredNorm() * normal.cross(u)) / (2 * normal.squaredNorm());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  VoronoiEdge edge{a + to_centre, normal.normalized(), -infinity, infinity};
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const auto index = static_cast<std::int32_t>(s);
    if (std::count(triangle.begin(), triangle.end(), index) > 0) continue;
    const Eigen::Vector3d d = sites[s] - a;
    const double h = d.dot(edge.direction);
    const double kappa = d.squaredNorm() - 2 * d.dot(to_centre);
    if (h > 0 && kappa / (2 * h) < edge.high) {
      edge.high = kappa / (2 * h);
      edge.high_site = index;
    } else if (h < 0 && kappa / (2 * h) > edge.low) {
      edge.low = kappa / (2 * h);
      edge.low_site = index;
    } else if (h == 0 && kappa < 0) {
      edge.low = infinity;
      edge.high = -infinity;
      edge.low_site = edge.high_site = index;
    }
  }
  return edge;
}

std::vector<double> outward_crossings(const TriangleMesh& surface, const VoronoiEdge& edge) {
  std::vector<double> found;
  for (const Triangle& t : surface.triangles) {
    std::array<Eigen::Vector3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = surface.vertices[static_cast<std::size_t>(t[i])] - edge.centre;
    const std::array<double, 3> w{turn(edge.direction, p[1], p[2]), turn(edge.direction, p[2], p[0]),
                                  turn(edge.direction, p[0], p[1])};
    if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0)) continue;
    const double sum = w[0] + w[1] + w[2];
    if (!(sum > 0)) continue;
    found.push_back(edge.direction.dot(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]) / sum);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace rhizodont
