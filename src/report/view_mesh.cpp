// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/view_mesh.hpp"

#include "mesh/closest_point.hpp"
#include "mesh/quality.hpp"

#include <nlohmann/json.hpp>

#include <Eigen/Geometry>

#include <bit>
#include <cstdint>
#include <cstring>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "views are little-endian");

template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  static_assert(sizeof(Number) == 4);
  const std::size_t start = bytes.size();
  bytes.resize(start + 4 * numbers.size());
  if (!numbers.empty()) std::memcpy(bytes.data() + start, numbers.data(), 4 * numbers.size());
}

std::vector<float> floats(const std::vector<double>& numbers) {
  std::vector<float> rounded;
  rounded.reserve(numbers.size());
  for (const double x : numbers) rounded.push_back(static_cast<float>(x));
  return rounded;
}

std::vector<float> qualities(const TriangleMesh& mesh) {
  std::vector<float> q;
  q.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) q.push_back(static_cast<float>(triangle_quality(mesh, t)));
  return q;
}

std::vector<float> deviations(const TriangleMesh& crown, const CompletedTooth& tooth) {
  std::vector<float> mm(crown.vertices.size(), 0);
  std::vector<bool> is_kept(crown.vertices.size(), false);
  for (const int v : tooth.record.crown.kept_vertices) is_kept[static_cast<std::size_t>(v)] = true;
  const ClosestPointIndex surface(tooth.mesh);
  for (std::size_t v = 0; v < mm.size(); ++v)
    if (!is_kept[v])  // the others are the tooth's own vertices
      mm[v] = static_cast<float>(surface.closest(crown.vertices[v]).distance * tooth.record.millimetres_per_unit);
  return mm;
}

}  // namespace

std::string view_bytes(const ViewMesh& view) {
  const TriangleMesh& mesh = *view.mesh;
  std::string arrays;
  Json list = Json::array();
  const auto add = [&](const char* name, const char* type, const char* per, const auto& numbers) {
    list.push_back(
        {{"name", name}, {"type", type}, {"per", per}, {"offset", arrays.size()}, {"count", numbers.size()}});
    append(arrays, numbers);
  };
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Point& p : mesh.vertices)
    for (int k = 0; k < 3; ++k)
      positions.push_back(static_cast<float>((p[k] - view.middle[k]) * view.millimetres_per_unit));
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles)
    for (const auto v : triangle) indices.push_back(static_cast<std::uint32_t>(v));
  add("position", "float32", "vertex", positions);
  add("index", "uint32", "triangle", indices);
  for (const auto& [name, numbers] : view.per_vertex) add(name.c_str(), "float32", "vertex", numbers);
  for (const auto& [name, numbers] : view.per_triangle) add(name.c_str(), "float32", "triangle", numbers);
  const Point centre = view.middle * view.millimetres_per_unit;
  std::string text = Json{
      {"vertices", mesh.vertices.size()},
      {"triangles", mesh.triangles.size()},
      {"centre_mm", {centre.x(), centre.y(), centre.z()}},
      {"arrays", list}}.dump();
  while (text.size() % 4 != 0) text += ' ';
  std::string bytes = "RZV1";
  append(bytes, std::vector<std::uint32_t>{static_cast<std::uint32_t>(text.size())});
  return bytes + text + arrays;
}

std::string tooth_view(const CompletedTooth& tooth, const std::vector<double>& clearance, const Point& middle) {
  ViewMesh view{&tooth.mesh, middle, tooth.record.millimetres_per_unit, {}, {}};
  std::vector<float>& source = view.per_vertex["source"];
  for (const VertexSource s : tooth.source) source.push_back(static_cast<float>(s));
  view.per_vertex["uncertainty"] = floats(tooth.uncertainty);
  if (!clearance.empty()) view.per_vertex["clearance"] = floats(clearance);
  view.per_triangle["quality"] = qualities(tooth.mesh);
  return view_bytes(view);
}

std::string crown_view(const TriangleMesh& crown, const CompletedTooth& tooth, const Point& middle) {
  ViewMesh view{&crown, middle, tooth.record.millimetres_per_unit, {}, {}};
  std::vector<float>& kept = view.per_vertex["kept"];
  kept.resize(crown.vertices.size(), 0);
  for (const int v : tooth.record.crown.kept_vertices) kept[static_cast<std::size_t>(v)] = 1;
  view.per_vertex["deviation"] = deviations(crown, tooth);
  if (!tooth.record.crown.tooth_confidence.empty()) view.per_vertex["confidence"] = tooth.record.crown.tooth_confidence;
  view.per_triangle["quality"] = qualities(crown);
  return view_bytes(view);
}

Point middle_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Point& p : mesh.vertices) box.extend(p);
  return box.isEmpty() ? Point::Zero() : Point(box.center());
}

std::string plain_view(const TriangleMesh& mesh, const Point& middle, double millimetres_per_unit) {
  return view_bytes({&mesh, middle, millimetres_per_unit, {}, {}});
}

}  // namespace rhizodont
