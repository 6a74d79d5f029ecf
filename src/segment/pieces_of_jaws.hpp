// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "rhizodont/segment.hpp"

#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// A sentence where a scan is of several pieces that each may be a jaw (two jaws in one file, as a rule): in which of
/// them the teeth were found, and where it lies. Nothing where there is one such piece.
/// @param scan  in millimetres
/// @param fdi  per vertex, 0 for what is no tooth; one at least is one
/// @param millimetres_per_unit  of the file that the sentence speaks of
std::optional<std::string> which_jaw_was_read(const TriangleMesh& scan, const std::vector<int>& fdi,
                                              double millimetres_per_unit);

}  // namespace rhizodont
