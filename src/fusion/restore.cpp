// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The dual of the restricted Voronoi diagram follows "Completing Dental Models While Preserving Crown Geometry and
// Meshing Topology", section 3.5. There the dual is the result; here it only proposes root triangles: the crown is
// taken from the input, so that it is exact whatever the dual did to it.

#include "fusion/restore.hpp"

#include "base/option_range.hpp"
#include "fusion/fill_holes.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>

namespace rhizodont {
namespace {

using HalfEdge = std::pair<int, int>;

std::array<HalfEdge, 3> half_edges(const Triangle& t) {
  return {HalfEdge{t[0], t[1]}, HalfEdge{t[1], t[2]}, HalfEdge{t[2], t[0]}};
}

/// The root's triangles beside the crown, and how they are taken back until the two fit.
class RootPatch {
 public:
  RootPatch(const TriangleMesh& crown, const Joining& joining) : crown_(crown), sites_(joining.sites) {
    crown_half_edges_.reserve(3 * crown.triangles.size());
    for (const Triangle& t : crown.triangles)
      for (const HalfEdge& h : half_edges(t)) crown_half_edges_.push_back(h);
    std::sort(crown_half_edges_.begin(), crown_half_edges_.end());
    for (const HalfEdge& h : crown_half_edges_)
      if (!is_of_crown({h.second, h.first})) border_half_edges_.push_back(h);
    const std::vector<BorderPiece> pieces = border_pieces(crown);
    const BorderPiece& base = pieces[base_piece(pieces)];
    base_ = base.half_edges;
    std::vector<bool> at_base(sites_.size(), false);
    for (const int v : base.vertices) at_base[static_cast<std::size_t>(v)] = true;
    const int first_root = joining.crown_vertices + joining.steiner_points;
    for (const Triangle& t : joining.triangles) {
      const bool has_root = std::any_of(t.begin(), t.end(), [&](int v) { return v >= first_root; });
      const bool fits = std::all_of(t.begin(), t.end(),
                                    [&](int v) { return v >= first_root || at_base[static_cast<std::size_t>(v)]; });
      if (has_root && fits && fits_crown(t)) triangles_.push_back(t);
    }
  }

  /// Takes triangles back until crown and patch together are a manifold with separate, simple border loops.
  void make_manifold() {
    while (remove_crowded_edges() || keep_largest_component() || remove_pinched_vertices()) {
    }
    if (triangles_.empty()) throw NoResultError("The predicted root and the crown do not meet.");
  }

  void remove_around(const std::set<int>& vertices) {
    std::erase_if(triangles_, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](int v) { return vertices.contains(v); });
    });
  }

  /// Joins a patch that does not touch the crown by two triangles between the nearest border edges of both. Throws
  /// NoResultError if the patch has no border.
  void bridge_to_crown() {
    for (const Triangle& t : triangles_)
      for (const auto& [a, b] : half_edges(t))
        if (is_of_crown({b, a})) return;
    std::vector<HalfEdge> open;
    for (const HalfEdge& h : open_half_edges()) {
      if (h.first < crown_vertices() && h.second < crown_vertices()) continue;
      open.push_back(h);
    }
    if (open.empty()) throw NoResultError("The predicted root is closed by itself and does not meet the crown.");
    double best = std::numeric_limits<double>::max();
    HalfEdge ours, crowns;
    for (const HalfEdge& c : base_) {
      for (const HalfEdge& r : open) {
        const double d = distance(c.first, r.second) + distance(c.second, r.first);
        if (d >= best) continue;
        best = d;
        ours = r;
        crowns = c;
      }
    }
    triangles_.push_back({crowns.second, crowns.first, ours.second});
    triangles_.push_back({crowns.second, ours.second, ours.first});
  }

  /// Crown and patch in one mesh: crown vertices and triangles first.
  TriangleMesh joined() const {
    TriangleMesh mesh = crown_;
    std::map<int, int> number;
    for (Triangle t : triangles_) {
      for (std::int32_t& v : t) {
        if (v < crown_vertices()) continue;
        const auto [place, is_new] = number.try_emplace(v, static_cast<int>(mesh.vertices.size()));
        if (is_new) mesh.vertices.push_back(sites_[static_cast<std::size_t>(v)]);
        v = place->second;
      }
      mesh.triangles.push_back(t);
    }
    return mesh;
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// The site behind each vertex of `joined()`.
  std::vector<int> joined_sites() const {
    std::vector<int> sites(crown_.vertices.size());
    for (std::size_t v = 0; v < sites.size(); ++v) sites[v] = static_cast<int>(v);
    std::set<int> seen;
    for (const Triangle& t : triangles_)
      for (const int v : t)
        if (v >= crown_vertices() && seen.insert(v).second) sites.push_back(v);
    return sites;
  }

 private:
  int crown_vertices() const { return static_cast<int>(crown_.vertices.size()); }

  bool is_of_crown(const HalfEdge& h) const {
    return std::binary_search(crown_half_edges_.begin(), crown_half_edges_.end(), h);
  }

  double distance(int a, int b) const {
    return (sites_[static_cast<std::size_t>(a)] - sites_[static_cast<std::size_t>(b)]).norm();
  }

  /// No edge of the triangle repeats a half-edge of the crown or lies inside the crown.
  bool fits_crown(const Triangle& t) const {
    const std::array<HalfEdge, 3> edges = half_edges(t);
    return std::none_of(edges.begin(), edges.end(), [&](const HalfEdge& h) { return is_of_crown(h); });
  }

  std::vector<HalfEdge> sorted_half_edges() const {
    std::vector<HalfEdge> all;
    all.reserve(3 * triangles_.size());
    for (const Triangle& t : triangles_)
      for (const HalfEdge& h : half_edges(t)) all.push_back(h);
    std::sort(all.begin(), all.end());
    return all;
  }

  /// Removes triangles at half-edges that stand twice; true if any was removed.
  bool remove_crowded_edges() {
    const std::vector<HalfEdge> all = sorted_half_edges();
    std::vector<HalfEdge> twice;
    for (std::size_t i = 1; i < all.size(); ++i)
      if (all[i] == all[i - 1]) twice.push_back(all[i]);
    if (twice.empty()) return false;
    std::erase_if(triangles_, [&](const Triangle& t) {
      const auto edges = half_edges(t);
      return std::any_of(edges.begin(), edges.end(),
                         [&](const HalfEdge& h) { return std::binary_search(twice.begin(), twice.end(), h); });
    });
    return true;
  }

  bool keep_largest_component() {
    if (triangles_.empty()) return false;
    TriangleMesh patch{sites_, triangles_};
    const ConnectedComponents components = connected_components(patch);
    if (components.count <= 1) return false;
    std::vector<int> size(static_cast<std::size_t>(components.count), 0);
    for (const int c : components.of_triangle) ++size[static_cast<std::size_t>(c)];
    const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (components.of_triangle[t] == largest) kept.push_back(triangles_[t]);
    triangles_ = std::move(kept);
    return true;
  }

  /// Half-edges of crown and patch without a triangle on their other side.
  std::vector<HalfEdge> open_half_edges() const {
    const std::vector<HalfEdge> patch = sorted_half_edges();
    const auto is_open = [&](const HalfEdge& h) {
      const HalfEdge other{h.second, h.first};
      return !std::binary_search(patch.begin(), patch.end(), other) && !is_of_crown(other);
    };
    std::vector<HalfEdge> open;
    std::copy_if(border_half_edges_.begin(), border_half_edges_.end(), std::back_inserter(open), is_open);
    std::copy_if(patch.begin(), patch.end(), std::back_inserter(open), is_open);
    std::sort(open.begin(), open.end());
    return open;
  }

  /// Removes the patch around vertices where two gaps meet, or around which its triangles do not form one fan.
  bool remove_pinched_vertices() {
    std::map<int, int> leaving;
    for (const HalfEdge& h : open_half_edges()) ++leaving[h.first];
    std::set<int> pinched;
    for (const auto& [v, count] : leaving)
      if (count > 1) pinched.insert(v);
    for (const int v : vertices_with_several_fans()) pinched.insert(v);
    const std::size_t before = triangles_.size();
    remove_around(pinched);
    return triangles_.size() != before;
  }

  /// Vertices of the patch alone whose triangles there form more than one fan while no gap explains it.
  std::vector<int> vertices_with_several_fans() const {
    struct Turn {
      int at, from, to;  // around vertex `at`
      bool operator<(const Turn& other) const { return at < other.at; }
    };
    std::vector<bool> of_patch(sites_.size(), false);
    for (const Triangle& t : triangles_)
      for (const int v : t) of_patch[static_cast<std::size_t>(v)] = true;
    std::vector<Turn> turns;
    const auto add = [&](const Triangle& t) {
      for (std::size_t i = 0; i < 3; ++i)
        if (of_patch[static_cast<std::size_t>(t[i])]) turns.push_back({t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
    };
    for (const Triangle& t : triangles_) add(t);
    for (const Triangle& t : crown_.triangles) add(t);
    std::stable_sort(turns.begin(), turns.end());
    std::vector<int> found;
    for (auto first = turns.begin(); first != turns.end();) {
      const auto last = std::find_if(first, turns.end(), [&](const Turn& t) { return t.at != first->at; });
      const auto starting = [&](int from) {
        return std::find_if(first, last, [&](const Turn& t) { return t.from == from; });
      };
      // An open fan starts where nothing leads to.
      auto start = first;
      for (auto it = first; it != last; ++it)
        if (std::none_of(first, last, [&](const Turn& t) { return t.to == it->from; })) start = it;
      auto it = start;
      std::ptrdiff_t steps = 0;
      do {
        ++steps;
        it = starting(it->to);
      } while (it != last && it != start && steps < last - first);
      if (steps != last - first) found.push_back(first->at);
      first = last;
    }
    return found;
  }

  const TriangleMesh& crown_;
  const std::vector<Point>& sites_;
  std::vector<HalfEdge> crown_half_edges_;   // sorted
  std::vector<HalfEdge> border_half_edges_;  // those of the crown without a triangle on their other side, sorted
  std::vector<HalfEdge> base_;               // the crown's border that the root continues
  std::vector<Triangle> triangles_;
};

/// Sites around which the patch is to be taken back: those of the new triangles that cut others.
std::set<int> cutting_sites(const TriangleMesh& mesh, std::size_t crown_triangles, const std::vector<int>& sites,
                            const std::vector<std::pair<int, int>>& pairs) {
  std::set<int> result;
  for (const auto& [a, b] : pairs)
    for (const int t : {a, b}) {
      if (static_cast<std::size_t>(t) < crown_triangles) continue;
      for (const int v : mesh.triangles[static_cast<std::size_t>(t)]) result.insert(sites[static_cast<std::size_t>(v)]);
    }
  return result;
}

}  // namespace

void require_in_range(const RestoreOptions& options) {
  require_ranges("restoring", {{"rounds", options.rounds, OptionRange::at_least(0)}});
}

JoinedTooth restore_crown(const TriangleMesh& crown, const Joining& joining, const RestoreOptions& options) {
  require_in_range(options);
  RootPatch patch(crown, joining);
  for (int round = 0;; ++round) {
    patch.make_manifold();
    patch.bridge_to_crown();
    const TriangleMesh open = patch.joined();
    const FilledMesh filled = fill_holes(open);
    const auto cuts = options.test_cuts ? self_intersecting_triangles(filled.mesh) : std::vector<std::pair<int, int>>{};
    if (cuts.empty()) {
      JoinedTooth tooth;
      tooth.mesh = filled.mesh;
      tooth.crown_vertices = static_cast<int>(crown.vertices.size());
      tooth.crown_triangles = static_cast<int>(crown.triangles.size());
      tooth.triangles_brought_back = tooth.crown_triangles - joining.crown_triangles_direct;
      tooth.triangles_filled = static_cast<int>(filled.mesh.triangles.size() - open.triangles.size());
      tooth.holes_filled = filled.holes;
      return tooth;
    }
    if (round >= options.rounds) {
      std::set<std::int64_t> ids;
      for (const auto& [a, b] : cuts)
        for (const int t : {a, b})
          if (static_cast<std::size_t>(t) < crown.triangles.size()) ids.insert(t);
      throw NoResultError("The root could not be joined to the crown without cutting it (triangles of the crown).",
                          {ids.begin(), ids.end()}, ElementKind::triangles);
    }
    patch.remove_around(cutting_sites(filled.mesh, crown.triangles.size(), patch.joined_sites(), cuts));
  }
}

}  // namespace rhizodont
