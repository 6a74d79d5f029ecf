// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/crown_input.hpp"

#include "intake/units.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/handles.hpp"
#include "mesh/pieces.hpp"
#include "mesh/principal_axis.hpp"
#include "mesh/seams.hpp"
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

/// Whether most triangles stand once each way over the same vertices: a surface with an inner side of its own.
bool is_double_sided(const TriangleMesh& mesh, const Diagnosis& found) {
  const EdgeTable table = edge_table(mesh);
  std::size_t both_ways = 0;  // edges that triangles run through in both directions more than once
  for (std::size_t e = 0; e < table.size(); ++e) both_ways += table.triangle_count(e) >= 4;
  return 2 * both_ways > table.size() && 5 * found.duplicate_triangles.size() > 2 * mesh.triangles.size();
}

/// Says what keeps a mesh of several pieces from being one crown.
void require_one_piece(const TriangleMesh& crown) {
  const Pieces pieces = sort_pieces(crown);
  if (pieces.kinds.size() <= 1) return;
  const Seams seams = find_seams(crown);
  if (seams.merged > 0) {
    TriangleMesh merged = crown;
    for (Triangle& t : merged.triangles)
      for (std::int32_t& v : t) v = seams.target[static_cast<std::size_t>(v)];
    if (sort_pieces(merged).count(PieceKind::like) == 0)
      throw InputError(
          fmt::format("The crown falls into {} pieces along seams whose sides do not meet: the farthest are {} apart.",
                      pieces.kinds.size(), seam_width_in_words(seams.largest_mm)));
  }
  throw InputError(describe_pieces(crown, pieces));
}

/// Largest extent of the box, in whatever unit the mesh has.
double extent(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;  // of what triangles use
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  return box.sizes().maxCoeff();
}

/// Extent along the direction in which the mesh is longest, however it is turned.
double length(const TriangleMesh& mesh) {
  std::vector<Point> points;
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  const auto [low, high] = extent_along(points, principal_axis(points));
  return high - low;
}

constexpr const char* inside_out = "The crown is inside out: its triangles face inwards and have to be turned over.";

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
        ids, ElementKind::vertices);
}

constexpr double smallest_tooth = 2;  // mm
constexpr double largest_tooth = 20;
constexpr double longest_crown = 15;  // mm: molars are up to 13 across, canines 11 high
constexpr double longest_whole_tooth = 45;

}  // namespace

Diagnosis require_readable_crown(const TriangleMesh& crown) {
  if (crown.triangles.empty()) throw InputError("The crown has no triangles.");
  Diagnosis d = diagnose(crown);
  if (!d.non_finite_vertices.empty())
    throw InputError("The crown has vertices whose coordinates are not numbers.", widened(d.non_finite_vertices),
                     ElementKind::vertices);
  if (!d.out_of_range_triangles.empty())
    throw InputError("The crown has triangles that name vertices which do not exist.",
                     widened(d.out_of_range_triangles), ElementKind::triangles);
  if (!d.repeated_index_triangles.empty())
    throw InputError("The crown has triangles that name one vertex twice.", widened(d.repeated_index_triangles),
                     ElementKind::triangles);
  if (is_double_sided(crown, d))
    throw InputError("The mesh is double-sided: its triangles are there twice, once facing outwards and once inwards.");
  return d;
}

Diagnosis require_usable_crown(const TriangleMesh& crown) {
  Diagnosis d = require_readable_crown(crown);
  if (!d.non_manifold_edges.empty())
    throw InputError("The crown has edges where more than two triangles meet (pairs of vertices).",
                     flat_ids(d.non_manifold_edges), ElementKind::vertex_pairs);
  if (!d.misoriented_edges.empty())
    throw InputError("Some triangles of the crown are flipped against their neighbours (edges as pairs of vertices).",
                     flat_ids(d.misoriented_edges), ElementKind::vertex_pairs);
  require_one_piece(crown);
  if (d.border_edges.empty() && d.volume < 0) throw InputError(inside_out);
  return d;
}

void require_no_root(const TriangleMesh& closed_crown) {
  const double size = length(closed_crown);
  if (size < longest_crown) return;
  throw InputError(
      fmt::format("The mesh is closed and {:.0f} mm long, a crown is up to {:.0f} mm: this tooth has its root already, "
                  "or a part of it. "
                  "To give it another one, cut it off below the crown and leave the cut open.",
                  size, longest_crown));
}

void require_one_crown(const TriangleMesh& crown) {
  const Pieces pieces = sort_pieces(crown);
  if (pieces.count(PieceKind::like) > 0) throw InputError(describe_pieces(crown, pieces));
}

void require_tooth_size(const TriangleMesh& crown, double millimetres_per_unit, bool closed) {
  const double size = extent(crown);
  if (size >= smallest_tooth && size <= (closed ? longest_whole_tooth : largest_tooth)) return;
  const double raw = size / millimetres_per_unit;
  std::string hint;
  for (const Unit& unit : known_units())
    if (raw * unit.millimetres >= smallest_tooth && raw * unit.millimetres <= largest_tooth)
      hint += fmt::format("{} {} (--unit {})", hint.empty() ? " Is it in" : " or", unit.name, unit.option);
  if (!hint.empty()) hint += "?";
  throw InputError(fmt::format("The crown is {:.4g} mm across; teeth are {:.0f} to {:.0f} mm.{}", size, smallest_tooth,
                               largest_tooth, hint));
}

void require_outward_and_uncut(const TriangleMesh& open_crown) {
  if (cone_volume(open_crown) <= 0) throw InputError(inside_out);
  if (const int handles = handle_count(open_crown); handles > 0)
    throw InputError(fmt::format("The crown has {} handles, bridges over gaps or tunnels: a tooth has none.", handles));
  require_one_opening(open_crown);
  const auto cuts = self_intersecting_triangles(open_crown);
  if (cuts.empty()) return;
  std::vector<std::int64_t> ids;
  for (const auto& [a, b] : cuts) ids.insert(ids.end(), {a, b});
  constexpr std::size_t many = 50;
  throw InputError(cuts.size() < many
                       ? "The crown's surface cuts itself (pairs of triangles)."
                       : "The crown's surface cuts itself in many places, as noisy scans do: smooth it a "
                         "little, or scan again (pairs of triangles).",
                   ids, ElementKind::triangle_pairs);
}

}  // namespace rhizodont
