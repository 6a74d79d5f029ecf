// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/mesh_checks.hpp"

#include "rhizodont/error.hpp"

#include <algorithm>

namespace rhizodont {

bool has_valid_indices(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [&](std::int32_t v) { return v >= 0 && v < count; });
  });
}

bool is_finite(std::span<const Point> points) {
  return std::all_of(points.begin(), points.end(), [](const Point& p) { return p.allFinite(); });
}

void require_valid_indices(const TriangleMesh& mesh) {
  std::vector<std::int64_t> bad;
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (std::any_of(triangle.begin(), triangle.end(), [&](std::int32_t v) { return v < 0 || v >= count; }))
      bad.push_back(static_cast<std::int64_t>(t));
  }
  if (!bad.empty())
    throw InputError("triangles refer to vertices that do not exist (triangle numbers follow)", bad,
                     ElementKind::triangles);
}

void require_finite(const std::vector<Point>& points) {
  std::vector<std::int64_t> bad;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (!points[v].allFinite()) bad.push_back(static_cast<std::int64_t>(v));
  if (!bad.empty())
    throw InputError("coordinates are not finite numbers (vertex numbers follow)", bad, ElementKind::vertices);
}

}  // namespace rhizodont
