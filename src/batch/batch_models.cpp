// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/batch_models.hpp"

#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"

#include <nlohmann/json.hpp>

#include <set>
#include <vector>

namespace rhizodont {

namespace {

std::string sha256_of_files(const std::vector<std::filesystem::path>& files) {
  nlohmann::json json = nlohmann::json::array();
  for (const std::filesystem::path& file : files)
    json.push_back({file.filename().string(), sha256_of_bytes(read_file_bytes(file))});
  return sha256_of_bytes(json.dump());
}

}  // namespace

BatchModels load_batch_models(const std::filesystem::path& folder) {
  BatchModels models{CompletionModels::load(folder), sha256_of_files(model_files(folder)), std::nullopt, {}};
  if (!SegmentModels::are_in(folder)) return models;
  models.finder = SegmentModels::load(folder);
  models.finder_sha256 = sha256_of_files(segment_model_files(folder));
  return models;
}

}  // namespace rhizodont
