// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// A validation tooth with what the completion network makes of its crown, as in the product.
struct BenchPrediction {
  int fdi = 0;
  TriangleMesh crown;        ///< open, mm
  TriangleMesh tooth;        ///< the truth, closed, mm
  OrientedPoints predicted;  ///< mm
};

std::vector<BenchPrediction> predict_validation_teeth(const std::filesystem::path& data_folder);

/// Shortest wall-clock time in seconds of `repeats` runs, which other work on the machine disturbs least.
double best_seconds(const std::function<void()>& work, int repeats = 5);

}  // namespace rhizodont
