// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// glTF 2.0 in its binary form, for viewers: a mesh coloured by where each vertex comes from, or several, each in a
// colour.
#include "io/append_bytes.hpp"
#include "io/formats.hpp"
#include "io/scene.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

// glTF constants
constexpr int type_uint8 = 5121, type_uint32 = 5125, type_float = 5126;
constexpr int target_vertices = 34962, target_indices = 34963;

// Enamel, the band between, cementum; linear RGBA.
constexpr std::array<std::array<std::uint8_t, 4>, 3> source_colours{
    {{225, 222, 210, 255}, {222, 150, 80, 255}, {190, 160, 110, 255}}};

class GlbWriter {
 public:
  /// A mesh with its attributes; `colour`: of its material, where it has one of its own.
  void add(const std::string& name, const MeshFile& file, const std::optional<std::array<float, 3>>& colour,
           double metres_per_unit) {
    Json attributes;
    attributes["POSITION"] = add_positions(file.mesh);
    attributes["NORMAL"] = add_normals(file.mesh);
    if (!colour && file.vertex_attributes.contains(source_attribute)) add_sources(file, attributes);
    const int indices = add_indices(file.mesh);
    const std::size_t number = nodes_.size();
    // glTF counts in metres; the scale of the node leaves the coordinates themselves as they are.
    nodes_.push_back(
        {{"mesh", number}, {"name", name}, {"scale", {metres_per_unit, metres_per_unit, metres_per_unit}}});
    Json material{{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}};
    if (colour) material["pbrMetallicRoughness"]["baseColorFactor"] = {(*colour)[0], (*colour)[1], (*colour)[2], 1.0F};
    materials_.push_back(std::move(material));
    meshes_.push_back(
        {{"primitives",
          Json::array({{{"attributes", attributes}, {"indices", indices}, {"material", number}, {"mode", 4}}})}});
  }

  std::string bytes() const {
    Json nodes = Json::array();
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes.push_back(i);
    Json json;
    json["asset"] = {{"version", "2.0"}, {"generator", "Rhizodont"}};
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"nodes", nodes}}});
    json["nodes"] = nodes_;
    json["materials"] = materials_;
    json["meshes"] = meshes_;
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
    json["buffers"] = Json::array({{{"byteLength", data_.size()}}});
    return assemble(json);
  }

 private:
  int add_accessor(std::size_t start, int target, int component_type, std::size_t count, const char* type,
                   Json extra = Json::object()) {
    views_.push_back({{"buffer", 0}, {"byteOffset", start}, {"byteLength", data_.size() - start}, {"target", target}});
    if (type == std::string_view("SCALAR") && component_type == type_uint8) views_.back()["byteStride"] = 4;
    Json accessor{
        {"bufferView", views_.size() - 1}, {"componentType", component_type}, {"count", count}, {"type", type}};
    accessor.update(extra);
    accessors_.push_back(accessor);
    return static_cast<int>(accessors_.size()) - 1;
  }

  int add_positions(const TriangleMesh& mesh) {
    const std::size_t start = data_.size();
    for (const Point& p : mesh.vertices)
      for (int i = 0; i < 3; ++i) append_bytes(data_, static_cast<float>(p[i]));
    const Eigen::AlignedBox3d box = bounding_box(mesh.vertices);
    const auto corner = [](const Point& p) {  // as the floats above, to the bit
      const Eigen::Vector3f f = p.cast<float>();
      return Json{static_cast<double>(f.x()), static_cast<double>(f.y()), static_cast<double>(f.z())};
    };
    return add_accessor(start, target_vertices, type_float, mesh.vertices.size(), "VEC3",
                        {{"min", corner(box.min())}, {"max", corner(box.max())}});
  }

  int add_normals(const TriangleMesh& mesh) {
    const std::size_t start = data_.size();
    for (const Eigen::Vector3d& n : vertex_normals(mesh)) {
      const Eigen::Vector3f unit = (n.isZero() ? Eigen::Vector3d::UnitZ().eval() : n).cast<float>();
      for (int i = 0; i < 3; ++i) append_bytes(data_, unit[i]);
    }
    return add_accessor(start, target_vertices, type_float, mesh.vertices.size(), "VEC3");
  }

  void add_sources(const MeshFile& file, Json& attributes) {
    const std::vector<double>& sources = file.vertex_attributes.at(source_attribute).values;
    std::size_t start = data_.size();
    for (const double source : sources)
      for (const std::uint8_t part : source_colours[source >= 0 && source < 3 ? static_cast<std::size_t>(source) : 0])
        append_bytes(data_, part);
    attributes["COLOR_0"] =
        add_accessor(start, target_vertices, type_uint8, sources.size(), "VEC4", {{"normalized", true}});
    start = data_.size();
    for (const double source : sources)
      append_bytes(data_, static_cast<std::uint32_t>(source));  // one byte, padded to four
    attributes["_SOURCE"] = add_accessor(start, target_vertices, type_uint8, sources.size(), "SCALAR");
  }

  int add_indices(const TriangleMesh& mesh) {
    const std::size_t start = data_.size();
    for (const Triangle& triangle : mesh.triangles)
      for (const std::int32_t v : triangle) append_bytes(data_, static_cast<std::uint32_t>(v));
    return add_accessor(start, target_indices, type_uint32, 3 * mesh.triangles.size(), "SCALAR");
  }

  std::string assemble(const Json& json) const {
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    append_bytes(bytes, std::uint32_t{2});
    append_bytes(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + data_.size()));
    append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    append_bytes(bytes, static_cast<std::uint32_t>(data_.size()));
    bytes.append("BIN\0", 4);
    return bytes + data_;
  }

  std::string data_;
  Json nodes_ = Json::array(), materials_ = Json::array(), meshes_ = Json::array(), accessors_ = Json::array(),
       views_ = Json::array();
};

}  // namespace

std::string write_glb(const MeshFile& file) {
  if (!coordinates_fit_float(file.mesh))
    throw UsageError(
        "GLB files hold single precision only, and this mesh has coordinates that need double; use PLY or OBJ");
  GlbWriter writer;
  writer.add("tooth", file, std::nullopt, 0.001);
  return writer.bytes();
}

std::string scene_bytes(const std::vector<SceneNode>& nodes, double millimetres_per_unit) {
  GlbWriter writer;
  for (const SceneNode& node : nodes) {
    MeshFile file;
    file.mesh = *node.mesh;
    writer.add(node.name, file, node.colour, 0.001 * millimetres_per_unit);
  }
  return writer.bytes();
}

}  // namespace rhizodont
