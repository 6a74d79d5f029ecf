// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/synthetic_files.hpp"

#include "base/float_bits.hpp"
#include "families/scanner_mesh.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

TriangleMesh on_other_side(TriangleMesh mesh) {
  for (Point& p : mesh.vertices) p.x() = -p.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

namespace {

std::vector<std::string> comments_on(const SyntheticTooth& tooth) {
  return {"synthetic tooth, made by rhizodont synth",
          "derived from Permanent Teeth, University of Dundee School of Dentistry "
          "(E. McDougall, A. Mason, M. Roughley), CC BY 4.0",
          fmt::format("root length {:.2f} mm, crown height {:.2f} mm", tooth.root_length, tooth.crown_height)};
}

}  // namespace

MeshFile synthetic_tooth_file(const SyntheticTooth& tooth, const GumLine& line, bool right_side) {
  MeshFile file;
  file.mesh = right_side ? on_other_side(tooth.mesh) : tooth.mesh;
  for (Point& p : file.mesh.vertices) p = nearest_float(p);
  VertexAttribute source{AttributeType::uint8, {}}, enamel{AttributeType::uint8, {}};
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v) {
    const Point& p = tooth.mesh.vertices[v];
    const bool seen = p.z() > line.height(tooth.junction, p.x(), p.y());
    source.values.push_back(static_cast<double>(seen ? VertexSource::scan : VertexSource::predicted));
    enamel.values.push_back(tooth.crown[v]);
  }
  file.vertex_attributes[source_attribute] = std::move(source);
  file.vertex_attributes["crown"] = std::move(enamel);
  file.comments = comments_on(tooth);
  return file;
}

MeshFile synthetic_crown_file(const SyntheticTooth& tooth, const CroppedCrown& crown, bool right_side,
                              const ScannedAs& look) {
  MeshFile file;
  file.mesh = right_side ? on_other_side(crown.mesh) : crown.mesh;
  if (look.edge_mm > 0) file.mesh = scanner_mesh(file.mesh, look.edge_mm, look.noise_mm, look.seed);
  for (Point& p : file.mesh.vertices) p = nearest_float(p);
  file.comments = comments_on(tooth);
  return file;
}

}  // namespace rhizodont
