// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/case_folders.hpp"

#include "report/json.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <system_error>
#include <vector>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* record_name = "case.json";

ToothOutcome tooth_from_json(const Json& json) {
  ToothOutcome tooth;
  tooth.fdi = json.at("fdi");
  tooth.rooted = json.at("rooted");
  if (!tooth.rooted) {
    tooth.reason = json.at("reason");
    return tooth;
  }
  tooth.file = json.at("file");
  tooth.root_length_mm = json.at("root_length_mm");
  tooth.crown_triangles = json.at("crown_triangles");
  tooth.kept_crown_triangles = json.at("kept_crown_triangles");
  return tooth;
}

std::string record_text(const BatchOutcome& outcome, const std::string& key) {
  Json teeth = Json::array(), files = Json::array();
  for (const ToothOutcome& tooth : outcome.teeth) teeth.push_back(tooth_outcome_json(tooth));
  for (const OutputFile& file : outcome.files)
    files.push_back(
        {{"name", file.path.string()}, {"bytes", file.bytes.size()}, {"sha256", sha256_of_bytes(file.bytes)}});
  return text_of({{"case_version", case_record_version},
                  {"key", key},
                  {"code", outcome.code},
                  {"reason", outcome.reason},
                  {"teeth", teeth},
                  {"files", files}});
}

std::string in_words(const std::error_code& failure) { return failure.message(); }

[[noreturn]] void throw_unplaced(const fs::path& folder, const std::error_code& failure) {
  throw OutputError(fmt::format("{} cannot be written: {}.", folder.string(), in_words(failure)));
}

/// A folder's entries on the disk; where that cannot be done it is not worth a failure.
void synchronise(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

bool is_older_than_days(const fs::path& path, int days) {
  std::error_code failure;
  const auto written = fs::last_write_time(path, failure);
  return !failure && fs::file_time_type::clock::now() - written > std::chrono::hours(24 * days);
}

}  // namespace

Json tooth_outcome_json(const ToothOutcome& tooth) {
  if (!tooth.rooted) return {{"fdi", tooth.fdi}, {"rooted", false}, {"reason", tooth.reason}};
  return {{"fdi", tooth.fdi},
          {"rooted", true},
          {"file", tooth.file},
          {"root_length_mm", tooth.root_length_mm},
          {"crown_triangles", tooth.crown_triangles},
          {"kept_crown_triangles", tooth.kept_crown_triangles}};
}

fs::path case_folder(const fs::path& batch, const std::string& key) { return batch / "cases" / key; }

std::optional<BatchOutcome> find_case(const fs::path& batch, const std::string& key) {
  const fs::path folder = case_folder(batch, key);
  try {
    const Json json = Json::parse(read_file_bytes(folder / record_name));
    if (json.at("case_version") != case_record_version || json.at("key") != key) return std::nullopt;
    BatchOutcome outcome;
    outcome.code = json.at("code");
    outcome.reason = json.at("reason");
    for (const Json& tooth : json.at("teeth")) outcome.teeth.push_back(tooth_from_json(tooth));
    for (const Json& file : json.at("files")) {
      outcome.files.push_back({file.at("name").get<std::string>(), {}});
      std::error_code failure;
      if (fs::file_size(folder / outcome.files.back().path, failure) != file.at("bytes") || failure)
        return std::nullopt;
    }
    return outcome;
  } catch (const InputError&) {  // no such file
    return std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void place_case(const fs::path& batch, const std::string& key, const BatchOutcome& outcome, const std::string& run,
                bool replace) {
  const fs::path staged = batch / "unfinished" / run / key, folder = case_folder(batch, key),
                 older = staged.string() + ".older";
  std::vector<OutputFile> files;
  for (const OutputFile& file : outcome.files) files.push_back({staged / file.path, file.bytes});
  files.push_back({staged / record_name, record_text(outcome, key)});
  write_output_files(files);
  std::error_code failure;
  fs::create_directories(folder.parent_path(), failure);
  if (failure) throw_unplaced(folder.parent_path(), failure);
  fs::rename(staged, folder, failure);
  std::error_code ignored;
  if (failure && fs::exists(folder, ignored)) {
    if (!replace && find_case(batch, key)) {
      fs::remove_all(staged, ignored);  // another shard has done it meanwhile; the bytes are the same
      return;
    }
    fs::rename(folder, older, failure);
    if (!failure) fs::rename(staged, folder, failure);
  }
  if (failure) throw_unplaced(folder, failure);
  synchronise(folder.parent_path());
  fs::remove_all(older, ignored);
}

void remove_unfinished(const fs::path& batch, const std::string& shard) {
  constexpr int days = 7;
  std::error_code failure;
  std::vector<fs::path> left;
  for (fs::directory_iterator entry(batch / "unfinished", failure), end; !failure && entry != end;
       entry.increment(failure))
    if (entry->path().filename().string().starts_with(shard + ".") || is_older_than_days(entry->path(), days))
      left.push_back(entry->path());
  for (const fs::path& folder : left) fs::remove_all(folder, failure);
}

}  // namespace rhizodont
