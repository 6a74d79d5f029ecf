// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/models.hpp"
#include "rhizodont/segment.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace rhizodont {

/// What all cases of a batch are completed with, loaded once.
struct BatchModels {
  CompletionModels completion;
  std::string completion_sha256;        ///< of its files with their names: goes into every key
  std::optional<SegmentModels> finder;  ///< nothing: scans without labels are refused
  std::string finder_sha256;            ///< goes into the keys of scans that may have no labels; empty: no finder
};

/// Loads them from a folder; the network that finds teeth only if it is there. Throws InputError as
/// `CompletionModels::load` and `SegmentModels::load` do.
BatchModels load_batch_models(const std::filesystem::path& folder);

}  // namespace rhizodont
