// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// bench_isosurface DATA_FOLDER: angles, counts and times of MidNormal and GradNormal, as Markdown.

#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "isosurface/isosurface.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "poisson/indicator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

/// An ellipsoid around the origin; positive inside, not a distance.
ScalarField ellipsoid(const Eigen::Vector3d& radii) {
  return [radii](const Point& p) {
    const Eigen::Vector3d scaled = p.cwiseQuotient(radii);
    return FieldSample{1.0 - scaled.squaredNorm(), -2.0 * scaled.cwiseQuotient(radii)};
  };
}

std::string angle_range(const TriangleMesh& mesh) {
  double least = 180, most = 0;
  std::size_t beyond = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto angles = triangle_angles(mesh, t);
    const auto [low, high] = std::minmax_element(angles.begin(), angles.end());
    const double low_degrees = *low * 180 / std::numbers::pi, high_degrees = *high * 180 / std::numbers::pi;
    least = std::min(least, low_degrees);
    most = std::max(most, high_degrees);
    if (low_degrees < 35.2 || high_degrees > 101.55) ++beyond;
  }
  return fmt::format("{:.1f} - {:.1f} ({:.2f} %)", least, most,
                     100.0 * static_cast<double>(beyond) / static_cast<double>(mesh.triangles.size()));
}

void print_angles() {
  struct Shape {
    const char* name;
    Eigen::Vector3d radii;
    double curvature_radius;  // smallest
  };
  const std::vector<Shape> shapes{{"sphere", {1, 1, 1}, 1}, {"ellipsoid 1, 0.6, 0.4", {1, 0.6, 0.4}, 0.16}};
  fmt::print(
      "## Angles in degrees\n\nIn brackets: triangles beyond 35.2 to 101.5 degrees, which hold as e goes to 0.\n\n"
      "| Surface | e / smallest radius of curvature | MidNormal | projected | projected and relaxed | relaxed "
      "vertices | Euler number |\n|---|---:|---|---|---|---:|---:|\n");
  for (const Shape& shape : shapes)
    for (const double ratio : {0.5, 0.35, 0.2, 0.1, 0.05}) {
      IsosurfaceOptions options;
      options.e = ratio * shape.curvature_radius;
      options.origin = Point(0.013, -0.021, 0.008);
      const ScalarField field = ellipsoid(shape.radii);
      const std::vector<Point> seeds{Point(shape.radii.x(), 0, 0)};
      const Isosurface relaxed = grad_normal(field, 0, seeds, options);
      IsosurfaceOptions plain = options;
      plain.relax = false;
      fmt::print("| {} | {:.2f} | {} | {} | {} | {} of {} | {} |\n", shape.name, ratio,
                 angle_range(mid_normal(field, 0, seeds, options).mesh),
                 angle_range(grad_normal(field, 0, seeds, plain).mesh), angle_range(relaxed.mesh),
                 relaxed.relaxed_vertices, relaxed.mesh.vertices.size(), relaxed.euler_number);
    }
  fmt::print("\n");
}

void print_growth(const BenchTooth& tooth) {
  const SurfaceSamples samples = sample_surface(tooth.tooth, 20000, 1);
  const IndicatorFunction chi = solve_indicator({samples.points, samples.normals});
  const ScalarField field = [&chi](const Point& p) { return chi.evaluate(p); };
  const double area = surface_area(tooth.tooth);
  fmt::print(
      "## Growth with area / e^2, indicator function of tooth {}\n\n"
      "| e (mm) | area / e^2 | triangles | cells visited | field evaluated | ms | angles | samples to surface, mean "
      "(mm) |\n|---:|---:|---:|---:|---:|---:|---|---:|\n",
      tooth.fdi);
  std::vector<double> sizes, seconds;
  for (const double e : {1.0, 0.75, 0.5, 0.35, 0.25, 0.18}) {
    IsosurfaceOptions options;
    options.e = e;
    Isosurface surface;
    const double time =
        median_seconds([&] { surface = grad_normal(field, chi.iso_value(), samples.points, options); }, 5);
    const ClosestPointIndex index(surface.mesh);
    double distance = 0;
    for (const Point& p : samples.points) distance += index.closest(p).distance;
    const double size = area / (e * e);
    fmt::print("| {} | {:.0f} | {} | {} | {} | {:.1f} | {} | {:.4f} |\n", e, size, surface.mesh.triangles.size(),
               surface.visited_cells, surface.evaluated_vertices, 1e3 * time, angle_range(surface.mesh),
               distance / static_cast<double>(samples.points.size()));
    sizes.push_back(size);
    seconds.push_back(time);
  }
  const LinearGrowth growth = fit_linear_growth(sizes, seconds);
  fmt::print("\nGrowth: {:.2f} microseconds per area / e^2, at most {:.0f} % off the line.\n\n",
             1e6 * growth.seconds_per_unit, 100 * growth.largest_deviation);
}

}  // namespace

int main(int argc, char** argv) {
  return run_on_data_folder(argc, argv, [](const std::filesystem::path& data_folder) {
    print_angles();
    print_growth(load_largest_validation_tooth(data_folder));
  });
}
