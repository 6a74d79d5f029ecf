// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// How far teeth are apart, and how deep they run into each other.
#pragma once

#include "arch/solid_surface.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace rhizodont {

/// Where parts of two solids come nearest, or lie deepest in each other.
struct Approach {
  double mm = 0;                                  ///< signed: the distance of the two points; negative in each other
  Point on_first, on_second;                      ///< on the surface of either
  int first_triangle = -1, second_triangle = -1;  ///< that hold them
};

/// The signed clearances of each part of `first` to each part of `second`: that of parts i and j is number
/// i * second.part_count() + j.
///
/// Of parts that are apart it is the smallest distance of any two points of their triangles, exact to rounding. Solids
/// that meet run into each other: then a clearance is minus a depth, the largest distance to the surface of one solid
/// over those points of the other that lie in it. Points are the vertices and the middles of those stretches of edges
/// that are inside, so that edges thrust through a face count, too. A depth belongs to the parts that the point and the
/// surface nearest to it belong to; parts of solids that meet without a depth of their own have their distance, or 0
/// where they touch. A solid in the other counts as one that runs into it, wholly. For balls it is the distance of
/// their middles less both radii, unless the smaller one holds the larger one's middle; for a box pushed into a face of
/// a wider one, minus the way it was pushed.
///
/// Nothing for an empty part, and where parts are not nearer than `within` (mm).
std::vector<std::optional<Approach>> part_clearances(const SolidSurface& first, const SolidSurface& second,
                                                     double within = std::numeric_limits<double>::infinity());

/// Parts of a tooth's surface as the functions below expect them.
inline constexpr int crown_part = 0, root_part = 1;

/// A whole tooth in two parts: a triangle belongs to the crown if all its vertices come from the scan, to the root
/// otherwise. `tooth` in mm, `source` per vertex. Throws as SolidSurface, and UsageError for another number of sources.
SolidSurface tooth_surface(TriangleMesh tooth, const std::vector<VertexSource>& source);

/// The clearances of two teeth, by parts. Nothing where a tooth has no such part or they are farther apart than asked.
struct Clearance {
  std::optional<Approach> crown_crown, root_root;
  std::optional<Approach> root_crown;  ///< the first tooth's root to the second's crown
  std::optional<Approach> crown_root;  ///< the first tooth's crown to the second's root

  /// The smallest of all.
  std::optional<Approach> whole() const;
  /// The smaller of `root_crown` and `crown_root`.
  std::optional<Approach> root_to_crown() const;
  /// The smallest in which a root has a part.
  std::optional<Approach> of_roots() const;
};

/// Both made by `tooth_surface`. @param within  as in `part_clearances`
Clearance clearance_of(const SolidSurface& first, const SolidSurface& second,
                       double within = std::numeric_limits<double>::infinity());

using ToothPair = std::pair<std::size_t, std::size_t>;  ///< numbers of teeth, lower first

struct NeighbourOptions {
  double within = 10;  ///< mm, > 0: teeth that come no nearer are no neighbours
};

struct NeighbourClearance {
  std::size_t first, second;  ///< numbers of the teeth, first < second
  Clearance clearance;        ///< each part's in full, also beyond `within`
};

/// The clearances of all pairs of teeth that come nearer than `within`, ordered by their numbers: whatever is missing
/// between them, and however they stand. Teeth made by `tooth_surface`; null where a tooth has none.
std::vector<NeighbourClearance> neighbour_clearances(const std::vector<const SolidSurface*>& teeth,
                                                     const NeighbourOptions& options = {});

/// Name of the attribute of `vertex_clearances` (double, mm).
inline constexpr const char* clearance_attribute = "clearance";

/// Per tooth and vertex the signed distance (mm) from the nearest of the other teeth: negative inside of one, and
/// `within` where none is nearer. Empty for a tooth that is null.
/// @param within  mm, > 0; the farther, the longer it takes
std::vector<std::vector<double>> vertex_clearances(const std::vector<const SolidSurface*>& teeth, double within = 3);

}  // namespace rhizodont
