// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "base/lower_case.hpp"
#include "io/attribute_types.hpp"
#include "io/formats.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

using Writer = std::string (*)(const MeshFile&);

template <class Function>
Function function_for(const fs::path& path, const std::map<std::string, Function>& known, const char* verb) {
  const auto place = known.find(lower_case(path.extension().string()));
  if (place != known.end()) return place->second;
  std::string names;
  for (const auto& [name, function] : known) names += (names.empty() ? "" : ", ") + name;
  throw UsageError(fmt::format("{}: only files named {} can be {}", path.string(), names, verb));
}

Writer writer_for(const fs::path& path) {
  static const std::map<std::string, Writer> writers{
      {".ply", write_ply}, {".stl", write_stl}, {".obj", write_obj}, {".glb", write_glb}};
  return function_for(path, writers, "written");
}

bool holds_exactly(const VertexAttribute& attribute) {
  return with_attribute_type(attribute.type, [&](auto kind) {
    using Number = decltype(kind);
    if constexpr (std::is_floating_point_v<Number>) return true;
    return std::all_of(attribute.values.begin(), attribute.values.end(), [](double x) {
      return x == std::floor(x) && x >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
             x <= static_cast<double>(std::numeric_limits<Number>::max());
    });
  });
}

void require_writable(const std::map<std::string, VertexAttribute>& attributes, std::size_t count,
                      const char* of_what) {
  for (const auto& [name, attribute] : attributes) {
    if (attribute.values.size() != count)
      throw InputError(
          fmt::format("the attribute '{}' has {} values for {} {}", name, attribute.values.size(), count, of_what));
    if (!holds_exactly(attribute))
      throw InputError(fmt::format("the attribute '{}' has values that its type of number cannot hold", name));
    const bool is_coordinate = name == "x" || name == "y" || name == "z" || name == "vertex_indices";
    if (name.empty() || is_coordinate || name.find_first_of(" \t\r\n") != std::string::npos)
      throw InputError(fmt::format("'{}' is no name for an attribute", name));
  }
}

}  // namespace

bool coordinates_fit_float(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Point& p) { return is_float(p.x()) && is_float(p.y()) && is_float(p.z()); });
}

double round_to_float(TriangleMesh& mesh) {
  double farthest = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Point& p = mesh.vertices[v];
    const Point rounded = nearest_float(p);
    if (!rounded.allFinite())
      throw InputError("a coordinate is larger than single precision can hold", {static_cast<std::int64_t>(v)},
                       ElementKind::vertices);
    farthest = std::max(farthest, (rounded - p).norm());
    p = rounded;
  }
  return farthest;
}

void require_writable(const MeshFile& file) {
  if (file.mesh.triangles.empty()) throw InputError("a mesh without triangles is not written");
  require_valid_indices(file.mesh);
  require_finite(file.mesh.vertices);
  require_writable(file.vertex_attributes, file.mesh.vertices.size(), "vertices");
  require_writable(file.triangle_attributes, file.mesh.triangles.size(), "triangles");
  for (const std::string& comment : file.comments)
    if (comment.find_first_of("\r\n") != std::string::npos) throw InputError("a comment in a file is one line");
}

void require_mesh_ending(const std::filesystem::path& path) { writer_for(path); }

bool holds_floats_only(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".stl" || extension == ".glb";
}

std::string mesh_file_bytes(const std::filesystem::path& path, const MeshFile& file) {
  const Writer writer = writer_for(path);
  require_writable(file);
  return writer(file);
}

void save_mesh(const std::filesystem::path& path, const MeshFile& file) {
  write_output_files({{path, mesh_file_bytes(path, file)}});
}

}  // namespace rhizodont
