// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// A finished tooth with its new vertices in other places, checked anew as a finished one is: root length, promises and
/// missed places are those of the new one; its interval goes with the length. Where all coordinates were floats they
/// are again.
/// @param crown     the input that it was made of
/// @param vertices  mm, as many as the tooth's; those of the kept crown are not looked at
/// Throws NoResultError where the promises would not be kept, UsageError for another number of vertices.
CompletedTooth moved_tooth(const TriangleMesh& crown, CompletedTooth tooth, const std::vector<Point>& vertices);

}  // namespace rhizodont
