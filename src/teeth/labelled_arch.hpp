// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "rhizodont/mesh.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

/// Whether labels that count along an arch (0 is gum) run from the patient's right to the left, by the form of the
/// arch in any pose: up is where the teeth's surfaces face (down in an upper jaw), front from the two end teeth to
/// those between, left = up x front. Nothing where fewer than three teeth, or a nearly straight row, do not tell.
/// Precondition: valid indices, finite coordinates, a number per vertex.
std::optional<bool> labels_run_leftward(const TriangleMesh& mesh, const std::vector<int>& labels, Jaw jaw);

}  // namespace rhizodont
