// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colours.hpp"

#include "io/notes.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {

void add_colours(MeshFile& file, const std::vector<std::array<double, 3>>& colours) {
  if (colours.empty()) return;
  if (colours.size() != file.mesh.vertices.size()) {
    file.notes.push_back("Not every vertex has a colour: the colours are left out.");
    return;
  }
  put_colours(file.vertex_attributes, colours);
}

void put_colours(std::map<std::string, VertexAttribute>& attributes,
                 const std::vector<std::array<double, 3>>& colours) {
  const bool unit = std::all_of(colours.begin(), colours.end(), [](const std::array<double, 3>& c) {
    return std::all_of(c.begin(), c.end(), [](double part) { return part <= 1; });
  });
  for (std::size_t i = 0; i < 3; ++i) {
    VertexAttribute& attribute = attributes[std::array{"red", "green", "blue"}[i]];
    attribute = {AttributeType::uint8, {}};
    attribute.values.reserve(colours.size());
    for (const std::array<double, 3>& colour : colours) {
      const double part = std::isfinite(colour[i]) ? colour[i] : 0;
      attribute.values.push_back(std::clamp(std::round(unit ? 255 * part : part), 0.0, 255.0));
    }
  }
}

void put_face_colours(MeshFile& file, const FaceList& faces, const std::vector<std::array<double, 3>>& colours) {
  std::map<std::string, VertexAttribute> of_faces;
  put_colours(of_faces, colours);
  for (auto& [name, attribute] : of_faces)
    file.triangle_attributes[name] = {attribute.type, faces.of_triangles(attribute.values)};
  file.notes.emplace_back(triangle_colours_kept_note);
}

std::vector<std::array<double, 3>> colours_of(const std::vector<double>& values, std::size_t components) {
  std::vector<std::array<double, 3>> colours;
  for (std::size_t k = 0; k + components <= values.size(); k += components)
    colours.push_back({values[k], values[k + 1], values[k + 2]});
  return colours;
}

}  // namespace rhizodont
