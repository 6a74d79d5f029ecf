// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/models.hpp"

#include <cstdlib>

namespace rhizodont {

CompletionModels::CompletionModels(std::unique_ptr<Content> content) : content_(std::move(content)) {}
CompletionModels::CompletionModels(CompletionModels&&) noexcept = default;
CompletionModels& CompletionModels::operator=(CompletionModels&&) noexcept = default;
CompletionModels::~CompletionModels() = default;

CompletionModels CompletionModels::load(const std::filesystem::path& folder) {
  return CompletionModels(std::make_unique<Content>(
      Content{load_atlas(folder / "atlas.safetensors"), CompletionNetwork::load(folder / "completion.safetensors")}));
}

std::filesystem::path default_models_folder() {
  if (const char* folder = std::getenv("RHIZODONT_MODELS"); folder && *folder) return folder;
  if (std::filesystem::exists(RHIZODONT_INSTALLED_MODELS)) return RHIZODONT_INSTALLED_MODELS;
  return RHIZODONT_SOURCE_MODELS;
}

}  // namespace rhizodont
