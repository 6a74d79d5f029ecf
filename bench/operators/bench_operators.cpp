// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Time of the operators on a crown of growing size: bench_operators DATA
#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "operators/eigenbasis.hpp"

#include <fmt/core.h>

#include <cstdio>

namespace {

using namespace rhizodont;

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
