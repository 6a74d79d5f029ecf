// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

struct CheckOptions {
  /// Compare coordinates after rounding both to float. Right where the tooth was stored as float, wrong otherwise;
  /// unset: exactly if the tooth has a coordinate that is no float, else as float.
  std::optional<bool> compare_as_float;
  /// Least share of the crown's triangles that must be found again, (0, 1]. The design allows skirt to be dropped; a
  /// tooth that keeps less than this is not the tooth of this crown.
  double least_kept_share = 0.5;
};

/// Promise 1: the crown found again in the tooth, bit for bit.
struct CrownCheck {
  std::int64_t vertices = 0;            ///< of the crown that a triangle uses
  std::int64_t kept_vertices = 0;       ///< found in the tooth with the same bits (-0 = +0)
  std::vector<int> dropped_vertices;    ///< of the crown, not found: must be skirt or repaired defects
  std::int64_t triangles = 0;           ///< of the crown
  std::int64_t kept_triangles = 0;      ///< found in the tooth with the same vertices in the same cyclic order
  double kept_share = 0;                ///< kept_triangles / triangles
  std::vector<int> broken_triangles;    ///< of the crown: all three vertices kept, triangle not in the tooth
  std::vector<int> ambiguous_vertices;  ///< of the crown: several vertices of the crown or of the tooth have these bits

  double deviation_max = 0;  ///< of crown vertices in use from the tooth's surface, mm
  double deviation_mean = 0;
  /// Vertices with a deviation in [0, 1e-3], (1e-3, 1e-2], (1e-2, 1e-1], (1e-1, inf) mm: the paper's table 3.
  std::array<std::int64_t, 4> deviation_bins{};

  bool holds = false;
};

/// Promise 2: the tooth is a solid.
struct SolidCheck {
  bool valid = false;  ///< indices in range, three different corners, finite coordinates
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t unreferenced_vertices = 0;
  std::int64_t border_edges = 0;
  std::int64_t non_manifold_edges = 0;
  std::int64_t misoriented_edges = 0;
  std::int64_t non_manifold_vertices = 0;
  int components = 0;
  int euler_number = 0;
  double volume = 0;                                    ///< mm^3; positive = outward
  std::vector<std::pair<int, int>> self_intersections;  ///< pairs of tooth triangles
  std::vector<std::string> defects;                     ///< one sentence each

  bool holds = false;
};

struct CheckReport {
  CrownCheck crown;
  SolidCheck solid;
  std::vector<std::string> failures;  ///< one sentence per thing that is not as promised; empty if both hold
  bool holds() const { return crown.holds && solid.holds; }
};

/// Proves promises 1 (the crown is exact) and 2 (the tooth is a solid) for any pair of meshes, however the tooth was
/// made. Triangles of the crown with a repeated vertex are left out of the count.
/// Throws InputError if the crown has no triangle, an index out of range or a coordinate that is not a number; a bad
/// tooth is a failed check, not an error.
CheckReport check(const TriangleMesh& crown, const TriangleMesh& tooth, const CheckOptions& options = {});

}  // namespace rhizodont
