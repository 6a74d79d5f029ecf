// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "rhizodont/mesh.hpp"
#include "rhizodont/models.hpp"

namespace rhizodont {

/// A validation tooth with what the completion network makes of its crown, as in the product.
struct BenchPrediction {
  int fdi = 0;
  TriangleMesh crown;        ///< open, mm
  TriangleMesh tooth;        ///< the truth, closed, mm
  OrientedPoints predicted;  ///< mm
};

/// What the completion network makes of one open crown (mm), in the crown's place. Throws what registration throws.
OrientedPoints predicted_points(const TriangleMesh& crown, int fdi, const CompletionModels& models);

std::vector<BenchPrediction> predict_validation_teeth(const std::filesystem::path& data_folder);

/// Shortest wall-clock time in seconds of `repeats` runs, which other work on the machine disturbs least.
double best_seconds(const std::function<void()>& work, int repeats = 5);

}  // namespace rhizodont
