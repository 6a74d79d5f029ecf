// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/bench_teeth.hpp"

#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <utility>

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
