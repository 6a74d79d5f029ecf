// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/bench_teeth.hpp"

#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>

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

}  // namespace rhizodont
