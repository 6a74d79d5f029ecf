// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

namespace rhizodont {
namespace {

/// From the file's numbers of vertices to those of the mesh that was read.
class VerticesOfFile {
 public:
  explicit VerticesOfFile(const std::vector<int>& file_vertices) {
    for (std::size_t v = 0; v < file_vertices.size(); ++v) numbers_.emplace(file_vertices[v], static_cast<int>(v));
  }

  int in_mesh(int number) const { return numbers_.empty() ? number : numbers_.at(number); }

 private:
  std::map<int, int> numbers_;
};

std::vector<int> ids_of(const nlohmann::json& step, const char* name, const VerticesOfFile& vertices) {
  std::vector<int> ids;
  for (const auto& id : step.at(name)) ids.push_back(vertices.in_mesh(id.get<int>()));
  return ids;
}

ExcusedByReport excused(const nlohmann::json& report, const std::vector<int>& file_vertices) {
  ExcusedByReport result;
  std::set<std::string> repairs;
  const VerticesOfFile vertices(file_vertices);
  for (const auto& json : report.at("repairs")) {
    const std::string action = json.at("action");
    RepairStep step{action_of_text(action), ids_of(json, "vertices", vertices), json.at("triangles")};
    if (json.contains("merged_into")) step.merged_into = ids_of(json, "merged_into", vertices);
    if (!step.merged_into.empty() && step.merged_into.size() != step.vertices.size())
      throw std::out_of_range("merged_into");
    repairs.insert(action);
    result.repairs.push_back(std::move(step));
  }
  for (const auto& [reason, ids] : report.at("crown").at("dropped_vertices_by_reason").items())
    if (!repairs.contains(reason))
      for (const auto& id : ids) result.dropped_vertices.push_back(vertices.in_mesh(id.get<int>()));
  return result;
}

}  // namespace

ExcusedByReport excused_by_report(const std::filesystem::path& report, const std::string& crown_sha256,
                                  const std::vector<int>& file_vertices) {
  std::string text;
  try {
    text = read_file_bytes(report);
  } catch (const InputError& error) {
    throw InputError(report.string() + ": " + error.what());
  }
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("input").at("sha256").get<std::string>() != crown_sha256)
      throw InputError(fmt::format("{} is the report on another crown.", report.string()));
    if (json.contains("refused"))
      throw InputError(fmt::format("{} says that this crown was refused: there is no tooth of it.", report.string()));
    return excused(json, file_vertices);
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{} is not a report of rhizodont complete.", report.string()));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format("{} names vertices that the crown does not have.", report.string()));
  }
}

CheckOptions allowing_for(const ExcusedByReport& excused) {
  CheckOptions options = allowing_for(excused.repairs);
  options.dropped_vertices = excused.dropped_vertices;
  return options;
}

}  // namespace rhizodont
