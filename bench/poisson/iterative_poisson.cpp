// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// F. Hou, C. Wang, W. Wang, H. Qin, C. Qian, Y. He, "Iterative Poisson Surface Reconstruction (iPSR) for Unoriented
// Points", ACM Transactions on Graphics 41(4), 2022.
#include "poisson/iterative_poisson.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "base/option_range.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// From the engine's bits alone, so that the normals are the same with every standard library.
std::vector<Eigen::Vector3d> random_normals(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(random() >> 11), -52) - 1.0; };
  std::vector<Eigen::Vector3d> normals;
  while (normals.size() < count) {
    const double x = uniform(), y = uniform(), z = uniform();
    const Eigen::Vector3d n(x, y, z);
    if (n.norm() > 0.1 && n.norm() <= 1.0) normals.push_back(n.normalized());
  }
  return normals;
}

/// Each triangle gives its area vector to the samples nearest to its middle. Samples that none reaches keep theirs.
std::vector<Eigen::Vector3d> normals_from(const TriangleMesh& surface, const NearestVertexIndex& index, int neighbours,
                                          const std::vector<Eigen::Vector3d>& before) {
  std::vector<Eigen::Vector3d> sums(before.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Point middle = Point::Zero();
    for (const std::int32_t v : surface.triangles[t]) middle += surface.vertices[static_cast<std::size_t>(v)] / 3.0;
    const Eigen::Vector3d area = triangle_area_vector(surface, t);
    for (const NearVertex& near : index.nearest(middle, static_cast<std::size_t>(neighbours)))
      sums[static_cast<std::size_t>(near.index)] += area;
  }
  for (std::size_t s = 0; s < sums.size(); ++s)
    sums[s] = sums[s].norm() > 1e-12 ? Eigen::Vector3d(sums[s].normalized()) : before[s];
  return sums;
}

/// Mean change of the thousandth (at least one) of the normals that change most.
double largest_changes(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  std::vector<double> changes;
  for (std::size_t s = 0; s < a.size(); ++s) changes.push_back((a[s] - b[s]).norm());
  const std::size_t most = std::max<std::size_t>(1, a.size() / 1000);
  std::ranges::partial_sort(changes, changes.begin() + static_cast<std::ptrdiff_t>(most), std::greater{});
  double sum = 0.0;
  for (std::size_t i = 0; i < most; ++i) sum += changes[i];
  return sum / static_cast<double>(most);
}

}  // namespace

IterativePoisson iterative_poisson(std::span<const Point> points, const IterativePoissonOptions& options) {
  require_ranges("iterative Poisson", {{"e", options.e, OptionRange::above(0)},
                                       {"neighbours", options.neighbours, OptionRange::at_least(1)},
                                       {"most_iterations", options.most_iterations, OptionRange::at_least(1)},
                                       {"still", options.still, OptionRange::above(0)}});
  require_in_range(options.indicator);
  IterativePoisson result;
  result.oriented.points.assign(points.begin(), points.end());
  result.oriented.normals = random_normals(points.size(), options.seed);
  IsosurfaceOptions isosurface;
  isosurface.e = options.e;
  isosurface.every_component = true;
  const NearestVertexIndex index(result.oriented.points);
  while (result.iterations < options.most_iterations) {
    const IndicatorFunction chi = solve_indicator(result.oriented, {}, options.indicator);
    result.surface =
        marching_tetrahedra([&chi](const Point& p) { return chi.evaluate(p); }, chi.iso_value(), points, isosurface);
    auto normals = normals_from(result.surface, index, options.neighbours, result.oriented.normals);
    result.change = largest_changes(normals, result.oriented.normals);
    result.oriented.normals = std::move(normals);
    ++result.iterations;
    if (result.change < options.still) break;
  }
  if (volume(result.surface) < 0.0) {
    for (Eigen::Vector3d& n : result.oriented.normals) n = -n;
    for (Triangle& t : result.surface.triangles) std::swap(t[1], t[2]);
  }
  return result;
}

}  // namespace rhizodont
