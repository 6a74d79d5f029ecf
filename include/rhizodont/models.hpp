// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace rhizodont {

/// Weights and mean crowns, loaded once and used for many teeth, from several threads if wished.
class RHIZODONT_EXPORT CompletionModels {
 public:
  /// Reads completion.safetensors and atlas.safetensors from a folder, and skirt.safetensors, likeness.safetensors,
  /// arch.safetensors and pose.safetensors if they are there. Throws InputError if one is missing or damaged.
  static CompletionModels load(const std::filesystem::path& folder);
  CompletionModels(CompletionModels&&) noexcept;
  CompletionModels& operator=(CompletionModels&&) noexcept;
  ~CompletionModels();

  struct Content;

 private:
  friend const std::shared_ptr<const Content>& content_of(const CompletionModels& models);
  explicit CompletionModels(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/// The files that `CompletionModels::load` reads from a folder. Throws InputError if one that it needs is not there.
RHIZODONT_EXPORT std::vector<std::filesystem::path> model_files(const std::filesystem::path& folder);

/// The folder with the shipped models: $RHIZODONT_MODELS, else where they were installed, else the source tree's.
RHIZODONT_EXPORT std::filesystem::path default_models_folder();

}  // namespace rhizodont
