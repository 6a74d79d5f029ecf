// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "rhizodont/mesh.hpp"

#include <string>
#include <vector>

namespace rhizodont {

/// What people give for a crown and is none, or little of one.
enum class UnlikeKind {
  stump,         ///< a crown ground down for a restoration: chamfer, taper, height taken off
  turned_stump,  ///< the same as a cone on a shoulder, as drawn in a program
  scan_body,     ///< a post on an implant: cylinder, bevelled top, often a flat side
  half,          ///< cut through the middle, along the axis or nearly so
  side_missing,  ///< a quarter to nearly half of it, likewise
  dome,          ///< half an ellipsoid, or a rounded box
  hollow,        ///< the inside of a thin restoration: shrunk, without the form of its top
  joined,        ///< two crowns side by side in one piece
};
inline constexpr int unlike_kind_count = 8;

/// Its name for tables.
std::string name_of(UnlikeKind kind);

/// An open mesh of that kind, facing outward, made of a crown or instead of it.
/// @param crown  open at its base, one piece, +z from root to crown, mm
/// @param random what makes each one different
TriangleMesh unlike_crown(const TriangleMesh& crown, UnlikeKind kind, RandomStream& random);

}  // namespace rhizodont
