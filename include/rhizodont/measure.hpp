// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/quality.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// Figures of one mesh.
struct MeshMeasures {
  QualityFigures quality;  ///< over all triangles

  // Topology.
  std::int64_t vertices = 0;  ///< in use
  std::int64_t edges = 0, triangles = 0;
  std::int64_t unreferenced_vertices = 0, duplicate_vertices = 0, duplicate_triangles = 0, degenerate_triangles = 0;
  std::int64_t border_edges = 0, non_manifold_edges = 0, misoriented_edges = 0, non_manifold_vertices = 0;
  std::int64_t self_intersections = 0;  ///< pairs of triangles
  int components = 0, border_loops = 0, euler_number = 0;
  std::optional<int> genus;          ///< of a closed oriented manifold
  std::vector<std::string> defects;  ///< one sentence each

  // Sizes in mm, mm^2, mm^3.
  bool closed = false;  ///< no border, manifold, consistently oriented
  double volume = 0;    ///< signed; 0 unless closed
  double area = 0;
  std::array<double, 3> lowest{}, highest{};  ///< corners of the bounding box
  double diagonal = 0;
  double edge_min = 0, edge_mean = 0, edge_max = 0;
};

/// Throws InputError for a mesh without triangles, with an index out of range, a repeated index or a coordinate that is
/// not a number.
RHIZODONT_EXPORT MeshMeasures measure(const TriangleMesh& mesh);

}  // namespace rhizodont
