// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rhizodont::doctor {

/// What this process may use of the machine.
struct Machine {
  int processors = 0;                  ///< that it may run on
  int threads = 0;                     ///< that the library uses where no number is given
  double memory_mb = 0;                ///< of the machine or, if that is less, of the group that the process is in
  double free_memory_mb = 0;           ///< of it, that can be had without swapping
  bool has_fused_multiply_add = true;  ///< false: slower, and the last digits of predictions differ
};

/// Asks the system. Throws nothing: what it does not tell is 0.
/// @param root  the folder in which proc/ and sys/ stand: where memory and its limits are read
Machine this_machine(const std::filesystem::path& root = "/");

/// A line "NAME: NUMBER kB" of /proc/meminfo in MB; nothing if there is none.
std::optional<double> meminfo_mb(std::string_view meminfo, std::string_view name);

/// Libraries that this program runs with, each with its version; the compiler that built it comes first.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace rhizodont::doctor
