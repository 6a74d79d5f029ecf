// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/bench_teeth.hpp"

#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace rhizodont {

std::vector<BenchTooth> load_validation_teeth(const std::filesystem::path& data_folder) {
  std::vector<BenchTooth> teeth;
  for (int quadrant = 1; quadrant <= 4; ++quadrant)
    for (int position = 1; position <= 8; ++position) {
      const int fdi = 10 * quadrant + position;
      const auto crown = data_folder / "validation" / fmt::format("crown_{}.ply", fdi);
      const auto tooth = data_folder / "validation" / fmt::format("tooth_{}.ply", fdi);
      if (std::filesystem::exists(crown) && std::filesystem::exists(tooth))
        teeth.push_back({fdi, load_mesh(crown).mesh, load_mesh(tooth).mesh});
    }
  if (teeth.empty()) throw InputError(fmt::format("There are no validation teeth in {}.", data_folder.string()));
  return teeth;
}

BenchTooth load_largest_validation_tooth(const std::filesystem::path& data_folder) {
  const std::vector<BenchTooth> teeth = load_validation_teeth(data_folder);
  return *std::max_element(teeth.begin(), teeth.end(), [](const BenchTooth& a, const BenchTooth& b) {
    return a.crown.vertices.size() < b.crown.vertices.size();
  });
}

int run_on_data_folder(int argc, char** argv, const std::function<void(const std::filesystem::path&)>& benchmark) {
  if (argc != 2) {
    fmt::print(stderr, "Usage: {} DATA_FOLDER\n", argv[0]);
    return 2;
  }
  try {
    benchmark(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace rhizodont
