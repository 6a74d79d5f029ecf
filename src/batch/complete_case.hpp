// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/batch_models.hpp"
#include "batch/case_key.hpp"
#include "batch/manifest.hpp"
#include "rhizodont/output_files.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// What became of one tooth of a case.
struct ToothOutcome {
  int fdi = 0;
  bool rooted = false;
  std::string reason;  ///< why it has no root
  std::string file;    ///< its name in the case's folder
  double root_length_mm = 0;
  int crown_triangles = 0, kept_crown_triangles = 0;
};

/// What became of a case, with its files.
struct BatchOutcome {
  int code = 0;        ///< exit code that the case alone would have had (ErrorCode)
  std::string reason;  ///< why not all teeth have roots; empty if they have
  std::vector<ToothOutcome> teeth;
  std::vector<OutputFile> files;  ///< with their names alone

  bool succeeded() const { return code == 0; }
  std::size_t rooted() const;
};

/// Reads a case and completes it, as `rhizodont arch` and `rhizodont complete` do with a scan and a crown. Reports are
/// without times, so that a case has always the same bytes; names of files are in them only if the options say so. What
/// is wrong with the case (InputError, NoResultError, UsageError) becomes its outcome; anything else comes through.
/// @param go_on  called again and again, not from two threads at once; what it throws stops the work and comes through
BatchOutcome complete_case(const BatchCase& one, const CaseKey& key, const BatchModels& models,
                           const CaseOptions& options, const std::function<void()>& go_on);

}  // namespace rhizodont
