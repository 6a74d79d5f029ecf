// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/complete.hpp"

#include "completion/uncertainty.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"

#include <cmath>

namespace rhizodont {

CompletedTooth complete_tooth(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options,
                              const ProgressCallback& progress) {
  return finish_tooth(prepare_tooth(crown, models, options, progress), options.steering, options.transition, progress);
}

std::vector<CompletedTooth> complete_candidates(const TriangleMesh& crown, const CompletionModels& models, int count,
                                                const CompleteOptions& options, const ProgressCallback& progress) {
  if (count < 1 || count > 9) throw UsageError("There can be 1 to 9 candidates.");
  if (count > 1 && options.steering.any())
    throw UsageError("Candidates differ in what steering sets: ask for one of the two.");
  if (count > 1 && !uncertainty_scales(content_of(models)->network.metadata()))
    throw UsageError("Candidates need a completion network that was calibrated.");
  const PreparedTooth prepared = prepare_tooth(crown, models, options, progress);
  std::vector<CompletedTooth> candidates{finish_tooth(prepared, options.steering, options.transition, progress)};
  if (count == 1) return candidates;
  // A copy: the vector moves its teeth when it grows.
  const RootInterval interval = candidates.front().record.root.interval.value();
  for (int i = 0; i + 1 < count; ++i) {
    RootSteering steering = options.steering;
    const double share = count == 2 ? 0 : static_cast<double>(i) / (count - 2);
    steering.length_mm = std::lerp(interval.length_low_mm, interval.length_high_mm, share);
    candidates.push_back(finish_tooth(prepared, steering, options.transition, progress));
  }
  return candidates;
}

}  // namespace rhizodont
