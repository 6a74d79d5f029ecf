// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How scans without labels are read: bench_segment time|pose MODELS SCAN... and bench_segment held-out MODELS DATA
// COUNT [FIRST]. `time` reads each scan as it is and with each triangle in four until it has 200,000 triangles; `pose`
// in five random poses, and says which share of triangles keeps its label at least; `held-out` generates scans that no
// network was trained on and prints the figures of rhizodont evaluate --labels.
#include "base/float_bits.hpp"
#include "base/peak_memory.hpp"
#include "base/random_stream.hpp"
#include "common/timing.hpp"
#include "evaluation/segmentation_figures.hpp"
#include "families/arch_family.hpp"
#include "io/scan_labels.hpp"
#include "mesh/adjacency.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/segment.hpp"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using namespace rhizodont;

TriangleMesh split_in_four(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  const EdgeTable edges = edge_table(mesh);
  std::vector<std::int32_t> middle(3 * mesh.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (int h = edges.first[e]; h < edges.first[e + 1]; ++h)
      middle[static_cast<std::size_t>(edges.half_edges[static_cast<std::size_t>(h)])] =
          static_cast<std::int32_t>(fine.vertices.size());
    const auto [a, b] = edges.vertices[e];
    fine.vertices.push_back((mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]) /
                            2);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const std::int32_t* m = &middle[3 * t];
    for (const Triangle& part : {Triangle{c[0], m[0], m[2]}, Triangle{m[0], c[1], m[1]}, Triangle{m[2], m[1], c[2]},
                                 Triangle{m[0], m[1], m[2]}})
      fine.triangles.push_back(part);
  }
  return fine;
}

void time_scan(const SegmentModels& models, const std::string& path) {
  TriangleMesh mesh = load_mesh(path).mesh;
  for (;;) {
    std::size_t teeth = 0;
    const double seconds = median_seconds([&] { teeth = segment_scan(mesh, models).teeth.size(); }, 3);
    fmt::print("| {} | {} | {} | {:.2f} | {:.0f} |\n", path, mesh.triangles.size(), teeth, seconds, peak_memory_mb());
    if (mesh.triangles.size() > 200'000) return;
    mesh = split_in_four(mesh);
  }
}

void turn_scan(const SegmentModels& models, const std::string& path) {
  const TriangleMesh mesh = load_mesh(path).mesh;
  const std::vector<int> first = triangle_labels_from_vertices(mesh, segment_scan(mesh, models).fdi);
  RandomStream random(1);
  double least = 1;
  for (int pose = 0; pose < 5; ++pose) {
    Eigen::Quaterniond turn(random.normal(), random.normal(), random.normal(), random.normal());
    turn.normalize();
    const Point shift(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200));
    TriangleMesh turned = mesh;
    for (Point& p : turned.vertices) p = nearest_float(turn * p + shift);
    const std::vector<int> again = segment_scan(turned, models).fdi;
    const std::vector<int> faces = triangle_labels_from_vertices(mesh, again);
    std::size_t same = 0;
    for (std::size_t t = 0; t < faces.size(); ++t) same += faces[t] == first[t] ? 1 : 0;
    least = std::min(least, static_cast<double>(same) / static_cast<double>(mesh.triangles.size()));
  }
  fmt::print("| {} | {:.4f} |\n", path, least);
}

void held_out(const SegmentModels& models, const std::string& data, std::uint64_t count, std::uint64_t first) {
  constexpr std::uint64_t held_out_scans = std::uint64_t{1} << 41;  // beyond those of training and validation
  const ArchFamily family = load_arch_family(data);
  std::vector<SegmentationFigures> all;
  for (std::uint64_t i = first; i < first + count; ++i) {
    const GeneratedArch arch = sample_arch(family, held_out_scans + i);
    std::vector<int> found(arch.scan.vertices.size(), 0);
    std::string words;
    for (const std::string& word : arch.drawn) words += " " + word + ",";
    try {
      found = segment_scan(arch.scan, models).fdi;
    } catch (const Error& error) {
      words += std::string(" ") + error.what();
    }
    all.push_back(segmentation_figures(arch.scan, arch.fdi, found));
    const SegmentationFigures& f = all.back();
    for (const FoundToothFigures& tooth : f.teeth)
      if (!tooth.is_right()) words += fmt::format(" {}~{}({:.2f})", tooth.fdi, tooth.most_like, tooth.most_overlap);
    for (const int extra : f.extra) words += fmt::format(" +{}", extra);
    fmt::print("| {} | {} | {}/{} | {:.3f} | {:.3f} |{}\n", i, jaw_name(arch.jaw), f.right(), f.teeth.size(),
               f.faces_right, f.tsa, words);
  }
  fmt::print("{}", describe(summary_of(all)));
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 3)
    throw UsageError("bench_segment time|pose MODELS SCAN..., or held-out MODELS DATA COUNT [FIRST]");
  const SegmentModels models = SegmentModels::load(words[1]);
  if (words[0] == "held-out") {
    held_out(models, words[2], std::stoull(words.at(3)), words.size() > 4 ? std::stoull(words[4]) : 0);
    return 0;
  }
  const bool time = words[0] == "time";
  fmt::print("{}", time ? "| scan | triangles | teeth | seconds | peak so far, MB |\n|---|---|---|---|---|\n"
                        : "| scan | same faces in other poses, least |\n|---|---|\n");
  for (std::size_t i = 2; i < words.size(); ++i) (time ? time_scan : turn_scan)(models, words[i]);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
