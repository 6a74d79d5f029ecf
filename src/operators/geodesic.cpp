// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// R. Kimmel, J. Sethian, "Computing geodesic paths on manifolds", Proceedings of the National Academy of Sciences 95,
//   1998.
#include "operators/geodesic.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/mesh_checks.hpp"

#include <cmath>
#include <limits>
#include <queue>

namespace rhizodont {
namespace {

/// Distance at p of a plane wave that passes a at time ta and b at tb, if it comes from between them; infinite if not.
double wave_through(const Point& a, double ta, const Point& b, double tb, const Point& p) {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (!std::isfinite(ta) || !std::isfinite(tb)) return never;
  const Eigen::Vector3d base = b - a;
  const double length = base.norm(), slope = (tb - ta) / std::max(length, 1e-300);
  if (!(length > 0) || std::abs(slope) >= 1) return never;
  const double x = (p - a).dot(base) / length;
  const double height = std::sqrt(std::max((p - a).squaredNorm() - x * x, 0.0));
  const double across = std::sqrt(1 - slope * slope);
  // Where the ray that ends at p crosses the base.
  const double crossing = x - height * slope / across;
  if (crossing < 0 || crossing > length) return never;
  return ta + slope * x + across * height;
}

}  // namespace

std::vector<double> geodesic_distances(const TriangleMesh& mesh, const std::vector<int>& sources) {
  require_valid_indices(mesh);
  const VertexTriangles around = vertex_triangles(mesh);
  std::vector<double> distance(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (const int s : sources) {
    distance.at(static_cast<std::size_t>(s)) = 0;
    front.emplace(0, s);
  }
  const auto point = [&](int v) -> const Point& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  // In flat triangles two vertices may shorten each other's way by ever less; elsewhere a few times are enough.
  constexpr int most_offers = 64;
  std::vector<int> taken(mesh.vertices.size(), 0);
  const auto offer = [&](int v, double d) {
    if (!(d < distance[static_cast<std::size_t>(v)]) || taken[static_cast<std::size_t>(v)] >= most_offers) return;
    ++taken[static_cast<std::size_t>(v)];
    distance[static_cast<std::size_t>(v)] = d;
    front.emplace(d, v);
  };
  while (!front.empty()) {
    const auto [d, v] = front.top();
    front.pop();
    if (d > distance[static_cast<std::size_t>(v)]) continue;
    for (int i = around.first[static_cast<std::size_t>(v)]; i < around.first[static_cast<std::size_t>(v) + 1]; ++i) {
      const Triangle& t = mesh.triangles[static_cast<std::size_t>(around.triangles[static_cast<std::size_t>(i)])];
      const std::size_t at = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const int a = t[(at + 1) % 3], b = t[(at + 2) % 3];
      const double da = distance[static_cast<std::size_t>(a)], db = distance[static_cast<std::size_t>(b)];
      offer(a, std::min(d + (point(a) - point(v)).norm(), wave_through(point(v), d, point(b), db, point(a))));
      offer(b, std::min(d + (point(b) - point(v)).norm(), wave_through(point(v), d, point(a), da, point(b))));
    }
  }
  return distance;
}

}  // namespace rhizodont
