// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pictures/render.hpp"

#include <vector>

namespace rhizodont {

/// Colours of triangles by the FDI number, 0 for gum, of most of their corners (`triangle_labels_from_vertices`).
/// Throws InputError for another number of values than vertices and for values that are no numbers of teeth.
std::vector<Colour> colours_by_tooth(const TriangleMesh& mesh, const std::vector<double>& fdi);

/// The colour of a tooth in an arch, another one than its neighbours'; of gum for 0 and less.
Colour colour_of_tooth(int fdi);

}  // namespace rhizodont
