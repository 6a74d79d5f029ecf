// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Orientation, indicator function and guiding surface on the validation teeth, as Markdown tables.
// usage: bench_poisson DATA stages
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>

#include "isosurface/guiding_surface.hpp"
#include "mesh/closest_point.hpp"
#include "pipeline/guiding_cloud.hpp"
#include "poisson/clouds.hpp"

namespace rhizodont {
namespace {

struct Distances {
  double mean = 0, most = 0;
};

Distances distances(const TriangleMesh& crown, const TriangleMesh& surface) {
  const ClosestPointIndex index(surface);
  Distances result;
  for (const Point& p : crown.vertices) {
    const double d = index.closest(p).distance;
    result.mean += d / static_cast<double>(crown.vertices.size());
    result.most = std::max(result.most, d);
  }
  return result;
}

void stages(const std::filesystem::path& data) {
  fmt::print(
      "| tooth | samples | area mm2 | cloud s | indicator s | cycles | isosurface s | vertices | mean mm | max mm |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|---|\n");
  for (const PredictedTooth& tooth : predict_validation_teeth(data)) {
    GuidingCloud cloud;
    const double t_cloud = best_seconds([&] { cloud = assemble_guiding_cloud(tooth.crown, tooth.predicted); });
    IndicatorStatistics statistics;
    const double t_indicator =
        best_seconds([&] { statistics = solve_indicator(cloud.samples, cloud.confidence).statistics(); });
    const IndicatorFunction chi = solve_indicator(cloud.samples, cloud.confidence);
    IsosurfaceOptions options;
    options.as_ball = true;
    Isosurface surface;
    const double t_surface = best_seconds([&] {
      surface =
          grad_normal([&](const Point& p) { return chi.evaluate(p); }, chi.iso_value(), cloud.samples.points, options);
    });
    const Distances d = distances(tooth.crown, surface.mesh);
    fmt::print("| {} | {} | {:.0f} | {:.3f} | {:.3f} | {} | {:.3f} | {} | {:.4f} | {:.3f} |\n", tooth.fdi,
               cloud.samples.points.size(), statistics.sampled_area, t_cloud, t_indicator, statistics.cycles, t_surface,
               surface.mesh.vertices.size(), d.mean, d.most);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  try {
    if (argc < 3) return 2;
    if (std::string(argv[2]) == "stages") rhizodont::stages(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
