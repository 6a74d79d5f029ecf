// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// bench_voronoi DATA_FOLDER: the restricted Voronoi diagram and Delaunay meshes in numbers, as Markdown.

#include "tables.hpp"

int main(int argc, char** argv) {
  return rhizodont::run_on_data_folder(argc, argv, [](const std::filesystem::path& data_folder) {
    rhizodont::print_diagram_times(rhizodont::load_largest_validation_tooth(data_folder));
    rhizodont::print_crown_shares(data_folder);
  });
}
