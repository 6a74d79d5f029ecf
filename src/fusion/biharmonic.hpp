// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace rhizodont {

/// Positions of the free vertices (mm, one a row) that solve the biharmonic equation L M^-1 L x = 0 with all other
/// vertices fixed; empty if the system cannot be solved. `free_vertices`: different, in range, at least one.
Eigen::MatrixXd biharmonic_positions(const TriangleMesh& mesh, const std::vector<int>& free_vertices);

/// Displacements of the free vertices (mm, one a row) that come near to the wishes and else are as smooth as may be:
/// all others stay, and integral |L u|^2 + `weight` * integral over those with a wish |u - wish|^2 is least. Empty if
/// the system cannot be solved.
/// @param wishes  per free vertex, mm
/// @param weight  mm^-4, > 0: a wish weighs as much as curvature over a length of weight^(-1/4)
Eigen::MatrixXd smoothest_displacements(const TriangleMesh& mesh, const std::vector<int>& free_vertices,
                                        const std::vector<std::optional<Eigen::Vector3d>>& wishes, double weight);

}  // namespace rhizodont
