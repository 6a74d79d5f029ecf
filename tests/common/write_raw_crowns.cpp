// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Writes raw crowns made of generated teeth: write_raw_crowns DATA FOLDER COUNT [FIRST=0]. Crown i has kind i modulo
// the number of kinds; all types of teeth in turn. One line each: file, FDI number, kind, Euler number, vertices where
// the surface only touches itself, edges with more than two triangles.

#include "common/raw_crowns.hpp"
#include "mesh/diagnosis.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "training/skirt_sample.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

int main(int argc, char** argv) {
  using namespace rhizodont;
  try {
    if (argc < 4 || argc > 5) {
      fmt::print(stderr, "usage: write_raw_crowns DATA FOLDER COUNT [FIRST]\n");
      return 2;
    }
    const ToothFamilies families = load_tooth_families(argv[1]);
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    const std::vector<std::string> kinds = test::raw_kinds();
    const std::uint64_t first = argc == 5 ? std::stoull(argv[4]) : 0, count = std::stoull(argv[3]);
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
      SkirtSampleOptions options;
      options.type = static_cast<int>(seed * 5 % tooth_type_count);
      options.clean_share = 0;
      const SkirtSample sample = make_skirt_sample(families, 510000 + seed, options);
      const std::string& kind = kinds[seed % kinds.size()];
      MeshFile file;
      file.mesh = test::raw_crown(sample.mesh, sample.is_tooth, kind, seed);
      const Diagnosis found = diagnose(file.mesh);
      const int fdi = fdi_of_type(sample.type, sample.mirrored);
      const std::filesystem::path name = folder / fmt::format("raw_{}_{}.ply", fdi, seed);
      save_mesh(name, file);
      fmt::print("{}|{}|{}|{}|{}|{}\n", name.string(), fdi, kind, found.euler_number,
                 found.non_manifold_vertices.size(), found.non_manifold_edges.size());
    }
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
