// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/colours.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {

void add_colours(MeshFile& file, const std::vector<std::array<double, 3>>& colours) {
  if (colours.empty()) return;
  if (colours.size() != file.mesh.vertices.size()) {
    file.notes.push_back("Not every vertex has a colour: the colours are left out.");
    return;
  }
  const bool unit = std::all_of(colours.begin(), colours.end(), [](const std::array<double, 3>& c) {
    return std::all_of(c.begin(), c.end(), [](double part) { return part <= 1; });
  });
  for (std::size_t i = 0; i < 3; ++i) {
    VertexAttribute& attribute = file.vertex_attributes[std::array{"red", "green", "blue"}[i]];
    attribute.type = AttributeType::uint8;
    for (const std::array<double, 3>& colour : colours) {
      const double part = std::isfinite(colour[i]) ? colour[i] : 0;
      attribute.values.push_back(std::clamp(std::round(unit ? 255 * part : part), 0.0, 255.0));
    }
  }
}

std::vector<std::array<double, 3>> colours_of(const std::vector<double>& values, std::size_t components) {
  std::vector<std::array<double, 3>> colours;
  for (std::size_t k = 0; k + components <= values.size(); k += components)
    colours.push_back({values[k], values[k + 1], values[k + 2]});
  return colours;
}

}  // namespace rhizodont
