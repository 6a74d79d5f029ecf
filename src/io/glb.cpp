// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// glTF 2.0 in its binary form, for viewers: one mesh, coloured by where each vertex comes from.
#include "io/append_bytes.hpp"
#include "io/formats.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <bit>
#include <cstdint>

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
  explicit GlbWriter(const MeshFile& file) : file_(file), mesh_(file.mesh) {}

  std::string write() {
    Json attributes;
    attributes["POSITION"] = add_positions();
    attributes["NORMAL"] = add_normals();
    if (file_.vertex_attributes.contains(source_attribute)) add_sources(attributes);
    const int indices = add_indices();
    // glTF counts in metres; the scale of the node leaves the coordinates themselves as they are.
    json_["asset"] = {{"version", "2.0"}, {"generator", "Rhizodont"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"nodes", {0}}}});
    json_["nodes"] = Json::array({{{"mesh", 0}, {"name", "tooth"}, {"scale", {0.001, 0.001, 0.001}}}});
    json_["materials"] = Json::array(
        {{{"name", "tooth"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}}});
    json_["meshes"] = Json::array(
        {{{"primitives",
           Json::array({{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", 4}}})}}});
    json_["accessors"] = accessors_;
    json_["bufferViews"] = views_;
    json_["buffers"] = Json::array({{{"byteLength", data_.size()}}});
    return assemble();
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

  int add_positions() {
    const std::size_t start = data_.size();
    for (const Point& p : mesh_.vertices)
      for (int i = 0; i < 3; ++i) append_bytes(data_, static_cast<float>(p[i]));
    const Eigen::AlignedBox3d box = bounding_box(mesh_.vertices);
    const auto corner = [](const Point& p) { return Json{p.x(), p.y(), p.z()}; };
    return add_accessor(start, target_vertices, type_float, mesh_.vertices.size(), "VEC3",
                        {{"min", corner(box.min())}, {"max", corner(box.max())}});
  }

  int add_normals() {
    const std::size_t start = data_.size();
    for (const Eigen::Vector3d& n : vertex_normals(mesh_)) {
      const Eigen::Vector3f unit = (n.isZero() ? Eigen::Vector3d::UnitZ().eval() : n).cast<float>();
      for (int i = 0; i < 3; ++i) append_bytes(data_, unit[i]);
    }
    return add_accessor(start, target_vertices, type_float, mesh_.vertices.size(), "VEC3");
  }

  void add_sources(Json& attributes) {
    const std::vector<double>& sources = file_.vertex_attributes.at(source_attribute).values;
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

  int add_indices() {
    const std::size_t start = data_.size();
    for (const Triangle& triangle : mesh_.triangles)
      for (const std::int32_t v : triangle) append_bytes(data_, static_cast<std::uint32_t>(v));
    return add_accessor(start, target_indices, type_uint32, 3 * mesh_.triangles.size(), "SCALAR");
  }

  std::string assemble() const {
    std::string text = json_.dump();
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

  const MeshFile& file_;
  const TriangleMesh& mesh_;
  std::string data_;
  Json json_, accessors_ = Json::array(), views_ = Json::array();
};

}  // namespace

std::string write_glb(const MeshFile& file) {
  if (!coordinates_fit_float(file.mesh))
    throw UsageError(
        "GLB files hold single precision only, and this mesh has coordinates that need double; use PLY or OBJ");
  return GlbWriter(file).write();
}

}  // namespace rhizodont
