// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rhizodont {

/// The mesh with about `vertices` vertices, same topology; unchanged if it has no more.
TriangleMesh simplified(const TriangleMesh& mesh, std::size_t vertices);

/// Per vertex 1 enamel, 0 cementum, from the file's labels; where none is 1, estimated as the upper `crown_share`
/// (0..1) of the length, the wider end being up.
std::vector<std::uint8_t> crown_labels(const TriangleMesh& mesh, const std::vector<double>& label, double crown_share);

/// Unit axis from root to crown: area vectors of the enamel.
Eigen::Vector3d template_axis(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown);

/// Brings a closed template tooth to its own frame (see FamilyTemplate), simplifies it and finds junction and roots.
/// @param buccal  any vector towards the cheek, in the file's frame
/// Throws InputError if the mesh is turned inside out or has no border of enamel.
FamilyTemplate analyse_template(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown,
                                const Eigen::Vector3d& buccal, std::size_t vertices);

}  // namespace rhizodont
