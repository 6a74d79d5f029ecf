// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/models.hpp"

#include "rhizodont/error.hpp"

#include <dlfcn.h>
#include <sys/auxv.h>

#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace rhizodont {

CompletionModels::CompletionModels(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
CompletionModels::CompletionModels(CompletionModels&&) noexcept = default;
CompletionModels& CompletionModels::operator=(CompletionModels&&) noexcept = default;
CompletionModels::~CompletionModels() = default;

const std::shared_ptr<const CompletionModels::Content>& content_of(const CompletionModels& models) {
  return models.content_;
}

namespace {

constexpr const char* skirt_file = "skirt.safetensors";
constexpr const char* likeness_file = "likeness.safetensors";
constexpr const char* arch_file = "arch.safetensors";
constexpr const char* pose_file = "pose.safetensors";

}  // namespace

std::vector<std::filesystem::path> model_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const char* needed : needed_model_files) {
    files.push_back(folder / needed);
    std::error_code ignored;
    if (!std::filesystem::exists(files.back(), ignored))
      throw InputError("There is no " + std::string(needed) + " in " + folder.string() +
                       ", where the models should be.");
  }
  std::error_code ignored;
  for (const char* optional : {skirt_file, likeness_file, arch_file, pose_file})
    if (std::filesystem::exists(folder / optional, ignored)) files.push_back(folder / optional);
  return files;
}

CompletionModels CompletionModels::load(const std::filesystem::path& folder) {
  model_files(folder);
  auto content = std::make_shared<Content>(Content{load_atlas(folder / atlas_file),
                                                   CompletionNetwork::load(folder / completion_file), std::nullopt,
                                                   std::nullopt, std::nullopt, std::nullopt});
  std::error_code ignored;
  if (const auto skirt = folder / skirt_file; std::filesystem::exists(skirt, ignored))
    content->skirt = SurfaceNetwork::load(skirt);
  if (const auto likeness = folder / likeness_file; std::filesystem::exists(likeness, ignored))
    content->likeness = load_likeness(likeness);
  if (const auto arch = folder / arch_file; std::filesystem::exists(arch, ignored))
    content->arch = load_arch_model(arch);
  if (const auto pose = folder / pose_file; std::filesystem::exists(pose, ignored))
    content->pose.emplace(read_safetensors(pose));
  return CompletionModels(std::move(content));
}

namespace {

/// share/rhizodont/models beside the folder that holds this code (bin, lib or lib/<architecture>); empty if not
/// installed.
std::filesystem::path installed_models() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&default_models_folder), &info) == 0 || !info.dli_fname) return {};
  // Of a program that was found in PATH the linker knows the bare name alone.
  const bool is_program = std::string_view(info.dli_fname) == program_invocation_name;
  const auto* started_as = reinterpret_cast<const char*>(getauxval(AT_EXECFN));  // with its folder, also without /proc
  const std::filesystem::path code = is_program && started_as != nullptr ? started_as : info.dli_fname;
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::weakly_canonical(code, ignored).parent_path();
  for (const char* up : {"..", "../.."}) {
    const std::filesystem::path models = folder / up / "share/rhizodont/models";
    if (std::filesystem::exists(models / completion_file)) return models.lexically_normal();
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
