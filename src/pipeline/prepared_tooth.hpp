// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/with_threads.hpp"
#include "completion/complete_points.hpp"
#include "guiding/fitted_surface.hpp"
#include "pipeline/models.hpp"
#include "pipeline/workplace.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt.hpp"
#include "teeth/prepared_crown.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

struct PreparedTooth::Content {
  std::shared_ptr<const CompletionModels::Content> models;
  CompleteOptions options;
  CompletionRecord record;
  TriangleMesh input;
  Workplace place;
  std::vector<int> old_vertices, old_triangles;  ///< of the kept crown in the input, in the workplace's order
  PreparedCrown crown;                           ///< what is kept, at the workplace
  CanonicalFrame frame;                          ///< in which the root was predicted
  PredictedTooth predicted;
  FittedSurface surface;  ///< not steered
};

/// Throws UsageError, with a sentence, for options out of range.
void require_options_in_range(const CompleteOptions& options);

/// `prepare_tooth`, its parts open: the caller's alone, who may change them.
std::shared_ptr<PreparedTooth::Content> prepared_content(const TriangleMesh& crown, const CompletionModels& models,
                                                         const CompleteOptions& options,
                                                         const ProgressCallback& progress = {});

/// `finish_tooth` of these parts.
CompletedTooth finished_tooth(const PreparedTooth::Content& content, const RootSteering& steering,
                              std::optional<double> transition, const ProgressCallback& progress);

/// The sentence on options that may help a crown that was refused with these (`way_out`). @param crown_at_work the
/// input at the workplace @param kept_vertices what was kept of it, as far as that is known, with the input's numbers
std::string hint_at_options(const TriangleMesh& crown_at_work, const Workplace& place,
                            const CompletionModels::Content& models, const CompleteOptions& options,
                            const std::vector<int>& kept_vertices);

/// Runs `work`; a refusal that comes out of it gets `hint()`, a sentence or nothing, at its end.
template <class Work, class Hint>
auto hinting(const Work& work, const Hint& hint) {
  try {
    return work();
  } catch (const InputError& error) {
    throw error.reworded(error.what() + hint());
  } catch (const NoResultError& error) {
    throw NoResultError(error.what() + hint(), error.elements(), error.kind());
  }
}

}  // namespace rhizodont
