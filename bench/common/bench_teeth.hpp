// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <filesystem>
#include <functional>
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

/// The largest of the validation teeth, a molar: where one tooth stands for all. Throws as `load_validation_teeth`.
BenchTooth load_largest_validation_tooth(const std::filesystem::path& data_folder);

/// Every triangle cut in four.
TriangleMesh refined(const TriangleMesh& mesh);

/// Runs a benchmark whose only argument is the data folder; says on standard error how to call it and what went wrong.
/// Returns the program's exit code.
int run_on_data_folder(int argc, char** argv, const std::function<void(const std::filesystem::path&)>& benchmark);

}  // namespace rhizodont
