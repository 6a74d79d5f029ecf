// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/closest_on_triangle.hpp"

#include <Eigen/Core>

namespace rhizodont {

OnTriangle closest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  using Where = OnTriangle::Where;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, ap.squaredNorm(), Where::corner, 0};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, bp.squaredNorm(), Where::corner, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const Eigen::Vector3d along = d1 / (d1 - d3) * ab;
    return {a + along, (ap - along).squaredNorm(), Where::edge, 0};
  }
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, cp.squaredNorm(), Where::corner, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const Eigen::Vector3d along = d2 / (d2 - d6) * ac;
    return {a + along, (ap - along).squaredNorm(), Where::edge, 2};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const Eigen::Vector3d along = (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return {b + along, (bp - along).squaredNorm(), Where::edge, 1};
  }
  const double sum = va + vb + vc, scale = 1 / sum;
  return {a + vb / sum * ab + vc / sum * ac, (ap - vb * scale * ab - vc * scale * ac).squaredNorm(), Where::inside, 0};
}

}  // namespace rhizodont
