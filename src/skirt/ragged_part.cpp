// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// M. Attene, M. Campen and L. Kobbelt, "Polygon mesh repairing: an application perspective", ACM Computing Surveys
// 45(2), 2013: the defects. Handles are found by letting the surface grow from its inside towards the border: genus
// never falls as a surface grows, so that the vertex that closes a handle is found by bisection.
#include "skirt/ragged_part.hpp"
#include "mesh/mesh_checks.hpp"

#include "base/disjoint_sets.hpp"
#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/at.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/edge_distance.hpp"
#include "mesh/geometry.hpp"
#include "mesh/handles.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

namespace rhizodont {
namespace {

bool runs_the_same_way(const TriangleMesh& mesh, int g, int h) {
  return half_edge_from(mesh, g) == half_edge_from(mesh, h);
}

/// Edges with more than two triangles, or two that run the same way: no oriented surface.
std::vector<bool> unsound_edges(const TriangleMesh& mesh, const EdgeTable& edges) {
  std::vector<bool> unsound;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int count = edges.triangle_count(e);
    const auto first = at(edges.first[e]);
    unsound.push_back(count > 2 ||
                      (count == 2 && runs_the_same_way(mesh, edges.half_edges[first], edges.half_edges[first + 1])));
  }
  return unsound;
}

/// The triangles of `mask` in the piece, joined over sound edges, that has the largest area.
std::vector<bool> largest_piece(const TriangleMesh& mesh, const EdgeTable& edges, const std::vector<bool>& mask) {
  DisjointSets sets(mesh.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    int other = -1;
    for (int i = edges.first[e]; i < edges.first[e + 1]; ++i) {
      const int h = edges.half_edges[at(i)];
      if (!mask[at(h / 3)]) continue;
      if (other >= 0 && !runs_the_same_way(mesh, other, h)) sets.join(other / 3, h / 3);
      other = h;
    }
  }
  std::vector<double> area(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < area.size(); ++t)
    if (mask[t]) area[at(sets.find(static_cast<int>(t)))] += triangle_area(mesh, t);
  const auto largest = static_cast<int>(std::max_element(area.begin(), area.end()) - area.begin());
  std::vector<bool> piece;
  for (std::size_t t = 0; t < area.size(); ++t)
    piece.push_back(mask[t] && sets.find(static_cast<int>(t)) == sets.find(largest));
  return piece;
}

/// An opened crown from which the vertices of its ragged part's defects are dropped.
class RaggedCrown {
 public:
  RaggedCrown(const TriangleMesh& crown, const RaggedPartOptions& options)
      : crown_(crown), edges_(edge_table(crown)), gone_(crown.vertices.size(), false) {
    const std::vector<BorderPiece> border = border_pieces(crown);
    depth_ = distances_along_edges(crown, border.empty() ? std::vector<int>{} : border[base_piece(border)].vertices,
                                   options.depth);
  }

  /// Drops vertices of defects of the first kind that has some; false if there is nothing that can be dropped.
  bool drop_some() { return drop_at_unsound_edges() || drop_touching_vertices() || open_handles() || drop_at_cuts(); }

  std::vector<bool> kept_triangles() const {
    std::vector<bool> kept;
    for (const Triangle& t : crown_.triangles)
      kept.push_back(std::none_of(t.begin(), t.end(), [&](int v) { return gone_[at(v)]; }));
    return kept;
  }

 private:
  bool is_ragged(int v) const { return std::isfinite(depth_[at(v)]); }

  /// Drops the vertex of these that is nearest to the border, unless one is gone already or all are too far from it.
  bool drop_outermost(const std::vector<int>& vertices) {
    int outermost = -1;
    for (const int v : vertices) {
      if (gone_[at(v)]) return false;
      if (is_ragged(v) && (outermost < 0 || depth_[at(v)] < depth_[at(outermost)])) outermost = v;
    }
    if (outermost < 0) return false;
    gone_[at(outermost)] = true;
    return true;
  }

  bool drop_at_unsound_edges() {
    const std::vector<bool> kept = kept_triangles();
    bool any = false;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      std::vector<int> around;
      int count = 0, before = -1;
      bool same_way = false;
      for (int i = edges_.first[e]; i < edges_.first[e + 1]; ++i) {
        const int h = edges_.half_edges[at(i)];
        if (!kept[at(h / 3)]) continue;
        ++count;
        same_way = same_way || (before >= 0 && runs_the_same_way(crown_, before, h));
        before = h;
        for (const int v : crown_.triangles[at(h / 3)]) around.push_back(v);
      }
      if (count > 2 || same_way) any = drop_outermost(around) || any;
    }
    return any;
  }

  bool drop_touching_vertices() {
    const Submesh part = submesh(crown_, kept_triangles());
    bool any = false;
    for (const int v : diagnose(part.mesh).non_manifold_vertices)
      any = drop_outermost({part.old_vertices[at(v)]}) || any;
    return any;
  }

  bool open_handles() {
    std::vector<int> order(crown_.vertices.size()), rank(crown_.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int v, int w) { return depth_[at(v)] > depth_[at(w)]; });
    for (std::size_t i = 0; i < order.size(); ++i) rank[at(order[i])] = static_cast<int>(i);
    const auto handles_of_first = [&](int count) {
      std::vector<bool> mask;
      for (const Triangle& t : crown_.triangles)
        mask.push_back(std::all_of(t.begin(), t.end(), [&](int v) { return rank[at(v)] < count && !gone_[at(v)]; }));
      return handle_count(crown_, edges_, mask);
    };
    const int all = static_cast<int>(order.size());
    int low =
        static_cast<int>(std::find_if(order.begin(), order.end(), [&](int v) { return is_ragged(v); }) - order.begin());
    const int inside = handles_of_first(low);
    bool any = false;
    while (handles_of_first(all) > inside) {
      for (int high = all; low + 1 < high;) {
        const int middle = (low + high) / 2;
        (handles_of_first(middle) > inside ? high : low) = middle;
      }
      gone_[at(order[at(low)])] = any = true;  // with this vertex there is one more
      ++low;
    }
    return any;
  }

  bool drop_at_cuts() {
    const Submesh part = submesh(crown_, kept_triangles());
    bool any = false;
    for (const auto& [a, b] : self_intersecting_triangles(part.mesh)) {
      std::vector<int> corners;
      for (const int t : {a, b})
        for (const int v : part.mesh.triangles[at(t)]) corners.push_back(part.old_vertices[at(v)]);
      any = drop_outermost(corners) || any;
    }
    return any;
  }

  const TriangleMesh& crown_;
  EdgeTable edges_;
  std::vector<double> depth_;  // mm from the base's border along edges, infinite on the tooth's own surface
  std::vector<bool> gone_;     // per vertex
};

void require_in_range(const RaggedPartOptions& options) {
  require_ranges("a ragged part", {{"depth", options.depth, OptionRange::at_least(0)},
                                   {"rounds", options.rounds, OptionRange::at_least(1)},
                                   {"slit", options.slit, share_range}});
}

}  // namespace

std::vector<bool> triangles_without_slits(const TriangleMesh& open_crown, const RaggedPartOptions& options) {
  require_in_range(options);
  const std::vector<BorderPiece> pieces = border_pieces(open_crown);
  if (pieces.empty()) return std::vector<bool>(open_crown.triangles.size(), true);
  const std::vector<double> depth =
      distances_along_edges(open_crown, pieces[base_piece(pieces)].vertices, options.depth);
  std::vector<int> border;
  std::vector<Point> places;
  std::vector<std::array<int, 2>> beside(open_crown.vertices.size(), {-1, -1});  // before and after on the border
  for (const BorderPiece& piece : pieces) {
    for (const auto& [a, b] : piece.half_edges) {
      beside[at(a)][1] = b;
      beside[at(b)][0] = a;
    }
    for (const int v : piece.vertices) {
      border.push_back(v);
      places.push_back(open_crown.vertices[at(v)]);
    }
  }
  const double edge = mean_edge_length(open_crown);
  // Along the border edges may be as short as they like; a slit goes there and back.
  const auto along_border = [&](int v) {
    std::vector<int> passed{v};
    for (const std::size_t way : {std::size_t{0}, std::size_t{1}}) {
      double length = 0;
      for (int w = v; length < 1.5 * edge;) {
        const int next = beside[at(w)][way];
        if (next < 0 || next == v) break;
        length += (open_crown.vertices[at(next)] - open_crown.vertices[at(w)]).norm();
        if (length < 1.5 * edge) passed.push_back(next);
        w = next;
      }
    }
    return passed;
  };
  const NearestVertexIndex index(places);
  std::vector<bool> gone(open_crown.vertices.size(), false);
  for (const int v : border) {
    if (!std::isfinite(depth[at(v)])) continue;
    const auto near = index.within(open_crown.vertices[at(v)], options.slit * edge);
    if (near.size() < 2) continue;
    const std::vector<int> passed = along_border(v);
    for (const NearVertex& n : near)
      if (std::find(passed.begin(), passed.end(), border[at(n.index)]) == passed.end()) gone[at(v)] = true;
  }
  std::vector<bool> kept;
  for (const Triangle& t : open_crown.triangles)
    kept.push_back(std::none_of(t.begin(), t.end(), [&](int v) { return gone[at(v)]; }));
  return kept;
}

std::vector<bool> sound_triangles(const TriangleMesh& crown) {
  assert(has_valid_indices(crown) && is_finite(crown.vertices));
  std::vector<bool> sound(crown.triangles.size(), true);
  for (const int t : diagnose(crown).duplicate_triangles) sound[at(t)] = false;
  for (;;) {
    // Once all at an edge are gone, those that are left at others may be a surface: begin with the crowded ones.
    Submesh part = submesh(crown, sound);
    const EdgeTable edges = edge_table(part.mesh);
    std::vector<bool> mask(part.mesh.triangles.size(), true);
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (edges.triangle_count(e) > 2)
        for (int i = edges.first[e]; i < edges.first[e + 1]; ++i) mask[at(edges.half_edges[at(i)] / 3)] = false;
    mask = largest_piece(part.mesh, edges, mask);
    // A piece in which some triangle is turned against another is one-sided: cut it there.
    const std::vector<bool> unsound = unsound_edges(part.mesh, edges);
    bool one_sided = false;
    std::vector<bool> next = mask;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const int first = edges.half_edges[at(edges.first[e])] / 3;
      if (!unsound[e] || edges.triangle_count(e) > 2) continue;
      const int second = edges.half_edges[at(edges.first[e] + 1)] / 3;
      if (!mask[at(first)] || !mask[at(second)]) continue;
      next[at(first)] = next[at(second)] = false;
      one_sided = true;
    }
    for (std::size_t t = 0; t < next.size(); ++t) sound[at(part.old_triangles[t])] = next[t];
    if (!one_sided) return sound;
  }
}

std::vector<bool> triangles_without_ragged_defects(const TriangleMesh& open_crown, const RaggedPartOptions& options) {
  require_in_range(options);
  RaggedCrown crown(open_crown, options);
  for (int round = 0; round < options.rounds && crown.drop_some(); ++round) {
  }
  return crown.kept_triangles();
}

}  // namespace rhizodont
