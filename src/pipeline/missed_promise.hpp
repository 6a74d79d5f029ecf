// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/quality.hpp"

#include <vector>

namespace rhizodont {

/// Where new triangles miss promise 3, and by how much: nothing where it is kept. `tooth`: in the input's unit and
/// frame, first the crown's vertices, whose numbers in the input are `kept_vertices`, and its `crown_triangles`
/// triangles; `figures` those of its new triangles.
std::vector<MissedPlace> where_promise_three_is_missed(const TriangleMesh& tooth, const std::vector<int>& kept_vertices,
                                                       std::size_t crown_triangles, const NewTriangleFigures& figures);

}  // namespace rhizodont
