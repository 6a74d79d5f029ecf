// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/models.hpp"

#include <dlfcn.h>

#include <cstdlib>

namespace rhizodont {

CompletionModels::CompletionModels(std::unique_ptr<Content> content) : content_(std::move(content)) {}
CompletionModels::CompletionModels(CompletionModels&&) noexcept = default;
CompletionModels& CompletionModels::operator=(CompletionModels&&) noexcept = default;
CompletionModels::~CompletionModels() = default;

CompletionModels CompletionModels::load(const std::filesystem::path& folder) {
  auto content = std::make_unique<Content>(Content{load_atlas(folder / "atlas.safetensors"),
                                                   CompletionNetwork::load(folder / "completion.safetensors"),
                                                   std::nullopt, std::nullopt});
  std::error_code ignored;
  if (const auto skirt = folder / "skirt.safetensors"; std::filesystem::exists(skirt, ignored))
    content->skirt = SurfaceNetwork::load(skirt);
  if (const auto likeness = folder / "likeness.safetensors"; std::filesystem::exists(likeness, ignored))
    content->likeness = load_likeness(likeness);
  return CompletionModels(std::move(content));
}

namespace {

/// share/rhizodont/models beside the folder that holds this code (bin, lib or lib/<architecture>); empty if not
/// installed.
std::filesystem::path installed_models() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&default_models_folder), &info) == 0 || !info.dli_fname) return {};
  const std::filesystem::path folder = std::filesystem::weakly_canonical(info.dli_fname).parent_path();
  for (const char* up : {"..", "../.."}) {
    const std::filesystem::path models = folder / up / "share/rhizodont/models";
    if (std::filesystem::exists(models / "completion.safetensors")) return models.lexically_normal();
  }
  return {};
}

}  // namespace

std::filesystem::path default_models_folder() {
  if (const char* folder = std::getenv("RHIZODONT_MODELS"); folder && *folder) return folder;
  const std::filesystem::path installed = installed_models();
  return installed.empty() ? std::filesystem::path(RHIZODONT_SOURCE_MODELS) : installed;
}

}  // namespace rhizodont
