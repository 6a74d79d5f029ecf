// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// M. Attene, M. Campen and L. Kobbelt, "Polygon mesh repairing: an application perspective", ACM Computing Surveys
// 45(2),
//   2013: defects and their order. All repairs here are local and leave coordinates alone, so that what is left of the
//   crown is still the scan.

#include "mesh/repair.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/pieces.hpp"
#include "mesh/places.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/tunnels.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>

namespace rhizodont {
namespace {

using Ids = std::vector<int>;

std::vector<bool> used_vertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) used[static_cast<std::size_t>(v)] = true;
  return used;
}

/// The mesh under repair. Each step returns the input's numbers of the triangles that it changed.
class Workpiece {
 public:
  explicit Workpiece(const TriangleMesh& mesh)
      : mesh_(mesh), origin_(mesh.triangles.size()), stands_for_(mesh.vertices.size()) {
    std::iota(origin_.begin(), origin_.end(), 0);
    std::iota(stands_for_.begin(), stands_for_.end(), 0);
  }

  const TriangleMesh& mesh() const { return mesh_; }
  const Ids& origin() const { return origin_; }

  /// The vertex that took the place of v across seams, or v itself.
  int stand_in(int v) const {
    while (stands_for_[static_cast<std::size_t>(v)] != v) v = stands_for_[static_cast<std::size_t>(v)];
    return v;
  }
  double widest_seam_mm() const { return widest_seam_mm_; }

  Ids merge_vertices() {
    const Ids first = first_at_place(mesh_.vertices);
    for (Triangle& t : mesh_.triangles)
      for (std::int32_t& v : t) v = first[static_cast<std::size_t>(v)];
    return {};
  }

  Ids merge_seams(const SeamOptions& options) {
    const Seams seams = find_seams(mesh_, options);
    widest_seam_mm_ = std::max(widest_seam_mm_, seams.largest_mm);
    for (Triangle& t : mesh_.triangles)
      for (std::int32_t& v : t) v = seams.target[static_cast<std::size_t>(v)];
    for (std::size_t v = 0; v < seams.target.size(); ++v)
      if (seams.target[v] != static_cast<int>(v)) stands_for_[v] = seams.target[v];
    return {};
  }

  Ids drop_inward_copies();

  /// Repeated corners, no area, or the same corners as an earlier triangle.
  Ids drop_bad_triangles() {
    const Diagnosis found = diagnose(mesh_);
    std::vector<bool> bad(mesh_.triangles.size(), false);
    for (const Ids* ids : {&found.repeated_index_triangles, &found.degenerate_triangles, &found.duplicate_triangles})
      for (const int t : *ids) bad[static_cast<std::size_t>(t)] = true;
    return drop(bad);
  }

  Ids close_t_junctions();
  Ids thin_out_crowded_edges();
  Ids orient();

  /// Throws InputError where another piece is of like size.
  Ids drop_pieces(PieceKind kind) {
    const Pieces pieces = sort_pieces(mesh_);
    if (pieces.count(PieceKind::like) > 0) throw InputError(describe_pieces(mesh_, pieces));
    std::vector<bool> which;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) which.push_back(pieces.kind_of(t) == kind);
    return drop(which);
  }

  Ids drop_touching_vertices() { return drop_vertices(diagnose(mesh_).non_manifold_vertices); }
  Ids drop_spikes(const RepairOptions& options);

  /// Cuts one tunnel of a piece that has no other defect left.
  Ids cut_tunnel() { return diagnose(mesh_).is_oriented_manifold() ? drop_vertices(short_handle_loop(mesh_)) : Ids{}; }
  Ids drop_cuts(double most_share) {
    Ids cutting;
    for (const auto& [a, b] : self_intersecting_triangles(mesh_))
      for (const int t : {a, b})
        for (const int v : mesh_.triangles[static_cast<std::size_t>(t)]) cutting.push_back(v);
    std::sort(cutting.begin(), cutting.end());
    cutting.erase(std::unique(cutting.begin(), cutting.end()), cutting.end());
    const std::vector<bool> used = used_vertices(mesh_);
    const auto count = static_cast<double>(std::count(used.begin(), used.end(), true));
    return static_cast<double>(cutting.size()) > most_share * count ? Ids{} : drop_vertices(cutting);
  }

 private:
  Ids drop(const std::vector<bool>& which) {
    Ids dropped;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < which.size(); ++t) {
      if (which[t]) {
        dropped.push_back(origin_[t]);
        continue;
      }
      mesh_.triangles[kept] = mesh_.triangles[t];
      origin_[kept++] = origin_[t];
    }
    mesh_.triangles.resize(kept);
    origin_.resize(kept);
    return dropped;
  }

  Ids drop_vertices(const Ids& vertices) {
    std::vector<bool> gone(mesh_.vertices.size(), false);
    for (const int v : vertices) gone[static_cast<std::size_t>(v)] = true;
    std::vector<bool> which;
    for (const Triangle& t : mesh_.triangles)
      which.push_back(std::any_of(t.begin(), t.end(), [&](int v) { return gone[static_cast<std::size_t>(v)]; }));
    return drop(which);
  }

  bool lies_on_edge(int v, int a, int b) const;

  TriangleMesh mesh_;
  Ids origin_;      // per triangle: the input's triangle that it is or is part of
  Ids stands_for_;  // per vertex: the one merged with it across a seam, or itself
  double widest_seam_mm_ = 0;
};

/// Of triangles that are there once each way the copy goes that does not face as its piece does, outward.
Ids Workpiece::drop_inward_copies() {
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  const auto is_even = [](const Triangle& t) { return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2; };
  struct Copies {
    int first = -1, other_way = -1;
  };
  std::map<Triangle, Copies> places;
  bool any = false;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Triangle& c = mesh_.triangles[t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    Copies& copies = places[sorted(c)];
    if (copies.first < 0) {
      copies.first = static_cast<int>(t);
    } else if (is_even(c) != is_even(mesh_.triangles[static_cast<std::size_t>(copies.first)])) {
      copies.other_way = static_cast<int>(t);
      any = true;
    }
  }
  if (!any) return {};
  TriangleMesh once{mesh_.vertices, {}};
  std::vector<Copies> of_once;
  for (const auto& [key, copies] : places) {
    once.triangles.push_back(mesh_.triangles[static_cast<std::size_t>(copies.first)]);
    of_once.push_back(copies);
  }
  std::vector<bool> which(mesh_.triangles.size(), false);
  Workpiece one_sided(once);
  one_sided.thin_out_crowded_edges();
  one_sided.orient();
  for (std::size_t k = 0; k < one_sided.origin_.size(); ++k) {
    const auto o = static_cast<std::size_t>(one_sided.origin_[k]);
    if (of_once[o].other_way < 0) continue;
    const bool turned = is_even(one_sided.mesh_.triangles[k]) != is_even(once.triangles[o]);
    which[static_cast<std::size_t>(turned ? of_once[o].first : of_once[o].other_way)] = true;
  }
  return drop(which);
}

bool Workpiece::lies_on_edge(int v, int a, int b) const {
  const Point& p = mesh_.vertices[static_cast<std::size_t>(a)];
  const Eigen::Vector3d along = mesh_.vertices[static_cast<std::size_t>(b)] - p;
  const Eigen::Vector3d to = mesh_.vertices[static_cast<std::size_t>(v)] - p;
  constexpr double tolerance = 1e-6;  // of the edge's length: files round coordinates to seven digits
  return to.cross(along).norm() <= tolerance * along.squaredNorm() && to.dot(along) > 0 &&
         to.dot(along) < along.squaredNorm();
}

/// A gap whose border is an edge on one side and a chain of vertices on that edge on the other.
Ids Workpiece::close_t_junctions() {
  const EdgeTable table = edge_table(mesh_);
  Ids next(mesh_.vertices.size(), -1);      // along the border; -1 also where it branches
  std::vector<std::pair<int, int>> border;  // half-edge, from
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    int& to = next[static_cast<std::size_t>(half_edge_from(mesh_, h))];
    to = to == -1 ? half_edge_to(mesh_, h) : -2;
    border.emplace_back(h, half_edge_from(mesh_, h));
  }
  Ids cut;
  std::vector<bool> is_cut(mesh_.triangles.size(), false);
  for (const auto& [h, a] : border) {
    const int b = half_edge_to(mesh_, h);
    const auto t = static_cast<std::size_t>(h / 3);
    Ids chain{b};
    constexpr std::size_t longest = 16;
    while (chain.size() < longest && next[static_cast<std::size_t>(chain.back())] >= 0 &&
           lies_on_edge(next[static_cast<std::size_t>(chain.back())], a, b))
      chain.push_back(next[static_cast<std::size_t>(chain.back())]);
    if (chain.size() < 2 || next[static_cast<std::size_t>(chain.back())] != a || is_cut[t]) continue;
    chain.push_back(a);
    const int apex = mesh_.triangles[t][static_cast<std::size_t>((h + 2) % 3)];
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Triangle piece{chain[i + 1], chain[i], apex};
      if (i == 0) {
        mesh_.triangles[t] = piece;
      } else {
        mesh_.triangles.push_back(piece);
        origin_.push_back(origin_[t]);
      }
    }
    is_cut[t] = true;
    cut.push_back(origin_[t]);
  }
  return cut;
}

/// Parts of a mesh that hang together over edges with two triangles.
struct Patches {
  Ids of_triangle;
  Ids size;  // triangles per patch
};

Patches find_patches(const EdgeTable& table, std::size_t triangles) {
  std::vector<std::array<int, 3>> over(triangles, {-1, -1, -1});
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 2) continue;
    const int g = table.half_edges[static_cast<std::size_t>(table.first[e])];
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e]) + 1];
    over[static_cast<std::size_t>(g / 3)][static_cast<std::size_t>(g % 3)] = h / 3;
    over[static_cast<std::size_t>(h / 3)][static_cast<std::size_t>(h % 3)] = g / 3;
  }
  Patches patches{Ids(triangles, -1), {}};
  for (std::size_t start = 0; start < triangles; ++start) {
    if (patches.of_triangle[start] >= 0) continue;
    const int number = static_cast<int>(patches.size.size());
    patches.of_triangle[start] = number;
    Ids found{static_cast<int>(start)};
    for (std::size_t k = 0; k < found.size(); ++k)
      for (const int n : over[static_cast<std::size_t>(found[k])]) {
        if (n < 0 || patches.of_triangle[static_cast<std::size_t>(n)] >= 0) continue;
        patches.of_triangle[static_cast<std::size_t>(n)] = number;
        found.push_back(n);
      }
    patches.size.push_back(static_cast<int>(found.size()));
  }
  return patches;
}

/// Patches end at crowded edges. The smaller ones give way, one after the other, as long as an edge of theirs is
/// crowded; an edge at which one patch meets itself, or which hardly joins two of like size, loses all its triangles.
Ids Workpiece::thin_out_crowded_edges() {
  const EdgeTable table = edge_table(mesh_);
  Ids count(table.size(), 0);
  std::vector<std::size_t> crowded;
  for (std::size_t e = 0; e < table.size(); ++e) {
    count[e] = table.triangle_count(e);
    if (count[e] > 2) crowded.push_back(e);
  }
  if (crowded.empty()) return {};
  const auto triangles_at = [&](std::size_t e) {
    Ids ids;
    for (int k = table.first[e]; k < table.first[e + 1]; ++k)
      ids.push_back(table.half_edges[static_cast<std::size_t>(k)] / 3);
    return ids;
  };
  const Patches patches = find_patches(table, mesh_.triangles.size());
  const auto patch_of = [&](int t) {
    return static_cast<std::size_t>(patches.of_triangle[static_cast<std::size_t>(t)]);
  };
  std::vector<std::vector<std::size_t>> crowded_in_patch(patches.size.size());
  for (const std::size_t e : crowded)
    for (const int t : triangles_at(e)) crowded_in_patch[patch_of(t)].push_back(e);

  std::vector<std::size_t> order(patches.size.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return patches.size[x] < patches.size[y]; });
  order.pop_back();
  std::vector<double> area(patches.size.size(), 0), crowded_length(patches.size.size(), 0);
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    area[patch_of(static_cast<int>(t))] += triangle_area(mesh_, t);
  for (std::size_t p = 0; p < crowded_in_patch.size(); ++p)
    for (const std::size_t e : crowded_in_patch[p])
      crowded_length[p] += (mesh_.vertices[static_cast<std::size_t>(table.vertices[e][0])] -
                            mesh_.vertices[static_cast<std::size_t>(table.vertices[e][1])])
                               .norm();
  // A wall across a crown hangs on all of its rim, at least that of a disc; a second crown hangs on by an edge or two.
  const double largest = *std::max_element(area.begin(), area.end());
  const auto is_crown = [&](std::size_t p) {
    return area[p] >= PieceOptions{}.like_share * largest &&
           crowded_length[p] * crowded_length[p] < 0.1 * 4 * std::numbers::pi * area[p];
  };
  std::vector<bool> gone(patches.size.size(), false);
  for (const std::size_t p : order) {
    const auto& edges = crowded_in_patch[p];
    if (is_crown(p) || std::none_of(edges.begin(), edges.end(), [&](std::size_t e) { return count[e] > 2; })) continue;
    gone[p] = true;
    for (const std::size_t e : edges) --count[e];
  }
  std::vector<bool> which;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) which.push_back(gone[patch_of(static_cast<int>(t))]);
  for (const std::size_t e : crowded)
    if (count[e] > 2)
      for (const int t : triangles_at(e)) which[static_cast<std::size_t>(t)] = true;
  return drop(which);
}

/// Per piece, triangles are turned so that neighbours agree; the side with the larger area stays. A piece that then
/// faces inwards is turned as a whole.
Ids Workpiece::orient() {
  const TriangleAdjacency adjacency = triangle_adjacency(mesh_);
  const std::size_t count = mesh_.triangles.size();
  std::vector<bool> seen(count, false), turned(count, false);
  const auto runs = [&](std::size_t t, int a, int b) {
    const Triangle& c = mesh_.triangles[t];
    for (std::size_t i = 0; i < 3; ++i)
      if (c[i] == a && c[(i + 1) % 3] == b) return true;
    return false;
  };
  for (std::size_t start = 0; start < count; ++start) {
    if (seen[start]) continue;
    Ids piece{static_cast<int>(start)};
    seen[start] = true;
    double area = 0, turned_area = 0;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const auto t = static_cast<std::size_t>(piece[k]);
      (turned[t] ? turned_area : area) += triangle_area(mesh_, t);
      for (std::size_t i = 0; i < 3; ++i) {
        const int n = adjacency.neighbours[t][i];
        if (n < 0 || seen[static_cast<std::size_t>(n)]) continue;
        const Triangle& c = mesh_.triangles[t];
        const bool same_way = runs(static_cast<std::size_t>(n), c[i], c[(i + 1) % 3]);
        seen[static_cast<std::size_t>(n)] = true;
        turned[static_cast<std::size_t>(n)] = turned[t] != same_way;
        piece.push_back(n);
      }
    }
    if (turned_area > area)
      for (const int t : piece) turned[static_cast<std::size_t>(t)] = !turned[static_cast<std::size_t>(t)];
  }
  const auto turn = [&](std::size_t t) { std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]); };
  for (std::size_t t = 0; t < count; ++t)
    if (turned[t]) turn(t);
  if (cone_volume(mesh_) < 0)
    for (std::size_t t = 0; t < count; ++t) {
      turn(t);
      turned[t] = !turned[t];
    }
  Ids changed;
  for (std::size_t t = 0; t < count; ++t)
    if (turned[t]) changed.push_back(origin_[t]);
  return changed;
}

Ids Workpiece::drop_spikes(const RepairOptions& options) {
  std::vector<Ids> neighbours(mesh_.vertices.size());
  for (const Triangle& t : mesh_.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) neighbours[static_cast<std::size_t>(t[i])].push_back(t[j]);
  Ids spikes;
  for (std::size_t v = 0; v < neighbours.size(); ++v) {
    Ids& ring = neighbours[v];
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    if (ring.size() < 3) continue;
    Point mean = Point::Zero();
    for (const int w : ring) mean += mesh_.vertices[static_cast<std::size_t>(w)] / static_cast<double>(ring.size());
    double radius = 0;
    for (const int w : ring)
      radius += (mesh_.vertices[static_cast<std::size_t>(w)] - mean).norm() / static_cast<double>(ring.size());
    const double height = (mesh_.vertices[v] - mean).norm();
    if (height > options.spike_height * radius && height > options.spike_least_mm)
      spikes.push_back(static_cast<int>(v));
  }
  return drop_vertices(spikes);
}

/// Does the steps one after the other and keeps the book of what they did.
class Repair {
 public:
  Repair(const TriangleMesh& mesh, const RepairOptions& options) : input_(mesh), options_(options), piece_(mesh) {}

  RepairedMesh run() {
    for (int round = 0; round < options_.rounds && do_all_steps(); ++round) {
    }
    if (piece_.mesh().triangles.empty())
      throw InputError("Nothing is left of the crown once its defects are repaired.");
    Submesh rest = compact(piece_.mesh());
    keep_to_the_point(rest.old_vertices);
    return {std::move(rest.mesh), std::move(rest.old_vertices), piece_.origin(), std::move(steps_)};
  }

 private:
  bool do_all_steps() {
    bool any = false;
    using enum RepairAction;
    const auto step = [&](RepairAction action, const std::function<Ids()>& work) { any |= note(action, work); };
    step(same_place_merged, [&] { return piece_.merge_vertices(); });
    step(inward_copy_dropped, [&] { return piece_.drop_inward_copies(); });
    step(bad_triangle_dropped, [&] { return piece_.drop_bad_triangles(); });
    step(seam_merged, [&] { return piece_.merge_seams(options_.seam); });
    step(t_junction_cut, [&] { return piece_.close_t_junctions(); });
    step(crowded_edge_dropped, [&] { return piece_.thin_out_crowded_edges(); });
    step(speck_dropped, [&] { return piece_.drop_pieces(PieceKind::speck); });
    step(piece_dropped, [&] { return piece_.drop_pieces(PieceKind::small); });
    step(turned_over, [&] { return piece_.orient(); });
    if (options_.connections_only) return any;
    step(touching_dropped, [&] { return piece_.drop_touching_vertices(); });
    step(spike_dropped, [&] { return piece_.drop_spikes(options_); });
    // The costly steps wait until the others have nothing left to do.
    if (!any) step(tunnel_cut, [&] { return piece_.cut_tunnel(); });
    if (!any) step(cutting_dropped, [&] { return piece_.drop_cuts(options_.most_cut_share); });
    return any;
  }

  bool note(RepairAction action, const std::function<Ids()>& work) {
    const std::vector<bool> before = used_vertices(piece_.mesh());
    Ids triangles = work();
    const std::vector<bool> after = used_vertices(piece_.mesh());
    Ids vertices;
    for (std::size_t v = 0; v < before.size(); ++v)
      if (before[v] && !after[v]) vertices.push_back(static_cast<int>(v));
    if (triangles.empty() && vertices.empty()) return false;
    auto same = std::find_if(steps_.begin(), steps_.end(), [&](const RepairStep& s) { return s.action == action; });
    if (same == steps_.end()) same = steps_.insert(steps_.end(), {action, {}, {}});
    same->vertices.insert(same->vertices.end(), vertices.begin(), vertices.end());
    same->triangles.insert(same->triangles.end(), triangles.begin(), triangles.end());
    return true;
  }

  /// Lists only those triangles all of whose corners' places are left: the others went with their corners.
  void keep_to_the_point(const Ids& kept_vertices) {
    Ids place = first_at_place(input_.vertices);
    for (int& p : place) p = piece_.stand_in(p);
    std::vector<bool> is_left(input_.vertices.size(), false);
    for (const int v : kept_vertices) is_left[static_cast<std::size_t>(place[static_cast<std::size_t>(v)])] = true;
    for (RepairStep& step : steps_) {
      std::sort(step.vertices.begin(), step.vertices.end());
      if (step.action == RepairAction::seam_merged) {
        for (const int v : step.vertices) step.merged_into.push_back(piece_.stand_in(v));
        step.widest_seam_mm = piece_.widest_seam_mm();
      }
      std::sort(step.triangles.begin(), step.triangles.end());
      step.triangles.erase(std::unique(step.triangles.begin(), step.triangles.end()), step.triangles.end());
      std::erase_if(step.triangles, [&](int t) {
        const Triangle& c = input_.triangles[static_cast<std::size_t>(t)];
        return std::any_of(c.begin(), c.end(), [&](int v) {
          return !is_left[static_cast<std::size_t>(place[static_cast<std::size_t>(v)])];
        });
      });
    }
  }

  const TriangleMesh& input_;
  RepairOptions options_;
  Workpiece piece_;
  std::vector<RepairStep> steps_;
};

void require_in_range(const RepairOptions& options) {
  require_in_range(options.seam);
  require_ranges("a repair", {{"spike_height", options.spike_height, OptionRange::above(0)},
                              {"spike_least_mm", options.spike_least_mm, OptionRange::at_least(0)},
                              {"most_cut_share", options.most_cut_share, share_range},
                              {"rounds", options.rounds, OptionRange::at_least(1)}});
}

}  // namespace

RepairedMesh repair(const TriangleMesh& mesh, const RepairOptions& options) {
  require_in_range(options);
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
  return Repair(mesh, options).run();
}

}  // namespace rhizodont
