// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/timing.hpp"
#include "isosurface/isosurface.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "poisson/indicator.hpp"
#include "tables.hpp"
#include "voronoi/restricted_voronoi.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <cmath>

namespace rhizodont {
namespace {

constexpr double facets_per_area_and_e2 = 7.9;  // of a GradNormal mesh: facets = 7.9 area / e^2

/// Random points of the surface, moved twice to their cells' centroids: about as even as the sites of a tooth.
std::vector<Point> even_sites(const TriangleMesh& surface, std::size_t count) {
  std::vector<Point> sites = sample_surface(surface, count, 1).points;
  RestrictedVoronoiOptions options;
  options.cell_moments = true;
  for (int step = 0; step < 2; ++step) sites = restricted_voronoi(sites, surface, options).cell_centroid;
  return sites;
}

double seconds_on(std::size_t threads, const std::vector<Point>& sites, const TriangleMesh& surface,
                  const RestrictedVoronoiOptions& options = {}) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return median_seconds([&] { restricted_voronoi(sites, surface, options); }, 5);
}

}  // namespace

void print_diagram_times(const BenchTooth& tooth) {
  const SurfaceSamples samples = sample_surface(tooth.tooth, 20000, 1);
  const IndicatorFunction chi = solve_indicator({samples.points, samples.normals});
  const ScalarField field = [&chi](const Point& p) { return chi.evaluate(p); };
  const double area = surface_area(tooth.tooth);

  fmt::print("## Restricted Voronoi diagram with its dual, tooth {}\n\n", tooth.fdi);
  fmt::print("Milliseconds, median of 5. Even: random sites after two steps towards their centroids.\n\n");
  fmt::print("| Sites | Facets | even, 1 thread | even, 2 threads | with moments, 2 threads | random, 2 threads |\n");
  fmt::print("|---:|---:|---:|---:|---:|---:|\n");
  std::vector<double> sizes, seconds;
  for (const std::size_t sites : {1000U, 2000U, 4000U, 8000U, 16000U, 32000U}) {
    IsosurfaceOptions options;
    options.e = std::sqrt(facets_per_area_and_e2 * area / (2.5 * static_cast<double>(sites)));
    const TriangleMesh surface = grad_normal(field, chi.iso_value(), samples.points, options).mesh;
    const std::vector<Point> even = even_sites(surface, sites);
    const std::vector<Point> random = sample_surface(surface, sites, 1).points;
    RestrictedVoronoiOptions moments;
    moments.cell_moments = true;
    const double two = seconds_on(2, even, surface);
    fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", sites, surface.triangles.size(),
               1e3 * seconds_on(1, even, surface), 1e3 * two, 1e3 * seconds_on(2, even, surface, moments),
               1e3 * seconds_on(2, random, surface));
    sizes.push_back(static_cast<double>(sites + surface.triangles.size()));
    seconds.push_back(two);
  }
  const LinearGrowth growth = fit_linear_growth(sizes, seconds);
  fmt::print("\nGrowth with sites + facets: {:.2f} microseconds each, at most {:.0f} % off the line.\n\n",
             1e6 * growth.seconds_per_unit, 100 * growth.largest_deviation);
}

}  // namespace rhizodont
