// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "poisson/spline_grid.hpp"
#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Adds to `load`, for each function B_i of the grid inside the box, int grad B_i . V. V is minus the samples' normals,
/// each spread over its share of the surface and smeared by a spline of the grid, or of a coarser one where the
/// samples are so sparse that there would be fewer than `samples_per_cell`.
/// Preconditions: unit normals, samples inside the box, the number of cells a multiple of 8 along each axis.
void add_normal_load(const SplineGrid& grid, const OrientedPoints& samples, std::span<const double> shares,
                     double samples_per_cell, std::vector<double>& load);

/// The width (mm) over which the normal of a sample with this share of the surface is smeared.
double smearing_width(const SplineGrid& grid, double share, double samples_per_cell);

}  // namespace rhizodont
