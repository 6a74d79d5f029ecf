// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/workplace.hpp"

#include "base/float_bits.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/io.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {

Workplace workplace(const TriangleMesh& input, double millimetres_per_unit) {
  constexpr double far_mm = 500, step_mm = 64;
  Workplace place{Point::Zero(), millimetres_per_unit, coordinates_fit_float(input)};
  const std::size_t count = input.vertices.size();
  if (count == 0) return place;
  Point middle;  // the median: a stray vertex somewhere has no say
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<double> along;
    along.reserve(count);
    for (const Point& p : input.vertices)
      if (std::isfinite(p[k])) along.push_back(p[k]);
    if (along.empty()) return place;
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), half, along.end());
    middle[k] = *half;
  }
  if (!(middle.norm() * millimetres_per_unit > far_mm)) return place;
  const double step = std::exp2(std::round(std::log2(step_mm / millimetres_per_unit)));
  place.origin = (middle / step).array().round().matrix() * step;
  return place;
}

TriangleMesh moved_by(TriangleMesh mesh, const Eigen::Vector3d& move) {
  if (!move.isZero(0))
    for (Point& p : mesh.vertices) p += move;
  return mesh;
}

TriangleMesh in_input_coordinates(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                                  const Workplace& place) {
  TriangleMesh result = tooth;
  for (std::size_t v = 0; v < result.vertices.size(); ++v) {
    Point& p = result.vertices[v];
    if (v < kept.size()) {
      p = input.vertices[static_cast<std::size_t>(kept[v])];
      continue;
    }
    p = p / place.millimetres_per_unit + place.origin;
    if (place.as_float) p = nearest_float(p);
  }
  return result;
}

}  // namespace rhizodont
