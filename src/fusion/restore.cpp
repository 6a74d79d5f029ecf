// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The dual of the restricted Voronoi diagram follows "Completing Dental Models While Preserving Crown Geometry and
// Meshing Topology", section 3.5. There the dual is the result; here it only proposes root triangles: the crown is
// taken from the input, so that it is exact whatever the dual did to it.

#include "fusion/restore.hpp"

#include "base/option_range.hpp"
#include "fusion/fill_holes.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/at.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>

namespace rhizodont {
namespace {

using HalfEdge = std::pair<int, int>;

std::array<HalfEdge, 3> half_edges(const Triangle& t) {
  return {HalfEdge{t[0], t[1]}, HalfEdge{t[1], t[2]}, HalfEdge{t[2], t[0]}};
}

/// Half-edges in ascending order, and where those of a vertex begin: counted, since a vertex has but a few.
class SortedHalfEdges {
 public:
  SortedHalfEdges() = default;
  SortedHalfEdges(std::size_t vertices, const std::vector<Triangle>& triangles)
      : all_(3 * triangles.size()), end_(vertices + 1, 0) {
    for (const Triangle& t : triangles)
      for (const HalfEdge& h : half_edges(t)) ++end_[at(h.first) + 1];
    std::partial_sum(end_.begin(), end_.end(), end_.begin());
    for (const Triangle& t : triangles)
      for (const HalfEdge& h : half_edges(t)) all_[end_[at(h.first)]++] = h;
    for (std::size_t v = 0; v < vertices; ++v) std::sort(begin_of(v), end_of(v));
  }

  const std::vector<HalfEdge>& all() const { return all_; }

  bool contains(const HalfEdge& h) const {
    return std::find(begin_of(at(h.first)), end_of(at(h.first)), h) != end_of(at(h.first));
  }

 private:
  std::size_t first_of(std::size_t vertex) const { return vertex == 0 ? 0 : end_[vertex - 1]; }
  std::vector<HalfEdge>::iterator begin_of(std::size_t v) {
    return all_.begin() + static_cast<std::ptrdiff_t>(first_of(v));
  }
  std::vector<HalfEdge>::iterator end_of(std::size_t v) { return all_.begin() + static_cast<std::ptrdiff_t>(end_[v]); }
  std::vector<HalfEdge>::const_iterator begin_of(std::size_t v) const {
    return all_.begin() + static_cast<std::ptrdiff_t>(first_of(v));
  }
  std::vector<HalfEdge>::const_iterator end_of(std::size_t v) const {
    return all_.begin() + static_cast<std::ptrdiff_t>(end_[v]);
  }

  std::vector<HalfEdge> all_;
  std::vector<std::size_t> end_;  // of the half-edges that leave each vertex
};

/// The root's triangles beside the crown, and how they are taken back until the two fit.
class RootPatch {
 public:
  RootPatch(const TriangleMesh& crown, const Joining& joining)
      : crown_(crown), sites_(joining.sites), crown_half_edges_(crown.vertices.size(), crown.triangles) {
    for (const HalfEdge& h : crown_half_edges_.all())
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

  /// True if there was a triangle to remove.
  bool remove_around(const std::set<int>& vertices) {
    if (vertices.empty()) return false;
    return std::erase_if(triangles_, [&](const Triangle& t) {
             return std::any_of(t.begin(), t.end(), [&](int v) { return vertices.contains(v); });
           }) > 0;
  }

  /// Joins a patch that does not touch the crown by two triangles between the nearest border edges of both, and returns
  /// how many triangles were added, the last ones of the patch. Throws NoResultError if the patch has no border.
  std::size_t bridge_to_crown() {
    for (const Triangle& t : triangles_)
      for (const auto& [a, b] : half_edges(t))
        if (is_of_crown({b, a})) return 0;
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
    return 2;
  }

  /// Crown and patch in one mesh: crown vertices and triangles first.
  TriangleMesh joined() const {
    TriangleMesh mesh = crown_;
    std::vector<int> number(sites_.size(), -1);
    for (Triangle t : triangles_) {
      for (std::int32_t& v : t) {
        if (v < crown_vertices()) continue;
        int& now = number[at(v)];
        if (now < 0) {
          now = static_cast<int>(mesh.vertices.size());
          mesh.vertices.push_back(sites_[at(v)]);
        }
        v = now;
      }
      mesh.triangles.push_back(t);
    }
    return mesh;
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

  /// The site behind each vertex of `joined()`.
  std::vector<int> joined_sites() const {
    std::vector<int> sites(crown_.vertices.size());
    std::iota(sites.begin(), sites.end(), 0);
    std::vector<bool> seen(sites_.size(), false);
    for (const Triangle& t : triangles_)
      for (const int v : t) {
        if (v < crown_vertices() || seen[at(v)]) continue;
        seen[at(v)] = true;
        sites.push_back(v);
      }
    return sites;
  }

 private:
  int crown_vertices() const { return static_cast<int>(crown_.vertices.size()); }

  bool is_of_crown(const HalfEdge& h) const { return h.first < crown_vertices() && crown_half_edges_.contains(h); }

  double distance(int a, int b) const {
    return (sites_[static_cast<std::size_t>(a)] - sites_[static_cast<std::size_t>(b)]).norm();
  }

  /// No edge of the triangle repeats a half-edge of the crown or lies inside the crown.
  bool fits_crown(const Triangle& t) const {
    const std::array<HalfEdge, 3> edges = half_edges(t);
    return std::none_of(edges.begin(), edges.end(), [&](const HalfEdge& h) { return is_of_crown(h); });
  }

  /// Removes triangles at half-edges that stand twice; true if any was removed.
  bool remove_crowded_edges() {
    const SortedHalfEdges sorted(sites_.size(), triangles_);
    const std::vector<HalfEdge>& all = sorted.all();
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
    const SortedHalfEdges patch(sites_.size(), triangles_);
    const auto is_open = [&](const HalfEdge& h) {
      const HalfEdge other{h.second, h.first};
      return !patch.contains(other) && !is_of_crown(other);
    };
    std::vector<HalfEdge> open;
    std::ranges::copy_if(border_half_edges_, std::back_inserter(open), is_open);
    std::ranges::copy_if(patch.all(), std::back_inserter(open), is_open);
    std::sort(open.begin(), open.end());
    return open;
  }

  /// Removes the patch around vertices where two gaps meet, or around which its triangles do not form one fan.
  bool remove_pinched_vertices() {
    std::set<int> pinched;
    const std::vector<HalfEdge> open = open_half_edges();  // in order of their starts
    for (std::size_t i = 1; i < open.size(); ++i)
      if (open[i].first == open[i - 1].first) pinched.insert(open[i].first);
    for (const int v : vertices_with_several_fans()) pinched.insert(v);
    return remove_around(pinched);
  }

  /// Vertices of the patch alone whose triangles there form more than one fan while no gap explains it.
  std::vector<int> vertices_with_several_fans() const {
    struct Turn {
      int at, from, to;  // around vertex `at`
    };
    std::vector<bool> of_patch(sites_.size(), false);
    for (const Triangle& t : triangles_)
      for (const int v : t) of_patch[at(v)] = true;
    const auto for_each_turn = [&](const auto& visit) {
      for (const std::vector<Triangle>* triangles : {&triangles_, &crown_.triangles})
        for (const Triangle& t : *triangles)
          for (std::size_t i = 0; i < 3; ++i)
            if (of_patch[at(t[i])]) visit(Turn{t[i], t[(i + 1) % 3], t[(i + 2) % 3]});
    };
    std::vector<std::size_t> next(sites_.size() + 1, 0);  // per vertex where its next turn goes
    for_each_turn([&](const Turn& turn) { ++next[at(turn.at) + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<Turn> turns(next.back());
    for_each_turn([&](const Turn& turn) { turns[next[at(turn.at)]++] = turn; });
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
  SortedHalfEdges crown_half_edges_;
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

JoinedTooth restored(const TriangleMesh& crown, const Joining& joining, const TriangleMesh& open,
                     const FilledMesh& filled) {
  assert(self_intersecting_triangles(filled.mesh).empty());
  JoinedTooth tooth;
  tooth.mesh = filled.mesh;
  tooth.crown_vertices = static_cast<int>(crown.vertices.size());
  tooth.crown_triangles = static_cast<int>(crown.triangles.size());
  tooth.triangles_brought_back = tooth.crown_triangles - joining.crown_triangles_direct;
  tooth.triangles_filled = static_cast<int>(filled.mesh.triangles.size() - open.triangles.size());
  tooth.holes_filled = filled.holes;
  return tooth;
}

[[noreturn]] void throw_cut_crown(const TriangleMesh& crown, const std::vector<std::pair<int, int>>& cuts) {
  std::set<std::int64_t> ids;
  for (const auto& [a, b] : cuts)
    for (const int t : {a, b})
      if (static_cast<std::size_t>(t) < crown.triangles.size()) ids.insert(t);
  throw NoResultError("The root could not be joined to the crown without cutting it (triangles of the crown).",
                      {ids.begin(), ids.end()}, ElementKind::triangles);
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
    const std::size_t bridging = patch.bridge_to_crown();
    const TriangleMesh open = patch.joined();
    // After the first round what is left of the patch has been tested, and all that cut anything was taken away.
    const std::size_t clear = round == 0 ? crown.triangles.size() : open.triangles.size() - bridging;
    FilledMesh filled = fill_holes(open);
    std::vector<std::pair<int, int>> cuts = self_intersecting_triangles(filled.mesh, clear);
    if (cuts.empty()) return restored(crown, joining, open, filled);
    if (round < options.rounds &&
        patch.remove_around(cutting_sites(filled.mesh, crown.triangles.size(), patch.joined_sites(), cuts)))
      continue;
    filled = fill_holes_clear(open);
    cuts = self_intersecting_triangles(filled.mesh, clear);
    if (!cuts.empty()) throw_cut_crown(crown, cuts);
    return restored(crown, joining, open, filled);
  }
}

}  // namespace rhizodont
