// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scan_labels.hpp"

#include "base/lower_case.hpp"
#include "io/whole_labels.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rhizodont {
namespace {

constexpr const char* what_is_expected =
    "the labels of a scan are an object {\"labels\": [a number per vertex], \"jaw\": \"upper\" or \"lower\"}";

int label_of(const nlohmann::json& entry, std::size_t place) {
  double value = 0;
  if (entry.is_number()) value = entry.get<double>();
  if (!entry.is_number() || !is_whole_label(value))
    throw InputError(fmt::format("label {} (counted from 0) of the label file is no whole number", place),
                     {static_cast<std::int64_t>(place)});
  if (value < 0)
    throw InputError(fmt::format("label {} (counted from 0) of the label file is negative ({})", place, value),
                     {static_cast<std::int64_t>(place)});
  return static_cast<int>(value);
}

std::vector<int> labels_in(const nlohmann::json& file) {
  if (file.is_array()) throw InputError(fmt::format("the label file is a list, and {}", what_is_expected));
  if (!file.is_object()) throw InputError(fmt::format("the label file is a single value, and {}", what_is_expected));
  const auto entries = file.find("labels");
  if (entries == file.end()) throw InputError(fmt::format("the label file has no 'labels': {}", what_is_expected));
  if (!entries->is_array()) throw InputError("the 'labels' of the label file are no list of numbers");
  if (entries->empty()) throw InputError("the label file has no labels: its list 'labels' is empty");
  std::vector<int> labels;
  labels.reserve(entries->size());
  for (const nlohmann::json& entry : *entries) labels.push_back(label_of(entry, labels.size()));
  return labels;
}

std::optional<Jaw> jaw_in(const nlohmann::json& file) {
  const auto entry = file.find("jaw");
  if (entry == file.end() || entry->is_null()) return std::nullopt;
  const std::string word = entry->is_string() ? lower_case(entry->get<std::string>()) : std::string("?");
  if (word.empty()) return std::nullopt;
  for (const Jaw jaw : {Jaw::lower, Jaw::upper})
    if (word == jaw_name(jaw)) return jaw;
  throw InputError("the 'jaw' of the label file is neither \"upper\" nor \"lower\"");
}

/// Per mesh vertex what most of the values that go to it say, of equally many the first's; 0 where none does.
/// Values go to no vertex where `target` is -1.
std::vector<int> most_common(const std::vector<int>& values, const std::vector<int>& target, std::size_t vertices) {
  std::vector<std::vector<int>> of_vertex(vertices);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (target[k] >= 0) of_vertex[static_cast<std::size_t>(target[k])].push_back(values[k]);
  std::vector<int> result(vertices, 0);
  for (std::size_t v = 0; v < vertices; ++v) {
    std::ptrdiff_t most = 0;
    for (const int value : of_vertex[v]) {
      const auto times = std::count(of_vertex[v].begin(), of_vertex[v].end(), value);
      if (times > most) result[v] = value;
      most = std::max(most, times);
    }
  }
  return result;
}

/// Per corner of the file's triangles the mesh's vertex; -1 for those of triangles left out.
std::vector<int> corners_in_file(const MeshFile& scan) {
  const std::size_t count = scan.mesh.triangles.size() + scan.dropped_triangles.size();
  std::vector<int> corners;
  corners.reserve(3 * count);
  std::size_t kept = 0, dropped = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const bool is_dropped =
        dropped < scan.dropped_triangles.size() && static_cast<std::size_t>(scan.dropped_triangles[dropped]) == t;
    if (is_dropped) {
      ++dropped;
      corners.insert(corners.end(), 3, -1);
      continue;
    }
    for (const std::int32_t v : scan.mesh.triangles[kept]) corners.push_back(v);
    ++kept;
  }
  return corners;
}

std::vector<int> to_mesh_vertices(std::vector<int> labels, const MeshFile& scan) {
  const std::size_t in_file = vertices_in_file(scan),
                    corners = 3 * (scan.mesh.triangles.size() + scan.dropped_triangles.size());
  if (!scan.file_numbers_vertices && labels.size() == corners)
    return most_common(labels, corners_in_file(scan), scan.mesh.vertices.size());
  if (labels.size() == in_file)
    return scan.mesh_vertices.empty() ? labels : most_common(labels, scan.mesh_vertices, scan.mesh.vertices.size());
  if (!scan.file_numbers_vertices)
    throw InputError(fmt::format(
        "there are {} labels, and an STL file does not number its vertices: labels could only be for its {} vertices "
        "at different places or for its {} corners of triangles; give the scan as PLY or OBJ, to which the labels "
        "belong",
        labels.size(), in_file, corners));
  throw InputError(
      fmt::format("there are {} labels for {} vertices: they belong to another file, or to a version of "
                  "the scan with merged or thinned vertices",
                  labels.size(), in_file));
}

enum class ArrayOf { points, cells };

struct LabelArray {
  ArrayOf of = ArrayOf::points;
  std::string name;
  const VertexAttribute* values = nullptr;

  std::string said() const { return fmt::format("the {} array {}", of == ArrayOf::points ? "point" : "cell", name); }
};

std::vector<LabelArray> arrays_of(const MeshFile& scan) {
  std::vector<LabelArray> arrays;
  for (const auto& [name, attribute] : scan.vertex_attributes) arrays.push_back({ArrayOf::points, name, &attribute});
  for (const auto& [name, attribute] : scan.triangle_attributes) arrays.push_back({ArrayOf::cells, name, &attribute});
  return arrays;
}

/// In lower case, without what programs put between words.
std::string plain_name(std::string_view name) {
  std::string plain = lower_case(name);
  std::erase_if(plain, [](char c) { return c == '_' || c == ' ' || c == '-'; });
  return plain;
}

bool is_label_name(const std::string& name) {
  static const std::vector<std::string_view> names{"label",       "labels",   "universalid", "predictedid",
                                                   "materialids", "groupids", "fdi"};
  const std::string plain = plain_name(name);
  return std::find(names.begin(), names.end(), plain) != names.end() || plain.starts_with("scalar") ||
         plain.starts_with("tooth");
}

std::optional<LabelNumbers> numbers_by_name(const std::string& name) {
  const std::string plain = plain_name(name);
  if (plain == "universalid" || plain == "predictedid") return LabelNumbers::universal;
  if (plain == "fdi") return LabelNumbers::fdi;
  return std::nullopt;
}

bool holds_labels(const LabelArray& array) {
  return std::all_of(array.values->values.begin(), array.values->values.end(), is_whole_label);
}

std::string listed(const std::vector<LabelArray>& arrays) {
  std::string text;
  for (const LabelArray& array : arrays) text += (text.empty() ? "" : ", ") + array.said();
  return text;
}

/// Those of a name in just its case, or else in any case; "point:" and "cell:" in front say whose.
std::vector<LabelArray> named(const std::vector<LabelArray>& arrays, std::string name) {
  std::optional<ArrayOf> of;
  for (const auto& [mark, whose] : {std::pair{"point:", ArrayOf::points}, std::pair{"cell:", ArrayOf::cells}})
    if (lower_case(name).starts_with(mark)) of = whose;
  if (of) name = name.substr(name.find(':') + 1);
  std::vector<LabelArray> exact, any_case;
  for (const LabelArray& array : arrays) {
    if (of && array.of != *of) continue;
    if (array.name == name) exact.push_back(array);
    if (lower_case(array.name) == lower_case(name)) any_case.push_back(array);
  }
  return exact.empty() ? any_case : exact;
}

std::vector<LabelArray> usual_arrays(const MeshFile& scan) {
  std::vector<LabelArray> arrays = arrays_of(scan);
  std::erase_if(arrays, [](const LabelArray& array) { return !is_label_name(array.name); });
  return arrays;
}

LabelArray chosen_array(const MeshFile& scan, const std::string& name) {
  const std::vector<LabelArray> all = arrays_of(scan);
  const std::string there = all.empty() ? "it has none" : "it has " + listed(all);
  std::vector<LabelArray> candidates = name.empty() ? usual_arrays(scan) : named(all, name);
  if (candidates.empty() && name.empty())
    throw InputError(fmt::format("the scan has no array of labels under one of the usual names: {}", there));
  if (candidates.empty()) throw InputError(fmt::format("the scan has no array '{}': {}", name, there));
  const std::string found = listed(candidates);
  std::erase_if(candidates, [](const LabelArray& array) { return !holds_labels(array); });
  if (candidates.empty())
    throw InputError(fmt::format("no labels of teeth: {} holds other numbers than whole ones", found));
  if (candidates.size() > 1)
    throw InputError(fmt::format("more than one array could be the labels: {}; say which by its name{}",
                                 listed(candidates), name.empty() ? "" : ", with 'point:' or 'cell:' in front"));
  return candidates.front();
}

}  // namespace

bool is_whole_label(double value) { return value == std::floor(value) && std::abs(value) <= 1e6; }

RawLabels labels_from_teeth3ds(std::string_view json, const MeshFile& scan) {
  if (json.find_first_not_of(" \t\r\n") == std::string_view::npos) throw InputError("the label file is empty");
  const nlohmann::json file = nlohmann::json::parse(json, nullptr, false);
  if (file.is_discarded())
    throw InputError("the label file is no JSON, or it is damaged or cut off: " + std::string(what_is_expected));
  RawLabels labels;
  labels.per_vertex = to_mesh_vertices(labels_in(file), scan);
  labels.origin = "the label file (Teeth3DS)";
  labels.stated_jaw = jaw_in(file);
  labels.stated_numbers = LabelNumbers::fdi;
  return labels;
}

RawLabels labels_from_array(const MeshFile& scan, const std::string& name) {
  const LabelArray array = chosen_array(scan, name);
  RawLabels labels;
  labels.per_vertex.assign(array.values->values.begin(), array.values->values.end());
  if (array.of == ArrayOf::cells) labels.per_vertex = vertex_labels_from_triangles(scan.mesh, labels.per_vertex);
  labels.origin = array.said();
  labels.stated_numbers = numbers_by_name(array.name);
  return labels;
}

bool has_label_array(const MeshFile& scan) {
  const std::vector<LabelArray> arrays = usual_arrays(scan);
  return std::any_of(arrays.begin(), arrays.end(), holds_labels);
}

std::vector<int> vertex_labels_from_triangles(const TriangleMesh& mesh, const std::vector<int>& per_triangle) {
  struct Votes {
    int number = 0, count = 0;
    double area = 0;
  };
  const VertexTriangles around = vertex_triangles(mesh);
  std::vector<double> areas(mesh.triangles.size());
  for (std::size_t t = 0; t < areas.size(); ++t) areas[t] = triangle_area(mesh, t);
  std::vector<int> result(mesh.vertices.size(), 0);
  std::vector<Votes> votes;
  for (std::size_t v = 0; v < result.size(); ++v) {
    votes.clear();
    for (int k = around.first[v]; k < around.first[v + 1]; ++k) {
      const auto t = static_cast<std::size_t>(around.triangles[static_cast<std::size_t>(k)]);
      auto place =
          std::find_if(votes.begin(), votes.end(), [&](const Votes& x) { return x.number == per_triangle[t]; });
      if (place == votes.end()) place = votes.insert(votes.end(), {per_triangle[t], 0, 0.0});
      ++place->count;
      place->area += areas[t];
    }
    const auto best = std::max_element(votes.begin(), votes.end(), [](const Votes& a, const Votes& b) {
      return std::tuple(a.count, a.area, -a.number) < std::tuple(b.count, b.area, -b.number);
    });
    if (best != votes.end()) result[v] = best->number;
  }
  return result;
}

std::vector<int> triangle_labels_from_vertices(const TriangleMesh& mesh, const std::vector<int>& per_vertex, int gum) {
  std::vector<int> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    std::array<int, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) c[i] = per_vertex[static_cast<std::size_t>(t[i])];
    std::sort(c.begin(), c.end());
    if (c[0] == c[1] || c[1] == c[2])
      result.push_back(c[1]);
    else
      result.push_back(c[0] == gum ? c[1] : c[0]);
  }
  return result;
}

}  // namespace rhizodont
