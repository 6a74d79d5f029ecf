// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The proof that a tooth keeps its crown and is a solid. It knows nothing of how the tooth was made: it looks at
// coordinates and triangles alone. Bins of the deviation: table 3 of "Completing Dental Models While Preserving Crown
// Geometry and Meshing Topology".
#include "rhizodont/check.hpp"
#include "base/option_range.hpp"

#include "base/float_bits.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/quality.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace rhizodont {
namespace {

bool all_floats(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Point& p) { return is_float(p.x()) && is_float(p.y()) && is_float(p.z()); });
}

// Numbers places in space: vertices with the same bits, in whichever mesh, have the same number.
class Places {
 public:
  explicit Places(bool as_float) : as_float_(as_float) {}

  int number(const Point& p) { return numbers_.try_emplace(key(p), static_cast<int>(numbers_.size())).first->second; }

  std::vector<int> number_all(const TriangleMesh& mesh) {
    std::vector<int> numbers;
    numbers.reserve(mesh.vertices.size());
    for (const Point& p : mesh.vertices) numbers.push_back(number(p));
    return numbers;
  }

  std::size_t size() const { return numbers_.size(); }

 private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 0;
      for (const std::uint64_t part : key) {
        h = (h ^ part) * 0x9e3779b97f4a7c15ULL;
        h ^= h >> 32;
      }
      return h;
    }
  };

  Key key(const Point& p) const {
    Key bits{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = p[static_cast<Eigen::Index>(i)];
      const double compared =
          as_float_ && std::abs(x) <= static_cast<double>(std::numeric_limits<float>::max()) ? nearest_float(x) : x;
      bits[i] = std::bit_cast<std::uint64_t>(compared + 0.0);  // -0 becomes +0
    }
    return bits;
  }

  bool as_float_;
  std::unordered_map<Key, int, Hash> numbers_;
};

// Turned, not mirrored, so that the lowest number comes first: equal for triangles of the same cyclic order.
Triangle canonical(const Triangle& triangle, const std::vector<int>& places) {
  Triangle turned{};
  for (std::size_t i = 0; i < 3; ++i) turned[i] = places[static_cast<std::size_t>(triangle[i])];
  std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end()), turned.end());
  return turned;
}

std::vector<Triangle> sorted_triangles(const TriangleMesh& mesh, const std::vector<int>& places) {
  std::vector<Triangle> all;
  all.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) all.push_back(canonical(triangle, places));
  std::sort(all.begin(), all.end());
  return all;
}

bool has_three_corners(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

std::vector<bool> vertices_in_use(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& triangle : mesh.triangles)
    for (const std::int32_t v : triangle) used[static_cast<std::size_t>(v)] = true;
  return used;
}

// The tooth's triangles that can be looked at, and all its vertices.
TriangleMesh usable_part(const TriangleMesh& mesh) {
  TriangleMesh part{mesh.vertices, {}};
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  const auto usable = [&](std::int32_t v) {
    return v >= 0 && v < count && mesh.vertices[static_cast<std::size_t>(v)].allFinite();
  };
  for (const Triangle& t : mesh.triangles)
    if (std::all_of(t.begin(), t.end(), usable) && has_three_corners(t)) part.triangles.push_back(t);
  for (Point& p : part.vertices)
    if (!p.allFinite())
      p.setConstant(static_cast<double>(std::numeric_limits<float>::max()));  // in no triangle any more
  return part;
}

/// Numbers of the points that are no corner, to the last bit, of a triangle with area.
std::vector<std::size_t> points_off_corners(const TriangleMesh& mesh, const std::vector<Point>& points) {
  std::vector<bool> is_corner(mesh.vertices.size(), false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (triangle_area(mesh, t) > 0)
      for (const std::int32_t v : mesh.triangles[t]) is_corner[static_cast<std::size_t>(v)] = true;
  Places corners(false);
  for (std::size_t v = 0; v < is_corner.size(); ++v)
    if (is_corner[v]) corners.number(mesh.vertices[v]);
  const std::size_t count = corners.size();
  std::vector<std::size_t> off;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (static_cast<std::size_t>(corners.number(points[k])) >= count) off.push_back(k);
  return off;
}

CrownDeviation deviation_from(const TriangleMesh& tooth, const std::vector<Point>& points) {
  std::vector<double> distances(points.size(), 0.0);
  // Nearly all of a crown is in its tooth: that takes no search.
  if (const std::vector<std::size_t> off = points_off_corners(tooth, points); !off.empty()) {
    const ClosestPointIndex surface(tooth);
    tbb::parallel_for(std::size_t{0}, off.size(),
                      [&](std::size_t k) { distances[off[k]] = surface.closest(points[off[k]]).distance; });
  }
  CrownDeviation deviation;
  for (const double d : distances) {
    deviation.max = std::max(deviation.max, d);
    deviation.mean += d;
    ++deviation.bins[d <= 1e-3 ? 0 : d <= 1e-2 ? 1 : d <= 1e-1 ? 2 : 3];
  }
  deviation.mean /= static_cast<double>(std::max<std::size_t>(points.size(), 1));
  return deviation;
}

bool has_surface(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (triangle_quality(mesh, t) > 0) return true;
  return false;
}

struct Comparison {
  CrownCheck crown;
  std::vector<bool> new_triangles;  // of the tooth
  std::vector<bool> touches_crown;  // per triangle of the tooth: one of its vertices is the crown's
};

/// Per element, whether it is listed.
std::vector<bool> flags(std::size_t size, const std::vector<int>& listed) {
  std::vector<bool> is_listed(size, false);
  for (const int element : listed) is_listed[static_cast<std::size_t>(element)] = true;
  return is_listed;
}

// Places at which another one stands in get that one's number; places by number, in and out.
void stand_in_for_merged(const TriangleMesh& crown, const std::vector<std::array<int, 2>>& merged,
                         std::vector<int>& of_crown, CrownCheck& report) {
  if (merged.empty()) return;
  std::vector<int> stand_in(static_cast<std::size_t>(*std::max_element(of_crown.begin(), of_crown.end())) + 1);
  std::iota(stand_in.begin(), stand_in.end(), 0);
  for (const auto& [v, other] : merged) {
    stand_in[static_cast<std::size_t>(of_crown[static_cast<std::size_t>(v)])] =
        of_crown[static_cast<std::size_t>(other)];
    report.merged_distance_max = std::max(
        report.merged_distance_max,
        (crown.vertices[static_cast<std::size_t>(v)] - crown.vertices[static_cast<std::size_t>(other)]).norm());
  }
  for (int& place : of_crown) place = stand_in[static_cast<std::size_t>(place)];
}

Comparison compare(const TriangleMesh& crown, const TriangleMesh& tooth, bool as_float, const CheckOptions& options) {
  Comparison found;
  CrownCheck& report = found.crown;
  report.compared_as_float = as_float;
  Places places(as_float);
  const std::vector<int> of_tooth = places.number_all(tooth);
  const auto places_of_tooth = static_cast<int>(places.size());
  const std::vector<int> place_in_crown = places.number_all(crown);
  std::vector<int> of_crown = place_in_crown;
  stand_in_for_merged(crown, options.merged_vertices, of_crown, report);
  const auto is_kept = [&](std::int32_t v) { return of_crown[static_cast<std::size_t>(v)] < places_of_tooth; };

  const std::vector<bool> used = vertices_in_use(crown);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    ++report.vertices;
    if (of_crown[v] != place_in_crown[v])
      ++report.merged_vertices;
    else if (is_kept(static_cast<std::int32_t>(v)))
      ++report.kept_vertices;
    else
      report.dropped_vertices.push_back(static_cast<int>(v));
  }

  const std::vector<bool> repaired = flags(crown.triangles.size(), options.repaired_triangles);
  const std::vector<bool> dropped = flags(crown.vertices.size(), options.dropped_vertices);
  const std::vector<Triangle> in_tooth = sorted_triangles(tooth, of_tooth);
  const auto is_in_tooth = [&](const Triangle& triangle) {
    return std::binary_search(in_tooth.begin(), in_tooth.end(), canonical(triangle, of_crown));
  };
  for (std::size_t t = 0; t < crown.triangles.size(); ++t) {
    const Triangle& triangle = crown.triangles[t];
    if (!has_three_corners(triangle)) continue;
    ++report.triangles;
    const bool is_whole = std::all_of(triangle.begin(), triangle.end(), is_kept);
    if (is_whole || std::none_of(triangle.begin(), triangle.end(),
                                 [&](std::int32_t v) { return dropped[static_cast<std::size_t>(v)]; }))
      ++report.demanded_triangles;
    if (!is_whole) continue;
    if (is_in_tooth(triangle)) {
      ++report.kept_triangles;
    } else if (repaired[t]) {
      ++report.repaired_triangles;
      report.kept_triangles += is_in_tooth({triangle[0], triangle[2], triangle[1]});
    } else {
      report.broken_triangles.push_back(static_cast<int>(t));
    }
  }
  report.kept_share =
      report.triangles > 0 ? static_cast<double>(report.kept_triangles) / static_cast<double>(report.triangles) : 0;

  const std::vector<Triangle> in_crown = sorted_triangles(crown, of_crown);
  std::vector<bool> is_crown_place(places.size(), false);
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) is_crown_place[static_cast<std::size_t>(of_crown[v])] = true;
  for (const Triangle& triangle : tooth.triangles) {
    found.new_triangles.push_back(!std::binary_search(in_crown.begin(), in_crown.end(), canonical(triangle, of_tooth)));
    found.touches_crown.push_back(std::any_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
      return is_crown_place[static_cast<std::size_t>(of_tooth[static_cast<std::size_t>(v)])];
    }));
  }
  return found;
}

NewTriangleFigures new_triangle_figures(const TriangleMesh& tooth, const Comparison& found) {
  std::vector<bool> inner = found.new_triangles;
  std::vector<bool> at_border = found.new_triangles;
  for (std::size_t t = 0; t < inner.size(); ++t) {
    inner[t] = inner[t] && !found.touches_crown[t];
    at_border[t] = at_border[t] && found.touches_crown[t];
  }
  return {quality(tooth, found.new_triangles), quality(tooth, inner), quality(tooth, at_border)};
}

SolidCheck check_solid(const TriangleMesh& tooth, const TriangleMesh& usable, const Diagnosis& found) {
  const auto count = [](const auto& ids) { return static_cast<std::int64_t>(ids.size()); };
  SolidCheck solid;
  solid.valid = found.is_valid() && !tooth.triangles.empty();
  solid.vertices = found.vertices;
  solid.triangles = count(tooth.triangles);
  solid.unreferenced_vertices = count(found.unreferenced_vertices);
  solid.border_edges = count(found.border_edges);
  solid.non_manifold_edges = count(found.non_manifold_edges);
  solid.misoriented_edges = count(found.misoriented_edges);
  solid.non_manifold_vertices = count(found.non_manifold_vertices);
  solid.components = found.components;
  solid.euler_number = found.euler_number;
  solid.genus = found.genus;
  solid.volume = found.volume;
  solid.self_intersections = self_intersecting_triangles(usable);
  solid.holds = solid.valid && found.is_closed_manifold() && solid.unreferenced_vertices == 0 &&
                solid.components == 1 && solid.genus == 0 && solid.volume > 0 && solid.self_intersections.empty();
  return solid;
}

double share_of_demanded(const CrownCheck& crown) {
  return static_cast<double>(crown.kept_triangles) /
         static_cast<double>(std::max<std::int64_t>(crown.demanded_triangles, 1));
}

void tell_crown_failures(const CrownCheck& crown, double least_kept_share, std::vector<std::string>& failures) {
  if (crown.kept_triangles == 0)
    failures.push_back("no triangle of the crown is in the tooth");
  else if (share_of_demanded(crown) < least_kept_share)
    failures.push_back(
        fmt::format("only {:.1f} % of the crown's triangles are in the tooth, at least {:.1f} % are demanded",
                    100 * share_of_demanded(crown), 100 * least_kept_share));
  if (!crown.broken_triangles.empty())
    failures.push_back(
        fmt::format("{} triangles of the crown are not in the tooth although all their vertices are, the first is {}",
                    crown.broken_triangles.size(), crown.broken_triangles.front()));
}

void tell_solid_failures(const SolidCheck& solid, const Diagnosis& found, std::vector<std::string>& failures) {
  if (solid.triangles == 0) failures.push_back("the tooth has no triangles");
  if (solid.border_edges > 0) failures.push_back(fmt::format("the tooth is open: {} border edges", solid.border_edges));
  // Flat triangles and coinciding vertices are no failures by themselves: where they matter, triangles meet.
  Diagnosis promised = found;
  promised.degenerate_triangles.clear();
  promised.duplicate_vertices.clear();
  for (const std::string& defect : describe_defects(promised)) failures.push_back("the tooth has " + defect);
  if (solid.components > 1) failures.push_back(fmt::format("the tooth has {} pieces", solid.components));
  if (solid.genus && solid.components == 1 && *solid.genus != 0)
    failures.push_back(fmt::format("the tooth has {} handles", *solid.genus));
  if (found.is_closed_manifold() && !(solid.volume > 0)) failures.push_back("the tooth is inside out");
  if (!solid.self_intersections.empty())
    failures.push_back(fmt::format("the tooth cuts itself in {} pairs of triangles, the first is {} and {}",
                                   solid.self_intersections.size(), solid.self_intersections.front().first,
                                   solid.self_intersections.front().second));
}

}  // namespace

CheckOptions allowing_for(const std::vector<RepairStep>& repairs) {
  CheckOptions options;
  for (const RepairStep& step : repairs) {
    options.repaired_triangles.insert(options.repaired_triangles.end(), step.triangles.begin(), step.triangles.end());
    for (std::size_t k = 0; k < step.merged_into.size(); ++k)
      options.merged_vertices.push_back({step.vertices[k], step.merged_into[k]});
  }
  return options;
}

CheckReport check(const TriangleMesh& crown, const TriangleMesh& tooth, const CheckOptions& options) {
  require_ranges("the check", {{"least_kept_share", options.least_kept_share, share_range}});
  if (crown.triangles.empty()) throw InputError("the crown has no triangles");
  require_valid_indices(crown);
  require_finite(crown.vertices);
  for (const int t : options.repaired_triangles)
    if (t < 0 || static_cast<std::size_t>(t) >= crown.triangles.size())
      throw UsageError(fmt::format("triangle {}, listed as repaired, is not one of the crown's", t));
  for (const int v : options.dropped_vertices)
    if (v < 0 || static_cast<std::size_t>(v) >= crown.vertices.size())
      throw UsageError(fmt::format("vertex {}, listed as dropped, is not one of the crown's", v));

  for (const auto& pair : options.merged_vertices)
    for (const int v : pair)
      if (v < 0 || static_cast<std::size_t>(v) >= crown.vertices.size())
        throw UsageError(fmt::format("vertex {}, listed as merged, is not one of the crown's", v));

  const TriangleMesh usable = usable_part(tooth);
  const Diagnosis found = diagnose(tooth);
  Comparison comparison = compare(crown, usable, options.compare_as_float.value_or(all_floats(usable)), options);
  CheckReport report;
  report.crown = std::move(comparison.crown);
  if (has_surface(usable)) report.crown.deviation = deviation_from(usable, compact(crown).mesh.vertices);
  report.crown.holds = report.crown.kept_triangles > 0 && share_of_demanded(report.crown) >= options.least_kept_share &&
                       report.crown.broken_triangles.empty();
  report.solid = check_solid(tooth, usable, found);
  report.new_triangles = new_triangle_figures(usable, comparison);
  report.all_triangles = quality(usable);
  tell_crown_failures(report.crown, options.least_kept_share, report.failures);
  tell_solid_failures(report.solid, found, report.failures);
  return report;
}

}  // namespace rhizodont
