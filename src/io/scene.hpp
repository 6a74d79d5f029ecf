// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <string>
#include <vector>

namespace rhizodont {

/// A mesh of a scene, with a name and a colour (linear RGB, 0..1).
struct SceneNode {
  std::string name;
  const TriangleMesh* mesh = nullptr;  ///< not null, not empty
  std::array<float, 3> colour{};
};

/// A glTF 2.0 scene in its binary form (.glb), a named node for each mesh. To look at: coordinates are rounded to
/// float.
std::string scene_bytes(const std::vector<SceneNode>& nodes, double millimetres_per_unit = 1);

}  // namespace rhizodont
