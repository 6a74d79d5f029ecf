// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstdint>

namespace rhizodont {

/// Puts a mesh behind another one: its vertices and triangles follow in their order, joined to nothing.
inline void append_mesh(TriangleMesh& all, const TriangleMesh& part) {
  const auto before = static_cast<std::int32_t>(all.vertices.size());
  all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (Triangle t : part.triangles) {
    for (std::int32_t& v : t) v += before;
    all.triangles.push_back(t);
  }
}

}  // namespace rhizodont
