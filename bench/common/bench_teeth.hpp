// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <filesystem>
#include <vector>

namespace rhizodont {

/// A real tooth of the data folder: what a scanner would have seen of it, and the whole of it.
struct BenchTooth {
  int fdi = 0;
  TriangleMesh crown;  ///< open, mm
  TriangleMesh tooth;  ///< closed, mm
};

/// The validation teeth (`validation/crown_<FDI>.ply`, `tooth_<FDI>.ply`) by ascending FDI number.
/// Throws what the readers throw; InputError if the folder holds none.
std::vector<BenchTooth> load_validation_teeth(const std::filesystem::path& data_folder);

}  // namespace rhizodont
