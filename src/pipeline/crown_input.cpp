// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/crown_input.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/handles.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <array>

namespace rhizodont {
namespace {

std::vector<std::int64_t> flat_ids(const std::vector<std::array<int, 2>>& edges) {
  std::vector<std::int64_t> ids;
  for (const auto& [a, b] : edges) ids.insert(ids.end(), {a, b});
  return ids;
}

std::vector<std::int64_t> widened(const std::vector<int>& ids) { return {ids.begin(), ids.end()}; }

/// Largest extent of the box, in whatever unit the mesh has.
double extent(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;  // of what triangles use
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  return box.sizes().maxCoeff();
}

/// Refuses what is open towards the root in more than one place: one root alone would be joined to one of them.
void require_one_opening(const TriangleMesh& open_crown) {
  constexpr double least_share = 0.2;  // of the base's cross-section; holes that the scanner left are smaller
  const std::vector<BorderPiece> pieces = border_pieces(open_crown);
  if (pieces.empty()) return;
  const BorderPiece& base = pieces[base_piece(pieces)];
  const Eigen::Vector3d axis = base.area_vector.normalized();
  int openings = 0;
  std::vector<std::int64_t> ids;
  for (const BorderPiece& piece : pieces) {
    if (piece.area_vector.dot(axis) < least_share * base.area_vector.norm()) continue;
    ++openings;
    ids.insert(ids.end(), piece.vertices.begin(), piece.vertices.end());
  }
  if (openings > 1)
    throw InputError(
        fmt::format("The crown is open towards its root in {} places: it was cut below the furcation, or a "
                    "strip of the scan spans its base. Cut it at the neck (ids of vertices).",
                    openings),
        ids);
}

constexpr double smallest_tooth = 2;  // mm
constexpr double largest_tooth = 20;

struct Unit {
  const char* name;
  const char* option;
  double millimetres;
};
constexpr std::array<Unit, 3> other_units{{{"centimetres", "cm", 10}, {"inches", "in", 25.4}, {"metres", "m", 1000}}};

}  // namespace

Diagnosis require_readable_crown(const TriangleMesh& crown) {
  if (crown.triangles.empty()) throw InputError("The crown has no triangles.");
  Diagnosis d = diagnose(crown);
  if (!d.non_finite_vertices.empty())
    throw InputError("The crown has vertices whose coordinates are not numbers.", widened(d.non_finite_vertices));
  if (!d.out_of_range_triangles.empty())
    throw InputError("The crown has triangles that name vertices which do not exist.",
                     widened(d.out_of_range_triangles));
  if (!d.repeated_index_triangles.empty())
    throw InputError("The crown has triangles that name one vertex twice.", widened(d.repeated_index_triangles));
  return d;
}

Diagnosis require_usable_crown(const TriangleMesh& crown) {
  Diagnosis d = require_readable_crown(crown);
  if (!d.non_manifold_edges.empty())
    throw InputError("The crown has edges where more than two triangles meet (pairs of vertices).",
                     flat_ids(d.non_manifold_edges));
  if (!d.misoriented_edges.empty())
    throw InputError("Some triangles of the crown are flipped against their neighbours (edges as pairs of vertices).",
                     flat_ids(d.misoriented_edges));
  if (const int pieces = connected_components(crown).count; pieces > 1)
    throw InputError(fmt::format("The mesh consists of {} separate pieces: give one crown.", pieces));
  return d;
}

void require_tooth_size(const TriangleMesh& crown, double millimetres_per_unit) {
  const double size = extent(crown);
  if (size >= smallest_tooth && size <= largest_tooth) return;
  const double raw = size / millimetres_per_unit;
  std::string hint;
  for (const Unit& unit : other_units)
    if (raw * unit.millimetres >= smallest_tooth && raw * unit.millimetres <= largest_tooth)
      hint += fmt::format("{} {} (--unit {})", hint.empty() ? " Is it in" : " or", unit.name, unit.option);
  if (!hint.empty()) hint += "?";
  throw InputError(fmt::format("The crown is {:.4g} mm across; teeth are {:.0f} to {:.0f} mm.{}", size, smallest_tooth,
                               largest_tooth, hint));
}

void require_outward_and_uncut(const TriangleMesh& open_crown) {
  if (cone_volume(open_crown) <= 0) throw InputError("The crown's triangles face inwards: turn them over.");
  if (const int handles = handle_count(open_crown); handles > 0)
    throw InputError(fmt::format("The crown has {} handles, bridges over gaps or tunnels: a tooth has none.", handles));
  require_one_opening(open_crown);
  const auto cuts = self_intersecting_triangles(open_crown);
  if (cuts.empty()) return;
  std::vector<std::int64_t> ids;
  for (const auto& [a, b] : cuts) ids.insert(ids.end(), {a, b});
  throw InputError("The crown's surface cuts itself (pairs of triangles).", ids);
}

}  // namespace rhizodont
