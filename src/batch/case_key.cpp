// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/case_key.hpp"

#include "base/lower_case.hpp"
#include "report/json.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"
#include "rhizodont/version.hpp"
#include "teeth/label_numbers.hpp"

#include <nlohmann/json.hpp>

#include <system_error>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Raised where results change for reasons that no version tells, such as another set of files.
constexpr int layout_of_results = 1;

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json lengths_json(const std::map<int, double>& lengths) {
  Json json = Json::object();
  for (const auto& [fdi, mm] : lengths) json[std::to_string(fdi)] = mm;
  return json;
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

Json options_json(const CaseOptions& options, bool is_crown) {
  CompleteOptions tooth = is_crown ? options.crown : options.arch.tooth;
  tooth.threads = 0;
  Json json{{"tooth", Json(tooth)}, {"format", options.tooth_format}};
  if (!is_crown) {
    json["resolve_collisions"] = options.arch.resolve_collisions;
    json["clearance_mm"] = options.arch.clearance_mm;
    json["labels_vtp"] = options.labels_vtp;
    json["labels_vtk"] = options.labels_vtk;
  }
  return json;
}

Json line_json(const BatchCase& one) {
  const ScanLabelSource& labels = one.labels;
  return {{"crown", one.is_crown},
          {"fdi", value_or_null(one.fdi)},
          {"root_length_mm", value_or_null(one.root_length)},
          {"root_lengths_mm", lengths_json(one.root_lengths)},
          {"millimetres_per_unit", value_or_null(one.millimetres_per_unit)},
          {"has_labels", !labels.labels.empty()},
          {"has_palette", !labels.palette.empty()},
          {"label_array", labels.array},
          {"labels_are", labels.numbers ? Json(label_numbers_name(*labels.numbers)) : Json(nullptr)},
          {"first_is_patients_right", value_or_null(labels.first_is_patients_right)},
          {"jaw", labels.jaw ? Json(jaw_name(*labels.jaw)) : Json(nullptr)}};
}

}  // namespace

std::string ending_of(const fs::path& file) {
  const bool is_packed = lower_case(file.extension().string()) == ".gz";
  return (is_packed ? file.stem().extension().string() : "") + file.extension().string();
}

std::string text_of_options(const BatchCase& one, const CaseOptions& options) {
  return options_json(options, one.is_crown).dump();
}

std::vector<fs::path> files_of_case(const BatchCase& one) {
  std::vector<fs::path> files{one.scan};
  if (one.is_crown) return files;
  for (const fs::path& file : files_of_scan(one.scan, one.labels))
    if (file != one.scan) files.push_back(file);
  return files;
}

CaseKey key_of_case(const BatchCase& one, const CaseOptions& options, const BatchModels& models) {
  const bool of_folder = is_folder(one.scan);
  CaseKey result;
  Json files = Json::array();
  for (const fs::path& file : files_of_case(one)) {
    if (of_folder && file == one.scan && !one.is_crown) continue;
    const std::string sha256 = sha256_of_bytes(read_file_bytes(file));
    if (!of_folder && files.empty()) result.scan_sha256 = sha256;
    const bool names_tooth = of_folder || (one.is_crown && !one.fdi);
    const auto tooth = of_folder ? tooth_in_name(file) : fdi_in_name(file);
    files.push_back({{"sha256", sha256},
                     {"ending", lower_case(ending_of(file))},
                     {"tooth", names_tooth ? value_or_null(tooth) : Json(nullptr)}});
  }
  Json json{{"layout", layout_of_results},
            {"version", RHIZODONT_VERSION},
            {"models", models.completion_sha256},
            {"options", options_json(options, one.is_crown)},
            {"case", line_json(one)},
            {"files", files}};
  // A scan with labels of its own has them in its file: that is not looked into here.
  const bool may_lack_labels = !one.is_crown && !of_folder && files.size() == 1 && one.labels.array.empty();
  if (may_lack_labels && !models.finder_sha256.empty()) json["finder"] = models.finder_sha256;
  if (options.keep_names) json["name"] = one.scan.filename().string();
  constexpr std::size_t digits = 32;
  result.key = sha256_of_bytes(json.dump(-1, ' ', false, Json::error_handler_t::replace)).substr(0, digits);
  return result;
}

}  // namespace rhizodont
