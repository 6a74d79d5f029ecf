// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/tooth_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

/// A part of the crown's colours as 0 to 255.
std::optional<std::vector<double>> colour_part(const MeshFile& crown, const std::string& name) {
  for (const std::string& spelling : {name, "diffuse_" + name}) {
    const auto place = crown.vertex_attributes.find(spelling);
    if (place == crown.vertex_attributes.end()) continue;
    const auto& [type, values] = place->second;
    const bool unit = type == AttributeType::float32 || type == AttributeType::float64;
    std::vector<double> part;
    for (const double x : values) {
      const double scaled = std::round(unit ? 255 * x : x);
      if (!(scaled >= 0 && scaled <= 255)) return std::nullopt;
      part.push_back(scaled);
    }
    return part;
  }
  return std::nullopt;
}

using Colours = std::vector<std::pair<std::string, std::vector<double>>>;

/// Red, green and blue of the crown's vertices, and alpha if it has one; empty if they are not all there.
Colours colours_of(const MeshFile& crown) {
  Colours colours;
  for (const char* name : {"red", "green", "blue"}) {
    auto part = colour_part(crown, name);
    if (!part) return {};
    colours.emplace_back(name, std::move(*part));
  }
  if (auto alpha = colour_part(crown, "alpha")) colours.emplace_back("alpha", std::move(*alpha));
  return colours;
}

/// Scan vertices as in the crown, the others in the mean of these.
VertexAttribute carried(const std::vector<double>& of_crown, const std::vector<int>& kept, std::size_t tooth_vertices) {
  VertexAttribute attribute{AttributeType::uint8, {}};
  double sum = 0;
  for (const int v : kept) {
    attribute.values.push_back(of_crown[static_cast<std::size_t>(v)]);
    sum += attribute.values.back();
  }
  attribute.values.resize(tooth_vertices, kept.empty() ? 0 : std::round(sum / static_cast<double>(kept.size())));
  return attribute;
}

}  // namespace

MeshFile tooth_file(const CompletedTooth& tooth, const MeshFile& crown) {
  MeshFile file;
  file.mesh = tooth.mesh;
  VertexAttribute source{AttributeType::uint8, {}};
  for (const VertexSource s : tooth.source) source.values.push_back(static_cast<double>(s));
  file.vertex_attributes[source_attribute] = std::move(source);
  VertexAttribute uncertainty{AttributeType::float32, {}};
  for (const double u : tooth.uncertainty) uncertainty.values.push_back(static_cast<float>(u));
  file.vertex_attributes["uncertainty"] = std::move(uncertainty);
  file.comments = {"whole tooth: scanned crown with a predicted root, not the patient's anatomy",
                   "source: 0 scan, 1 transition, 2 predicted",
                   "uncertainty: expected distance from the true surface, mm"};
  if (tooth.record.millimetres_per_unit != 1)
    file.comments.push_back("unit: " + unit_in_words(tooth.record.millimetres_per_unit));
  const Colours colours = colours_of(crown);
  for (const auto& [name, of_crown] : colours)
    file.vertex_attributes[name] = carried(of_crown, tooth.record.kept_vertices, tooth.mesh.vertices.size());
  if (!colours.empty()) file.comments.emplace_back("colours: of the scan; new vertices have their mean");
  return file;
}

void refer_to_file(CompletionRecord& record, const MeshFile& crown, const std::filesystem::path& output) {
  std::vector<std::string> notes = crown.notes;
  std::string ending = output.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  if (ending != ".ply" && !colours_of(crown).empty())
    notes.push_back("The scan's colours are not in " + ending + " files; a tooth written to .ply has them.");
  record.warnings.insert(record.warnings.begin(), notes.begin(), notes.end());
  if (crown.file_vertices.empty()) return;
  const auto renumber = [&](int& v) { v = crown.file_vertices[static_cast<std::size_t>(v)]; };
  for (int& v : record.kept_vertices) renumber(v);
  for (DroppedCrownVertex& dropped : record.dropped_vertices) renumber(dropped.vertex);
  for (RepairStep& step : record.repairs)
    for (std::vector<int>* ids : {&step.vertices, &step.merged_into})
      for (int& v : *ids) renumber(v);
  for (int& v : record.promises.crown.dropped_vertices) renumber(v);
}

InputError in_terms_of_file(const InputError& error, const MeshFile& crown) {
  const std::string sentence = error.what();
  std::vector<std::int64_t> elements = error.elements();
  if (crown.file_vertices.empty() || sentence.find("of vertices)") == std::string::npos) return error;
  for (std::int64_t& v : elements)
    if (v >= 0 && static_cast<std::size_t>(v) < crown.file_vertices.size())
      v = crown.file_vertices[static_cast<std::size_t>(v)];
  return InputError(sentence, elements);
}

}  // namespace rhizodont
