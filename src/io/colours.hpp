// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/face_list.hpp"
#include "rhizodont/io.hpp"

#include <array>
#include <vector>

namespace rhizodont {

/// Gives the vertices the attributes red, green and blue (uint8) if every vertex has a colour. Colours are 0 to 1 if
/// none is larger, else 0 to 255; what lies outside is cut off. Colours of some vertices alone are noted and left.
void add_colours(MeshFile& file, const std::vector<std::array<double, 3>>& colours);

/// Colours, one per vertex or per triangle, as the attributes red, green and blue, as above.
void put_colours(std::map<std::string, VertexAttribute>& attributes, const std::vector<std::array<double, 3>>& colours);

/// Colours of faces as those of their triangles, with a note. Precondition: as many as `faces.face_count()`.
void put_face_colours(MeshFile& file, const FaceList& faces, const std::vector<std::array<double, 3>>& colours);

/// The first three of so many components per vertex (3 or more).
std::vector<std::array<double, 3>> colours_of(const std::vector<double>& values, std::size_t components);

}  // namespace rhizodont
