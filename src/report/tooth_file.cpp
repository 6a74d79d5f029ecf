// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/tooth_file.hpp"
#include "base/lower_case.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <set>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

using Colours = std::vector<std::pair<std::string, std::vector<double>>>;

bool is_float(AttributeType type) { return type == AttributeType::float32 || type == AttributeType::float64; }

/// The attribute with a part of the crown's colours; null if there is none.
const VertexAttribute* colour_part(const MeshFile& crown, const std::string& name) {
  for (const std::string& spelling : {name, "diffuse_" + name})
    if (const auto place = crown.vertex_attributes.find(spelling); place != crown.vertex_attributes.end())
      return &place->second;
  return nullptr;
}

/// Red, green, blue and, if the crown has it, alpha of its vertices; empty if the first three are not all there.
std::vector<std::pair<std::string, const VertexAttribute*>> colour_parts(const MeshFile& crown) {
  std::vector<std::pair<std::string, const VertexAttribute*>> parts;
  for (const char* name : {"red", "green", "blue", "alpha"})
    if (const VertexAttribute* part = colour_part(crown, name)) parts.emplace_back(name, part);
  const bool has_three = parts.size() >= 3 && parts[2].first == "blue";
  return has_three ? parts : std::vector<std::pair<std::string, const VertexAttribute*>>{};
}

/// The crown's colours as 0 to 255: floats up to 1 are shares of that. Empty if there are none, or others.
Colours colours_of(const MeshFile& crown) {
  const auto parts = colour_parts(crown);
  const bool are_shares = std::all_of(parts.begin(), parts.end(), [](const auto& part) {
    const std::vector<double>& values = part.second->values;
    return !is_float(part.second->type) || std::all_of(values.begin(), values.end(), [](double x) { return x <= 1; });
  });
  Colours colours;
  for (const auto& [name, part] : parts) {
    colours.emplace_back(name, std::vector<double>());
    for (const double x : part->values) {
      const double scaled = std::round(is_float(part->type) && are_shares ? 255 * x : x);
      if (!(scaled >= 0 && scaled <= 255)) return {};
      colours.back().second.push_back(scaled);
    }
  }
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

std::vector<std::int64_t> ids_in_file(const Error& error, const MeshFile& crown) {
  std::vector<std::int64_t> ids = error.elements();
  const bool of_vertices = error.kind() == ElementKind::vertices || error.kind() == ElementKind::vertex_pairs;
  if (crown.file_vertices.empty() || !of_vertices) return ids;
  for (std::int64_t& v : ids)
    if (v >= 0 && static_cast<std::size_t>(v) < crown.file_vertices.size())
      v = crown.file_vertices[static_cast<std::size_t>(v)];
  return ids;
}

/// The runs of digits in a name, but for dates (2026-11-27, 27.11.2026, 2026_11), whose days and months look like
/// teeth.
std::vector<std::string> numbers_in(std::string name) {
  static const std::string year = "(19|20)[0-9]{2}", month = "(0[1-9]|1[0-2])", day = "(0[1-9]|[12][0-9]|3[01])",
                           gap = "[-_. ]", before = "(^|[^0-9])", after = "(?![0-9])";
  static const std::regex year_first(before + year + gap + month + "(" + gap + day + ")?" + after),
      year_last(before + "(" + day + gap + ")?" + month + gap + year + after), digits("[0-9]+");
  for (const std::regex& date : {year_first, year_last}) name = std::regex_replace(name, date, "$1");
  return {std::sregex_token_iterator(name.begin(), name.end(), digits), std::sregex_token_iterator()};
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
    file.vertex_attributes[name] = carried(of_crown, tooth.record.crown.kept_vertices, tooth.mesh.vertices.size());
  if (!colours.empty()) file.comments.emplace_back("colours: of the scan; new vertices have their mean");
  return file;
}

MeshFile confidence_file(const MeshFile& crown, const CompletionRecord& record) {
  MeshFile file;
  file.mesh = crown.mesh;
  VertexAttribute confidence{AttributeType::float32, {}};
  for (const float c : record.crown.tooth_confidence) confidence.values.push_back(static_cast<double>(c));
  file.vertex_attributes["confidence"] = std::move(confidence);
  VertexAttribute kept{AttributeType::uint8, std::vector<double>(crown.mesh.vertices.size(), 0)};
  for (const int v : record.crown.kept_vertices) kept.values[static_cast<std::size_t>(v)] = 1;
  file.vertex_attributes["kept"] = std::move(kept);
  file.comments = {"confidence: that a vertex is tooth and not skirt, 0 to 1; -1 not judged", "kept: 1 in the tooth"};
  return file;
}

std::optional<int> fdi_in_name(const std::filesystem::path& file) {
  std::set<int> found;
  for (const std::string& number : numbers_in(file.stem().string()))
    if (const auto fdi = read_fdi(number); fdi && is_permanent_tooth(*fdi)) found.insert(*fdi);
  return found.size() == 1 ? std::optional(*found.begin()) : std::nullopt;
}

std::optional<double> round_coordinates(MeshFile& crown, double millimetres_per_unit) {
  const double moved = round_to_float(crown.mesh);
  return moved > 0 ? std::optional(moved * millimetres_per_unit) : std::nullopt;
}

void require_format_holds_crown(const MeshFile& crown, const std::string& crown_name,
                                const std::filesystem::path& output, const std::filesystem::path& written_as) {
  if (crown.coordinates_fit_float || !holds_floats_only(written_as)) return;
  throw UsageError(crown_name + " has coordinates with more digits than " + output.string() +
                   " can hold: give the tooth a name in .ply or .obj, or have the crown rounded (--as-float).");
}

void warn_of_rounding(const ReportedInput& input, CompletionRecord& record) {
  if (input.rounded_mm)
    record.warnings.push_back(fmt::format(
        "The crown's coordinates were rounded to float (--as-float), by {:.1g} mm at most.", *input.rounded_mm));
}

void require_format_holds(const CompletedTooth& tooth, const std::filesystem::path& output) {
  if (!holds_floats_only(output) || coordinates_fit_float(tooth.mesh)) return;
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
    if (tooth.source[v] == VertexSource::scan && !coordinates_fit_float({{tooth.mesh.vertices[v]}, {}}))
      throw NoResultError(output.string() +
                          " cannot hold this tooth: its crown's coordinates have more digits than single precision. "
                          "Give the tooth a name in .ply.");
  throw NoResultError(output.string() +
                      " cannot hold this tooth: the crown lies so far from the origin that single precision is too "
                      "coarse for new triangles there. Move the scan to the origin, or give the tooth a name in .ply.");
}

void refer_to_file(CompletionRecord& record, const MeshFile& crown, const std::filesystem::path& output) {
  std::vector<std::string> notes = crown.notes;
  const std::string ending = lower_case(output.extension().string());
  const bool has_colours = !colours_of(crown).empty();
  if (!has_colours && !colour_parts(crown).empty())
    notes.push_back("The scan's colours were left out: they are not between 0 and 255.");
  if (ending != ".ply" && has_colours)
    notes.push_back("The scan's colours are not in " + ending + " files; a tooth written to .ply has them.");
  record.warnings.insert(record.warnings.begin(), notes.begin(), notes.end());
  if (crown.file_vertices.empty()) return;
  const auto renumber = [&](int& v) { v = crown.file_vertices[static_cast<std::size_t>(v)]; };
  for (int& v : record.crown.kept_vertices) renumber(v);
  for (DroppedCrownVertex& dropped : record.crown.dropped_vertices) renumber(dropped.vertex);
  for (MissedPlace& place : record.missed_places)
    for (int& v : place.crown_vertices) renumber(v);
  for (RepairStep& step : record.repairs)
    for (std::vector<int>* ids : {&step.vertices, &step.merged_into})
      for (int& v : *ids) renumber(v);
  for (int& v : record.promises.crown.dropped_vertices) renumber(v);
}

InputError in_terms_of_file(const InputError& error, const MeshFile& crown) {
  return InputError(error.what(), ids_in_file(error, crown), error.kind());
}

NoResultError in_terms_of_file(const NoResultError& error, const MeshFile& crown) {
  return NoResultError(error.what(), ids_in_file(error, crown), error.kind());
}

}  // namespace rhizodont
