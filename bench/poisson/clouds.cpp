// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/clouds.hpp"

#include <algorithm>
#include <limits>

#include "base/stopwatch.hpp"
#include "common/bench_teeth.hpp"
#include "completion/complete_points.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/models.hpp"
#include "teeth/prepared_crown.hpp"

namespace rhizodont {

OrientedPoints predicted_points(const TriangleMesh& crown, int fdi, const CompletionModels& models) {
  const auto& content = *content_of(models);
  const CrownFrame frame = lay_crown(prepare_crown(crown), fdi, {}, content);
  return complete_points(crown, fdi, frame, content.network).cloud;
}

std::vector<BenchPrediction> predict_validation_teeth(const std::filesystem::path& data_folder) {
  const CompletionModels models = CompletionModels::load(default_models_folder());
  std::vector<BenchPrediction> teeth;
  for (BenchTooth& tooth : load_validation_teeth(data_folder)) {
    OrientedPoints predicted = predicted_points(tooth.crown, tooth.fdi, models);
    teeth.push_back({tooth.fdi, std::move(tooth.crown), std::move(tooth.tooth), std::move(predicted)});
  }
  return teeth;
}

double best_seconds(const std::function<void()>& work, int repeats) {
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    work();
    best = std::min(best, watch.seconds());
  }
  return best;
}

}  // namespace rhizodont
