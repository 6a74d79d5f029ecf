// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/loaded_blas.hpp"
#include "doctor/machine.hpp"
#include "rhizodont/error.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont::doctor {

/// A file of the models' folder.
struct ModelFinding {
  std::string name;  ///< completion.safetensors
  bool is_there = false;
  bool is_needed = false;  ///< without it nothing can be completed
  std::uintmax_t bytes = 0;
  std::string sha256;       ///< empty if it cannot be read
  std::string version;      ///< of its format, as the file itself says; empty if it does not
  std::string trained;      ///< day, as the file itself says; empty if it does not
  bool is_shipped = false;  ///< the very file that this program was built beside
  std::string fault;        ///< why it cannot be used; empty if it can
};

/// A crown that is part of the program, completed with default options and proved by `check`.
struct SelfTest {
  double loading_seconds = 0, completing_seconds = 0, checking_seconds = 0;
  std::int64_t crown_triangles = 0, kept_triangles = 0;
  double root_length_mm = 0;
  std::vector<std::string> failures;  ///< a sentence each; empty: the tooth is as promised
};

struct Examination {
  std::string version;  ///< of the program
  Machine machine;
  std::vector<std::pair<std::string, std::string>> libraries;
  LoadedBlas blas;
  bool has_pages = false;  ///< reports as pages and the page of `serve` were built in
  std::filesystem::path models_folder;
  std::vector<ModelFinding> models;
  std::optional<SelfTest> self_test;  ///< nothing where models are missing or damaged
  std::vector<std::string> warnings;  ///< it works, but not as it could; a sentence each
  std::vector<std::string> faults;    ///< it does not work; a sentence each

  /// What the program ends with: nothing if there are no faults, `unusable_input` for models that are missing or
  /// damaged, `no_result` if the self test failed.
  std::optional<ErrorCode> code;
};

/// Looks at machine, libraries and models, and completes the built-in crown. Takes about two seconds. Whatever is wrong
/// is in what it returns.
Examination examine(const std::filesystem::path& models_folder);

/// The self test alone. Throws as `CompletionModels::load` and `complete_tooth`.
SelfTest self_test(const std::filesystem::path& models_folder);

/// For `nlohmann::ordered_json(value)`.
void to_json(nlohmann::ordered_json& json, const Examination& found);

}  // namespace rhizodont::doctor
