// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "poisson/multigrid.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Load of the screened Poisson problem: for each active function B_i of each level int grad B_i . V. V is minus the
/// samples' normals, each spread over its share of the surface and smeared by a spline as wide as the sample's depth
/// says: a depth between two levels means that both have a part in it.
/// \param depths  per sample, from 0 = coarsest level to levels.size() - 1. Preconditions: unit normals; around each
///                sample the level ceil(depth) is built
LevelField normal_load(const std::vector<SplineLevel>& levels, const OrientedPoints& samples,
                       std::span<const double> shares, std::span<const double> depths);

}  // namespace rhizodont
