// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Orientation, indicator function and guiding surface on real teeth, as Markdown tables.
// usage: bench_poisson DATA stages|peers|distance|orientation|ipsr|growth
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <random>
#include <string>

#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "guiding/crown_fit.hpp"
#include "guiding/fitted_surface.hpp"
#include "guiding/guiding_cloud.hpp"
#include "guiding/guiding_surface.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "mesh/quality.hpp"
#include "mesh/sampling.hpp"
#include "mesh/self_intersection.hpp"
#include "poisson/clouds.hpp"
#include "poisson/distances.hpp"
#include "poisson/iterative_poisson.hpp"
#include "poisson/orientation.hpp"
#include "poisson/peer_table.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/prepared_crown.hpp"

namespace rhizodont {
namespace {

OrientedPoints samples_of(const TriangleMesh& mesh, std::size_t count) {
  const SurfaceSamples samples = sample_surface(mesh, count, 1);
  return {samples.points, samples.normals};
}

/// Seconds of each part for each validation tooth at e = 0.5.
void stages(const std::filesystem::path& data) {
  fmt::print("| tooth | samples | functions | cloud s | indicator s | cycles | isosurface s | fit s | sum s |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const BenchPrediction& tooth : predict_validation_teeth(data)) {
    GuidingCloud cloud;
    const double t_cloud =
        best_seconds([&] { cloud = assemble_guiding_cloud(prepare_crown(tooth.crown), tooth.predicted); });
    IndicatorStatistics statistics;
    const double t_indicator =
        best_seconds([&] { statistics = solve_indicator(cloud.samples, cloud.confidence).statistics(); });
    const IndicatorFunction chi = solve_indicator(cloud.samples, cloud.confidence);
    IsosurfaceOptions options;
    options.as_ball = true;
    TriangleMesh surface;
    const std::span<const Point> seeds(cloud.samples.points.data(), static_cast<std::size_t>(cloud.crown_samples));
    const double t_surface = best_seconds([&] {
      surface = grad_normal([&](const Point& p) { return chi.evaluate(p); }, chi.iso_value(), seeds, options).mesh;
    });
    const double t_fit = best_seconds([&] {
      TriangleMesh fitted = surface;
      fit_to_crown(fitted, prepare_crown(tooth.crown));
    });
    fmt::print("| {} | {} | {} | {:.3f} | {:.3f} | {} | {:.3f} | {:.3f} | {:.3f} |\n", tooth.fdi,
               cloud.samples.points.size(), statistics.functions, t_cloud, t_indicator, statistics.cycles, t_surface,
               t_fit, t_cloud + t_indicator + t_surface + t_fit);
    std::fflush(stdout);
  }
}

/// Table 1 of the paper.
void distance(const std::filesystem::path& data) {
  const auto teeth = predict_validation_teeth(data);
  std::vector<GuidingCloud> clouds;
  for (const BenchPrediction& tooth : teeth)
    clouds.push_back(assemble_guiding_cloud(prepare_crown(tooth.crown), tooth.predicted));
  const std::array<std::array<double, 3>, 4> paper{
      {{1.0, 3.17e-2, 0.29}, {0.75, 2.29e-2, 0.26}, {0.5, 1.41e-2, 0.16}, {0.25, 7.1e-3, 0.12}}};
  fmt::print("| e | d_avg | d_max | paper's d_avg | paper's d_max | vertices | s | self-intersecting pairs |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const auto& [e, paper_mean, paper_most] : paper) {
    double mean = 0, most = 0, vertices = 0, seconds = 0;
    std::size_t crossing = 0, count = 0;
    for (std::size_t i = 0; i < teeth.size(); ++i) {
      TriangleMesh surface;
      seconds +=
          best_seconds([&] { surface = fitted_guiding_surface(clouds[i], prepare_crown(teeth[i].crown), e).mesh; }, 1);
      const Distances d = distances(teeth[i].crown.vertices, ClosestPointIndex(surface));
      mean += d.mean * static_cast<double>(teeth[i].crown.vertices.size());
      count += teeth[i].crown.vertices.size();
      most = std::max(most, d.most);
      vertices += static_cast<double>(surface.vertices.size());
      crossing += self_intersecting_triangles(surface).size();
    }
    const auto n = static_cast<double>(teeth.size());
    fmt::print("| {} | {:.2e} | {:.3f} | {:.2e} | {:.2f} | {:.0f} | {:.3f} | {} |\n", e,
               mean / static_cast<double>(count), most, paper_mean, paper_most, vertices / n, seconds / n, crossing);
    std::fflush(stdout);
  }
}

/// Noisy normals, of which a part is turned over.
std::vector<Eigen::Vector3d> noisy(const std::vector<Eigen::Vector3d>& normals, double noise, double turned,
                                   std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, noise);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Eigen::Vector3d> hints;
  for (const Eigen::Vector3d& n : normals) {
    const Eigen::Vector3d hint = n + Eigen::Vector3d(normal(random), normal(random), normal(random));
    hints.push_back(uniform(random) < turned ? -hint : hint);
  }
  return hints;
}

double wrong_percent(const std::vector<Eigen::Vector3d>& normals, const std::vector<Eigen::Vector3d>& truth) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) wrong += normals[i].dot(truth[i]) <= 0 ? 1 : 0;
  return 100.0 * static_cast<double>(wrong) / static_cast<double>(truth.size());
}

/// Share of points on the wrong side, from 2,000 points of each template and each validation tooth.
void orientation(const std::filesystem::path& data) {
  std::vector<std::pair<std::string, TriangleMesh>> teeth;
  for (int fdi = 21; fdi <= 38; ++fdi) {
    const auto file = data / "templates" / fmt::format("tooth_{}.ply", fdi);
    if (std::filesystem::exists(file)) teeth.emplace_back(fmt::format("template {}", fdi), load_mesh(file).mesh);
  }
  for (BenchTooth& tooth : load_validation_teeth(data))
    teeth.emplace_back(fmt::format("validation {}", tooth.fdi), std::move(tooth.tooth));
  fmt::print("Points on the wrong side, percent. Noise of points in mm; hints: noise 0.5, 10 % turned over.\n\n");
  fmt::print(
      "| tooth | no hints | hints | hints as they are | noise 0.1, hints | s | iterative Poisson | iterations | s |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, mesh] : teeth) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, 0.1);
    const OrientedPoints truth = samples_of(mesh, 2000);
    std::vector<Point> moved = truth.points;
    for (Point& p : moved) p += Eigen::Vector3d(normal(random), normal(random), normal(random));
    const auto hints = noisy(truth.normals, 0.5, 0.1, random);
    OrientedPoints hinted;
    const double seconds = best_seconds([&] { hinted = orient_normals(truth.points, hints); }, 3);
    IterativePoissonOptions options;
    options.indicator.spacing = 0.4;
    IterativePoisson iterated;
    const double iterating = best_seconds([&] { iterated = iterative_poisson(truth.points, options); }, 1);
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.2f} | {} | {:.2f} |\n", name,
               wrong_percent(orient_normals(truth.points).normals, truth.normals),
               wrong_percent(hinted.normals, truth.normals), wrong_percent(hints, truth.normals),
               wrong_percent(orient_normals(moved, hints).normals, truth.normals), seconds,
               wrong_percent(iterated.oriented.normals, truth.normals), iterated.iterations, iterating);
    std::fflush(stdout);
  }
}

/// Table 5 of the paper, its rows of iterative Poisson: all triangles of the plain isosurface.
void ipsr(const std::filesystem::path& data) {
  struct PaperRow {
    int fdi;
    double q_avg, q_min, theta_avg, theta_min, percent_below_30;
  };
  constexpr std::array<PaperRow, 7> paper{{{11, 0.60, 1.6e-4, 32.23, 0.00537, 39.62},
                                           {12, 0.61, 7.3e-5, 32.07, 0.00506, 40.01},
                                           {13, 0.61, 6.4e-4, 32.43, 0.0161, 38.70},
                                           {14, 0.60, 1.5e-4, 31.98, 0.0166, 40.27},
                                           {15, 0.60, 2.3e-4, 32.12, 0.0134, 39.49},
                                           {16, 0.61, 2.6e-5, 32.58, 0.0104, 38.26},
                                           {17, 0.61, 7.3e-6, 32.38, 0.00601, 38.77}}};
  fmt::print("| | tooth | Q avg | Q min | theta avg | theta min | % < 30 | iterations | s |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (const BenchPrediction& tooth : predict_validation_teeth(data)) {
    if (tooth.fdi > 37) continue;
    const GuidingCloud cloud = assemble_guiding_cloud(prepare_crown(tooth.crown), tooth.predicted);
    IterativePoisson result;
    const double seconds = best_seconds([&] { result = iterative_poisson(cloud.samples.points); }, 1);
    const QualityFigures q = quality(result.surface).value_or(QualityFigures{});
    fmt::print("| IPSR (ours) | {} | {:.2f} | {:.2g} | {:.2f} | {:.3g} | {:.2f} | {} | {:.1f} |\n", tooth.fdi, q.q_avg,
               q.q_min, q.theta_avg, q.theta_min, q.percent_below_30, result.iterations, seconds);
    std::fflush(stdout);
  }
  for (const PaperRow& row : paper)
    fmt::print("| IPSR (paper) | {} | {:.2f} | {:.2g} | {:.2f} | {:.3g} | {:.2f} | | |\n", row.fdi, row.q_avg,
               row.q_min, row.theta_avg, row.theta_min, row.percent_below_30);
}

/// Time and memory over the number of samples and over area / spacing^2.
void growth(const std::filesystem::path& data) {
  const auto teeth = load_validation_teeth(data);
  const auto molar = std::ranges::find(teeth, 36, &BenchTooth::fdi);
  if (molar == teeth.end()) throw InputError("There is no tooth 36.");
  const double area = surface_area(molar->tooth);
  const auto table = [&](const std::string& title, const std::vector<std::pair<std::size_t, double>>& runs,
                         const std::function<double(std::size_t, double)>& size) {
    std::vector<double> sizes, seconds, stored;
    fmt::print("{}\n\n| samples | spacing mm | s | functions | stored | cycles |\n|---|---|---|---|---|---|\n", title);
    for (const auto& [count, spacing] : runs) {
      const OrientedPoints samples = samples_of(molar->tooth, count);
      IndicatorOptions options;
      options.spacing = spacing;
      IndicatorStatistics statistics;
      seconds.push_back(best_seconds([&] { statistics = solve_indicator(samples, {}, options).statistics(); }, 3));
      sizes.push_back(size(count, spacing));
      stored.push_back(static_cast<double>(statistics.stored_functions));
      fmt::print("| {} | {:.3f} | {:.3f} | {} | {} | {} |\n", count, spacing, seconds.back(), statistics.functions,
                 statistics.stored_functions, statistics.cycles);
      std::fflush(stdout);
    }
    fmt::print("\nFarthest from the straight line: time {:.0f} %, memory {:.0f} %.\n\n",
               100 * fit_linear_growth(sizes, seconds).largest_deviation,
               100 * fit_linear_growth(sizes, stored).largest_deviation);
  };
  // Samples as dense as the spacing asks for: both grow together.
  std::vector<std::pair<std::size_t, double>> runs;
  for (const double spacing : {0.28, 0.2, 0.14, 0.1, 0.07})
    runs.emplace_back(static_cast<std::size_t>(area / (spacing * spacing)), spacing);
  table("Samples and 1 / spacing^2 together", runs,
        [](std::size_t count, double) { return static_cast<double>(count); });
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  using namespace rhizodont;
  try {
    const std::string table = argc == 3 ? argv[2] : "";
    if (table == "stages")
      stages(argv[1]);
    else if (table == "peers")
      print_peer_table(argv[1]);
    else if (table == "distance")
      distance(argv[1]);
    else if (table == "orientation")
      orientation(argv[1]);
    else if (table == "ipsr")
      ipsr(argv[1]);
    else if (table == "growth")
      growth(argv[1]);
    else {
      fmt::print(stderr, "usage: bench_poisson DATA stages|peers|distance|orientation|ipsr|growth\n");
      return 2;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
