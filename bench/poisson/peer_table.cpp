// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/peer_table.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <random>

#include "common/bench_teeth.hpp"
#include "isosurface/isosurface.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "poisson/clouds.hpp"
#include "poisson/distances.hpp"
#include "poisson/indicator.hpp"
#include "poisson/peers.hpp"

namespace rhizodont {
namespace {

constexpr std::size_t sample_count = 20000;
constexpr int repeats = 3;

/// The true surface, with points on it that no method has seen.
struct Truth {
  explicit Truth(const TriangleMesh& mesh) : index(mesh), points(sample_surface(mesh, sample_count, 2).points) {}

  ClosestPointIndex index;
  std::vector<Point> points;
};

struct Outcome {
  double seconds = 0;
  std::size_t triangles = 0;
  Distances to_truth, from_truth;

  double error() const { return 0.5 * (to_truth.mean + from_truth.mean); }
};

Outcome measured(double seconds, const TriangleMesh& mesh, const Truth& truth) {
  Outcome outcome;
  outcome.seconds = seconds;
  outcome.triangles = mesh.triangles.size();
  outcome.to_truth = distances(sample_surface(mesh, sample_count, 3).points, truth.index);
  outcome.from_truth = distances(truth.points, ClosestPointIndex(mesh));
  return outcome;
}

/// `closest`: mm, no finer tiling than that.
Outcome ours(const OrientedPoints& samples, double spacing, double closest, int degree, const Truth& truth) {
  IndicatorOptions indicator;
  indicator.degree = degree;
  indicator.spacing = spacing;
  indicator.samples_per_cell = 1.5;  // sparser samples get larger cells, as with Open3D
  IsosurfaceOptions isosurface;
  isosurface.e = std::max(spacing, closest);
  TriangleMesh mesh;
  const double seconds = best_seconds(
      [&] {
        const IndicatorFunction chi = solve_indicator(samples, {}, indicator);
        mesh = marching_tetrahedra([&](const Point& p) { return chi.evaluate(p); }, chi.iso_value(), samples.points,
                                   isosurface);
      },
      repeats);
  return measured(seconds, mesh, truth);
}

/// How one of our degrees compares over all rows.
struct Comparison {
  double least_speed = std::numeric_limits<double>::max(), most_error = 0;

  void add(const Outcome& open3d, const Outcome& own) {
    least_speed = std::min(least_speed, open3d.seconds / own.seconds);
    most_error = std::max(most_error, own.error() / open3d.error());
  }
};

OrientedPoints noisy_samples(const TriangleMesh& mesh, double noise) {
  const SurfaceSamples on_surface = sample_surface(mesh, sample_count, 1);
  OrientedPoints samples{on_surface.points, on_surface.normals};
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  if (noise > 0)
    for (Point& p : samples.points) p += noise * Eigen::Vector3d(normal(random), normal(random), normal(random));
  return samples;
}

}  // namespace

void print_peer_table(const std::filesystem::path& data) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, 2);
  const auto scratch = std::filesystem::temp_directory_path();
  fmt::print(
      "{} points with true normals; noise: standard deviation along each axis. Seconds: from points to triangles, two "
      "threads (CGAL: one), best of {} (CGAL: one run). Ours: solve_indicator at Open3D's cell size and, like it, "
      "with larger cells where there are fewer than 1.5 samples to one, and marching_tetrahedra; Open3D: "
      "create_from_point_cloud_poisson alone, "
      "timed in its own "
      "process; CGAL: "
      "poisson_surface_reconstruction_delaunay. Distances: {} points on the result to the true surface, and {} points "
      "of the true surface, none of them a sample, to the result. Error: mean of the two means.\n\n",
      sample_count, repeats, sample_count, sample_count);
  fmt::print(
      "| tooth | noise mm | depth | method | s | triangles | result to truth mm | max | truth to result mm | max | "
      "Open3D's time over ours | our error over Open3D's |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::array<Comparison, 2> by_degree;
  for (const BenchTooth& tooth : load_validation_teeth(data)) {
    if (tooth.fdi != 33 && tooth.fdi != 36) continue;
    const Truth truth(tooth.tooth);
    const double cube = 1.1 * bounding_box(tooth.tooth.vertices).sizes().maxCoeff();
    const double apart = std::sqrt(surface_area(tooth.tooth) / sample_count);
    const double closest = std::sqrt(1.5) * apart;  // 1.5 samples to a cell, as Open3D has it
    for (const double noise : {0.0, 0.02}) {
      const OrientedPoints samples = noisy_samples(tooth.tooth, noise);
      const auto row = [&](int depth, const std::string& method, const Outcome& o, const std::string& ratios) {
        fmt::print("| {} | {} | {} | {} | {:.3f} | {} | {:.5f} | {:.3f} | {:.5f} | {:.3f} | {}\n", tooth.fdi, noise,
                   depth > 0 ? fmt::format("{}", depth) : "", method, o.seconds, o.triangles, o.to_truth.mean,
                   o.to_truth.most, o.from_truth.mean, o.from_truth.most, ratios);
        std::fflush(stdout);
      };
      for (const int depth : {6, 7, 8}) {
        const PeerResult peer = open3d_poisson(samples, depth, repeats, scratch);
        const Outcome open3d = measured(peer.seconds, peer.mesh, truth);
        row(depth, "Open3D", open3d, "| |");
        for (const int degree : {1, 2}) {
          const Outcome own = ours(samples, cube / (1 << depth), closest, degree, truth);
          row(depth, fmt::format("ours, degree {}", degree), own,
              fmt::format("{:.1f} | {:.2f} |", open3d.seconds / own.seconds, own.error() / open3d.error()));
          by_degree[static_cast<std::size_t>(degree - 1)].add(open3d, own);
        }
      }
      const PeerResult cgal = cgal_poisson(samples, apart);
      row(0, "CGAL", measured(cgal.seconds, cgal.mesh, truth), "| |");
    }
  }
  for (std::size_t d = 0; d < 2; ++d)
    fmt::print("\nDegree {}: at least {:.1f} times as fast as Open3D at the same depth, error at most {:.2f} of its.\n",
               d + 1, by_degree[d].least_speed, by_degree[d].most_error);
}

}  // namespace rhizodont
