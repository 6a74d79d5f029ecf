// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "doctor/examine.hpp"

#include "base/asset.hpp"
#include "base/stopwatch.hpp"
#include "doctor/shipped_models.hpp"
#include "networks/safetensors.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/hash.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report_page.hpp"
#include "rhizodont/version.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rhizodont {

const std::vector<Asset>& doctor_assets();  // written by CMake

namespace doctor {
namespace {

constexpr int crown_fdi = 23;
constexpr double least_free_mb = 1024;  // what one tooth may take

std::string value_or_empty(const std::map<std::string, std::string>& metadata, const char* name) {
  const auto found = metadata.find(name);
  return found == metadata.end() ? "" : found->second;
}

ModelFinding look_at(const std::filesystem::path& folder, const ShippedModel& shipped) {
  ModelFinding model;
  model.name = shipped.name;
  model.is_needed = std::ranges::find(needed_model_files, model.name) != needed_model_files.end();
  const std::filesystem::path file = folder / shipped.name;
  std::error_code ignored;
  model.is_there = std::filesystem::exists(file, ignored);
  if (!model.is_there) return model;
  try {
    const std::string bytes = read_file_bytes(file);
    model.bytes = bytes.size();
    model.sha256 = sha256_of_bytes(bytes);
    model.is_shipped = model.sha256 == shipped.sha256;
    const TensorFile content = read_safetensors(file);
    model.version = value_or_empty(content.metadata, "format");
    model.trained = value_or_empty(content.metadata, "training.date");
  } catch (const Error& error) {
    model.fault = error.what();
  }
  return model;
}

/// What a file of models/ that is not needed is for, as a sentence about its lack.
std::string_view lack_of(std::string_view name) {
  if (name == "skirt.safetensors") return "no skirt can be dropped (--skirt auto), and the teeth of scans get no roots";
  if (name == "likeness.safetensors")
    return "nobody warns of a crown that is not like the tooth of its number, and one without number is guessed less "
           "surely";
  if (name == "arch.safetensors") return "teeth of scans are not found, and get no roots";
  if (name == "pose.safetensors") return "roots of single crowns are turned and lean less surely as they should";
  if (name == "segment.safetensors") return "only scans with labels get roots, and segment is refused";
  return "what needs it does not work";
}

void judge_models(Examination& found) {
  for (const ModelFinding& model : found.models) {
    if (!model.is_there && model.is_needed)
      found.faults.push_back(fmt::format(
          "There is no {} in {}: nothing can be completed. Install the models (package rhizodont-models), or "
          "name their folder (--models, RHIZODONT_MODELS).",
          model.name, found.models_folder.string()));
    else if (!model.is_there)
      found.warnings.push_back(
          fmt::format("There is no {} in {}: {}.", model.name, found.models_folder.string(), lack_of(model.name)));
    else if (!model.fault.empty())
      found.faults.push_back(fmt::format("{} cannot be used: {}", model.name, model.fault));
    else if (!model.is_shipped)
      found.warnings.push_back(
          fmt::format("{} is not the file that belongs to this version: results differ from those that were measured.",
                      model.name));
  }
}

void judge_machine(Examination& found) {
  const Machine& machine = found.machine;
  if (machine.free_memory_mb > 0 && machine.free_memory_mb < least_free_mb)
    found.warnings.push_back(fmt::format("{:.0f} MB of memory are free; a tooth may take up to 1000, an arch more.",
                                         machine.free_memory_mb));
  if (!machine.has_fused_multiply_add)
    found.warnings.emplace_back(
        "This processor has no fused multiply-add: predictions take longer, and their last digits differ from those of "
        "other machines.");
  if (!found.blas.path.empty() && !found.blas.fast)
    found.warnings.push_back(
        fmt::format("The linear algebra library {} is loaded, not the OpenMP build of OpenBLAS (package "
                    "libopenblas0-openmp): what uses it is slow.",
                    found.blas.path));
  if (!found.has_pages)
    found.warnings.emplace_back(
        "The program was built without its pages: rhizodont serve has its API alone, and reports "
        "are JSON alone.");
}

void run_self_test(Examination& found) {
  try {
    found.self_test = self_test(found.models_folder);
    for (const std::string& failure : found.self_test->failures) found.faults.push_back("Self test: " + failure);
    if (!found.self_test->failures.empty()) found.code = ErrorCode::no_result;
  } catch (const InputError& error) {  // models that can be read but are of another kind
    found.faults.push_back(std::string("Self test: ") + error.what());
    found.code = ErrorCode::unusable_input;
  } catch (const Error& error) {
    found.faults.push_back(std::string("Self test: ") + error.what());
    found.code = ErrorCode::no_result;
  }
}

}  // namespace

SelfTest self_test(const std::filesystem::path& models_folder) {
  SelfTest test;
  const Stopwatch loading;
  const CompletionModels models = CompletionModels::load(models_folder);
  test.loading_seconds = loading.seconds();
  const Asset& asset = doctor_assets().front();
  const TriangleMesh crown = read_mesh(asset.bytes, std::string(asset.name)).mesh;
  CompleteOptions options;
  options.fdi = crown_fdi;
  const Stopwatch completing;
  const CompletedTooth tooth = complete_tooth(crown, models, options);
  test.completing_seconds = completing.seconds();
  test.root_length_mm = tooth.record.root.length_mm;
  const Stopwatch checking;
  const CheckReport report = check(crown, tooth.mesh);  // an open crown: all of it is demanded
  test.checking_seconds = checking.seconds();
  test.crown_triangles = report.crown.triangles;
  test.kept_triangles = report.crown.kept_triangles;
  test.failures = report.failures;
  if (test.kept_triangles != test.crown_triangles)
    test.failures.push_back(fmt::format("only {} of {} triangles of the crown are in the tooth.", test.kept_triangles,
                                        test.crown_triangles));
  return test;
}

Examination examine(const std::filesystem::path& models_folder) {
  Examination found;
  found.version = RHIZODONT_VERSION;
  found.machine = this_machine();
  found.libraries = library_versions();
  found.blas = loaded_blas();
  found.has_pages = has_report_pages();
  found.models_folder = models_folder;
  for (const ShippedModel& shipped : shipped_models()) found.models.push_back(look_at(models_folder, shipped));
  judge_models(found);
  if (!found.faults.empty())
    found.code = ErrorCode::unusable_input;
  else
    run_self_test(found);
  judge_machine(found);
  return found;
}

void to_json(nlohmann::ordered_json& json, const Examination& found) {
  using Json = nlohmann::ordered_json;
  Json libraries = Json::object(), models = Json::array(), test = nullptr;
  for (const auto& [name, version] : found.libraries) libraries[name] = version;
  for (const ModelFinding& model : found.models)
    models.push_back({{"name", model.name},
                      {"there", model.is_there},
                      {"needed", model.is_needed},
                      {"bytes", model.bytes},
                      {"sha256", model.sha256},
                      {"version", model.version},
                      {"trained", model.trained},
                      {"as_shipped", model.is_shipped},
                      {"fault", model.fault}});
  if (const auto& done = found.self_test)
    test = {{"holds", done->failures.empty()},
            {"loading_seconds", done->loading_seconds},
            {"completing_seconds", done->completing_seconds},
            {"checking_seconds", done->checking_seconds},
            {"crown_triangles", done->crown_triangles},
            {"kept_triangles", done->kept_triangles},
            {"root_length_mm", done->root_length_mm},
            {"failures", done->failures}};
  const Machine& machine = found.machine;
  json = {{"well", found.faults.empty()},
          {"program", {{"name", "rhizodont"}, {"version", found.version}, {"pages", found.has_pages}}},
          {"libraries", libraries},
          {"machine",
           {{"processors", machine.processors},
            {"threads", machine.threads},
            {"memory_mb", machine.memory_mb},
            {"free_memory_mb", machine.free_memory_mb},
            {"fused_multiply_add", machine.has_fused_multiply_add}}},
          {"blas", found.blas.path.empty() ? Json(nullptr) : Json(found.blas.path)},
          {"models_folder", found.models_folder.string()},
          {"models", models},
          {"self_test", test},
          {"warnings", found.warnings},
          {"faults", found.faults}};
}

}  // namespace doctor
}  // namespace rhizodont
