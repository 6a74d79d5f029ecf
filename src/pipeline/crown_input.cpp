// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/crown_input.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
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
double extent(const TriangleMesh& mesh) { return bounding_box(mesh.vertices).sizes().maxCoeff(); }

constexpr double smallest_tooth = 2;  // mm
constexpr double largest_tooth = 20;

struct Unit {
  const char* name;
  const char* option;
  double millimetres;
};
constexpr std::array<Unit, 3> other_units{{{"centimetres", "cm", 10}, {"inches", "in", 25.4}, {"metres", "m", 1000}}};

}  // namespace

void require_usable_crown(const TriangleMesh& crown) {
  if (crown.triangles.empty()) throw InputError("The crown has no triangles.");
  const Diagnosis d = diagnose(crown);
  if (!d.non_finite_vertices.empty())
    throw InputError("The crown has vertices whose coordinates are not numbers.", widened(d.non_finite_vertices));
  if (!d.out_of_range_triangles.empty())
    throw InputError("The crown has triangles that name vertices which do not exist.",
                     widened(d.out_of_range_triangles));
  if (!d.repeated_index_triangles.empty())
    throw InputError("The crown has triangles that name one vertex twice.", widened(d.repeated_index_triangles));
  if (!d.non_manifold_edges.empty())
    throw InputError("The crown has edges where more than two triangles meet (pairs of vertices).",
                     flat_ids(d.non_manifold_edges));
  if (!d.misoriented_edges.empty())
    throw InputError("Some triangles of the crown are flipped against their neighbours (edges as pairs of vertices).",
                     flat_ids(d.misoriented_edges));
  if (const int pieces = connected_components(crown).count; pieces > 1)
    throw InputError(fmt::format("The mesh consists of {} separate pieces: give one crown.", pieces));
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
  // The cone over the crown from its border's centre: positive where the triangles face outward.
  Point centre = Point::Zero();
  std::size_t count = 0;
  for (const auto& loop : border_loops(open_crown))
    for (const int v : loop) {
      centre += open_crown.vertices[static_cast<std::size_t>(v)];
      ++count;
    }
  if (count > 0) centre /= static_cast<double>(count);
  double cone = 0;
  for (std::size_t t = 0; t < open_crown.triangles.size(); ++t) {
    const Point& p = open_crown.vertices[static_cast<std::size_t>(open_crown.triangles[t][0])];
    cone += triangle_area_vector(open_crown, t).dot(p - centre);
  }
  if (cone <= 0) throw InputError("The crown's triangles face inwards: turn them over.");
  const auto cuts = self_intersecting_triangles(open_crown);
  if (cuts.empty()) return;
  std::vector<std::int64_t> ids;
  for (const auto& [a, b] : cuts) ids.insert(ids.end(), {a, b});
  throw InputError("The crown's surface cuts itself (pairs of triangles).", ids);
}

}  // namespace rhizodont
