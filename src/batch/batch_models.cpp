// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/batch_models.hpp"

#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"

#include <nlohmann/json.hpp>

#include <set>
#include <utility>
#include <vector>

namespace rhizodont {

BatchModels load_batch_models(const std::filesystem::path& folder) {
  BatchModels models{CompletionModels::load(folder), std::nullopt, {}};
  const std::vector<std::filesystem::path> needed = model_files(folder);
  std::set<std::filesystem::path> files(needed.begin(), needed.end());
  if (SegmentModels::are_in(folder)) {
    models.finder = SegmentModels::load(folder);
    for (std::filesystem::path& file : segment_model_files(folder)) files.insert(std::move(file));
  }
  nlohmann::json json = nlohmann::json::array();
  for (const std::filesystem::path& file : files)
    json.push_back({file.filename().string(), sha256_of_bytes(read_file_bytes(file))});
  models.sha256 = sha256_of_bytes(json.dump());
  return models;
}

}  // namespace rhizodont
