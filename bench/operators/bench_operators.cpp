// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Time of the operators on a crown of growing size: bench_operators DATA
#include "common/bench_teeth.hpp"
#include "common/stopwatch.hpp"
#include "operators/eigenbasis.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <map>

namespace {

using namespace rhizodont;

/// Every triangle cut in four.
TriangleMesh refined(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(fine.vertices.size()));
    if (is_new)
      fine.vertices.push_back(
          0.5 * (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}});
  }
  return fine;
}

void print_row(const TriangleMesh& mesh) {
  const SurfaceOperators operators = surface_operators(mesh);
  fmt::print("| {} | {:.3f} |", mesh.vertices.size(), median_seconds([&] { surface_operators(mesh); }, 3));
  for (const int k : {32, 64, 128})
    fmt::print(" {:.3f} |", median_seconds([&] { eigenbasis(operators, k); }, mesh.vertices.size() > 50000 ? 1 : 3));
  fmt::print("\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: bench_operators DATA\n");
    return 2;
  }
  fmt::print("| vertices | operators, s | k = 32, s | k = 64, s | k = 128, s |\n|---|---|---|---|---|\n");
  for (const int fdi : {44, 36}) {
    for (const BenchTooth& tooth : load_validation_teeth(argv[1])) {
      if (tooth.fdi != fdi) continue;
      TriangleMesh crown = fdi == 44 ? tooth.crown : refined(tooth.crown);
      for (int i = 0; i < (fdi == 44 ? 2 : 3); ++i, crown = refined(crown)) print_row(crown);
    }
  }
  return 0;
}
