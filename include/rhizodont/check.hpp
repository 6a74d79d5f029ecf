// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/quality.hpp"
#include "rhizodont/repair_step.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

struct CheckOptions {
  /// Compare coordinates after rounding both to float: right where the tooth was stored as float, too lenient
  /// otherwise. Unset: as float if every coordinate of the tooth is a float, else exactly.
  std::optional<bool> compare_as_float;
  /// Least share of the crown's triangles (of those demanded) that must be found again, [0, 1]; at least one triangle
  /// is always demanded. Skirt and a cap over the base may be dropped, but a tooth that keeps less than this is not the
  /// tooth of this crown.
  double least_kept_share = 0.25;
  /// Triangles of the crown that a repair dropped, cut or turned over, as listed in the report: they count as kept in
  /// either orientation and are not demanded. In range.
  std::vector<int> repaired_triangles;
  /// Vertices of the crown that are not the tooth's (cap, skirt), as listed in the report: triangles at them are not
  /// demanded. In range.
  std::vector<int> dropped_vertices;
  /// Vertices of the crown that a repair merged across a seam, each with the one that stands in its place, as listed in
  /// the report: triangles are demanded with that one. In range.
  std::vector<std::array<int, 2>> merged_vertices;
};

/// Options that excuse what these repairs list, no more; else the defaults.
RHIZODONT_EXPORT CheckOptions allowing_for(const std::vector<RepairStep>& repairs);

/// Distances of the crown's vertices (those in use) from the tooth's surface, mm.
struct CrownDeviation {
  double max = 0;
  double mean = 0;
  /// Vertices in [0, 1e-3], (1e-3, 1e-2], (1e-2, 1e-1], (1e-1, inf) mm: the first three are the paper's table 3.
  std::array<std::int64_t, 4> bins{};
};

/// Promise 1: the crown found again in the tooth, bit for bit. Vertices and triangles are known by their coordinates
/// alone.
struct CrownCheck {
  bool compared_as_float = false;
  std::int64_t vertices = 0;                ///< of the crown that a triangle uses
  std::int64_t kept_vertices = 0;           ///< of these, found in the tooth with the same bits (-0 = +0)
  std::vector<int> dropped_vertices;        ///< of these, not found: skirt, cap or repaired defects
  std::int64_t merged_vertices = 0;         ///< of these, another one stands in their place as listed
  double merged_distance_max = 0;           ///< mm, between a merged vertex and the one in its place
  std::int64_t triangles = 0;               ///< of the crown, with three different vertices
  std::int64_t kept_triangles = 0;          ///< of these, in the tooth with the same vertices in the same cyclic order
  std::int64_t repaired_triangles = 0;      ///< of those listed as repaired, not in the tooth as they stood
  double kept_share = 0;                    ///< kept_triangles / triangles
  std::int64_t demanded_triangles = 0;      ///< of the crown, without those at vertices listed as dropped
  std::vector<int> broken_triangles;        ///< of the crown: all three vertices kept, triangle not in the tooth
  std::optional<CrownDeviation> deviation;  ///< nothing if the tooth has no surface

  bool holds = false;
};

/// Promise 2: the tooth is a solid.
struct SolidCheck {
  bool valid = false;         ///< all indices in range, three different corners per triangle, finite coordinates
  std::int64_t vertices = 0;  ///< in use
  std::int64_t triangles = 0;
  std::int64_t unreferenced_vertices = 0;
  std::int64_t border_edges = 0;
  std::int64_t non_manifold_edges = 0;
  std::int64_t misoriented_edges = 0;
  std::int64_t non_manifold_vertices = 0;
  int components = 0;
  int euler_number = 0;
  std::optional<int> genus;                             ///< of a closed manifold
  double volume = 0;                                    ///< mm^3; positive = outward
  std::vector<std::pair<int, int>> self_intersections;  ///< pairs of tooth triangles

  bool holds = false;
};

struct CheckReport {
  CrownCheck crown;
  SolidCheck solid;
  NewTriangleFigures new_triangles;             ///< promise 3, as figures: a tooth that misses it is still a tooth
  std::optional<QualityFigures> all_triangles;  ///< over all of the tooth's
  std::vector<std::string> failures;            ///< one sentence per thing that is not as promised; empty if both hold

  bool holds() const { return crown.holds && solid.holds; }
};

/// Proves promises 1 (the crown is exact) and 2 (the tooth is a solid) for any pair of meshes, however the tooth was
/// made. Crown triangles with a repeated vertex are left out.
/// Throws InputError if the crown has no triangle, an index out of range or a coordinate that is not a number,
/// UsageError for an option out of range; a bad tooth is a failed check, not an error.
RHIZODONT_EXPORT CheckReport check(const TriangleMesh& crown, const TriangleMesh& tooth,
                                   const CheckOptions& options = {});

}  // namespace rhizodont
