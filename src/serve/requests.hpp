// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "serve/job.hpp"

#include <string>
#include <string_view>

namespace rhizodont::serve {

/// A request's JSON for a job: {"scan": ID, "kind": "tooth" | "arch", "options": {...}}, the options being those of
/// `options_from_json`. Of an arch also "root_lengths_mm" {"36": 14.2}, "resolve_collisions", "clearance_mm",
/// "labels_are", "jaw", "first_label" and "label_array";
/// "corrections" of its labels, one after the other: {"number": 36, "at": [x, y, z]}, {"merge": [36, 37]}, {"split":
/// 37, "at": [x, y, z]}, {"remove": 18} (teeth/correct_labels.hpp); where the teeth are searched for, "missing" [14,
/// 24] and "teeth" {"36": [x, y, z]}, places in the scan's frame and unit.
struct SentJob {
  std::string scan;
  JobRequest request;
};

/// Throws UsageError for what is no such JSON, naming what is wrong.
SentJob read_sent_job(std::string_view text);

/// {"root_length_mm": ..., "tip_degrees": ..., "torque_degrees": ..., "bend_degrees": ..., "transition_mm": ...}; what
/// is missing is not steered. Throws UsageError.
struct SentSteering {
  RootSteering steering;
  std::optional<double> transition;
};
SentSteering read_sent_steering(std::string_view text);

/// Throws UsageError unless the text is JSON that is nested no deeper than anything here needs: what handles deeper
/// JSON might need more stack than there is.
void require_flat_json(std::string_view text);

}  // namespace rhizodont::serve
