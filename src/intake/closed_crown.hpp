// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "rhizodont/mesh.hpp"
#include "skirt/cap.hpp"

#include <optional>

namespace rhizodont {

/// Recognises the cap of a closed crown whose axis is not known: by the triangles that programs close a base with, or
/// else by its form. Then axes are tried in all directions; the one is taken
/// whose cap looks most like a cap and that leaves a crown most like the mean crown of its type (of any type without
/// an FDI number). Deterministic.
/// Throws InputError where nothing is a cap: a ball, a whole tooth.
Cap recognise_cap(const TriangleMesh& closed_crown, const Atlas& atlas, std::optional<int> fdi);

}  // namespace rhizodont
