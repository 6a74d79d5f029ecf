// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "batch/complete_case.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>

// Where results of a batch lie: FOLDER/cases/KEY, which appears whole, by one move. Its case.json lists all else that
// is in it, and makes it complete.
namespace rhizodont {

inline constexpr int case_record_version = 1;

std::filesystem::path case_folder(const std::filesystem::path& batch, const std::string& key);

/// The outcome of a case whose folder is there and complete, files without their bytes; else nothing.
std::optional<BatchOutcome> find_case(const std::filesystem::path& batch, const std::string& key);

/// Puts a case's files into its folder: they are written and brought to the disk beside it, in FOLDER/unfinished/RUN,
/// and moved there together. A complete folder that is there already stays, unless it is to be replaced: shards may
/// have a case in common. Throws OutputError.
/// @param run  a name that no other process has
void place_case(const std::filesystem::path& batch, const std::string& key, const BatchOutcome& outcome,
                const std::string& run, bool replace);

/// Takes away what earlier runs of the shard, whose names begin so, left behind unfinished, and anyone's from days ago.
void remove_unfinished(const std::filesystem::path& batch, const std::string& shard);

/// One tooth as ledger and case.json have it.
nlohmann::ordered_json tooth_outcome_json(const ToothOutcome& tooth);

}  // namespace rhizodont
