// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// bench_voronoi DATA_FOLDER: the restricted Voronoi diagram and Delaunay meshes in numbers, as Markdown.

#include "tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace {

constexpr int molar = 36;  // the largest of the validation teeth

int run(const char* data_folder) {
  const auto teeth = rhizodont::load_validation_teeth(data_folder);
  const auto found = std::find_if(teeth.begin(), teeth.end(), [](const auto& tooth) { return tooth.fdi == molar; });
  rhizodont::print_diagram_times(found == teeth.end() ? teeth.front() : *found);
  rhizodont::print_crown_shares(data_folder);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: {} DATA_FOLDER\n", argv[0]);
    return 2;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
