// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// J. Erickson and K. Whittlesey, "Greedy optimal homotopy and homology generators", SODA 2005: of a tree of shortest
// paths
//   and a spanning tree of the dual that prefers edges with long loops, the edges in neither close the shortest
//   independent loops through the tree's root; none of them cuts the surface in two.

#include "mesh/tunnels.hpp"
#include "mesh/diagnosis.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/handles.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace rhizodont {
namespace {

struct Loop {
  std::vector<int> vertices;
  double length = std::numeric_limits<double>::infinity();
};

class LoopFinder {
 public:
  explicit LoopFinder(const TriangleMesh& mesh) : mesh_(mesh), table_(edge_table(mesh)) {
    first_.assign(mesh.vertices.size() + 1, 0);
    for (const auto& ends : table_.vertices)
      for (const int v : ends) ++first_[static_cast<std::size_t>(v) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    edges_.resize(2 * table_.size());
    std::vector<int> place(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < table_.size(); ++e) {
      const auto [a, b] = table_.vertices[e];
      length_.push_back(
          (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm());
      for (const int v : {a, b})
        edges_[static_cast<std::size_t>(place[static_cast<std::size_t>(v)]++)] = static_cast<int>(e);
    }
    find_faces_beside_edges();
  }

  /// The loops of a basis through a vertex, shortest first, without what they go there and back.
  std::vector<Loop> from(int root) const {
    const Tree tree = shortest_paths(root);
    std::vector<std::pair<double, int>> rest;  // minus the length of the detour over an edge, and the edge
    for (std::size_t e = 0; e < table_.size(); ++e) {
      const auto a = static_cast<std::size_t>(table_.vertices[e][0]),
                 b = static_cast<std::size_t>(table_.vertices[e][1]);
      if (tree.over[a] != static_cast<int>(e) && tree.over[b] != static_cast<int>(e))
        rest.emplace_back(-(tree.distance[a] + tree.distance[b] + length_[e]), static_cast<int>(e));
    }
    std::sort(rest.begin(), rest.end());
    DisjointSets faces(static_cast<std::size_t>(face_count_));
    std::vector<Loop> loops;
    for (const auto& [detour, e] : rest) {
      const auto [f, g] = faces_[static_cast<std::size_t>(e)];
      if (faces.find(f) == faces.find(g))
        loops.push_back(closed_by(e, tree));
      else
        faces.join(f, g);
    }
    std::stable_sort(loops.begin(), loops.end(), [](const Loop& x, const Loop& y) { return x.length < y.length; });
    return loops;
  }

 private:
  struct Tree {
    std::vector<double> distance;
    std::vector<int> over;  // per vertex the edge towards the root; -1 there
  };

  /// A triangle on either side of each edge, or the border loop that it lies on.
  void find_faces_beside_edges() {
    face_count_ = static_cast<int>(mesh_.triangles.size());
    std::vector<int> loop_at(mesh_.vertices.size(), -1);
    for (const auto& loop : border_loops(mesh_)) {
      for (const int v : loop) loop_at[static_cast<std::size_t>(v)] = face_count_;
      ++face_count_;
    }
    for (std::size_t e = 0; e < table_.size(); ++e) {
      const auto first = static_cast<std::size_t>(table_.first[e]);
      const int beside = half_edge_triangle(table_.half_edges[first]);
      faces_.push_back({beside, table_.triangle_count(e) == 1 ? loop_at[static_cast<std::size_t>(table_.vertices[e][0])]
                                                              : half_edge_triangle(table_.half_edges[first + 1])});
    }
  }

  int across(int edge, int v) const {
    const auto [a, b] = table_.vertices[static_cast<std::size_t>(edge)];
    return a == v ? b : a;
  }

  Tree shortest_paths(int root) const {
    Tree tree{std::vector<double>(mesh_.vertices.size(), std::numeric_limits<double>::infinity()),
              std::vector<int>(mesh_.vertices.size(), -1)};
    using Step = std::pair<double, int>;
    std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
    tree.distance[static_cast<std::size_t>(root)] = 0;
    steps.emplace(0, root);
    while (!steps.empty()) {
      const auto [distance, v] = steps.top();
      steps.pop();
      if (distance > tree.distance[static_cast<std::size_t>(v)]) continue;
      for (int k = first_[static_cast<std::size_t>(v)]; k < first_[static_cast<std::size_t>(v) + 1]; ++k) {
        const int e = edges_[static_cast<std::size_t>(k)];
        const int w = across(e, v);
        const double further = distance + length_[static_cast<std::size_t>(e)];
        if (further >= tree.distance[static_cast<std::size_t>(w)]) continue;
        tree.distance[static_cast<std::size_t>(w)] = further;
        tree.over[static_cast<std::size_t>(w)] = e;
        steps.emplace(further, w);
      }
    }
    return tree;
  }

  Loop closed_by(int edge, const Tree& tree) const {
    const auto to_root = [&](int v) {
      std::vector<int> path{v};
      for (int e = tree.over[static_cast<std::size_t>(v)]; e >= 0; e = tree.over[static_cast<std::size_t>(path.back())])
        path.push_back(across(e, path.back()));
      return path;
    };
    std::vector<int> there = to_root(table_.vertices[static_cast<std::size_t>(edge)][0]);
    std::vector<int> back = to_root(table_.vertices[static_cast<std::size_t>(edge)][1]);
    while (there.size() > 1 && back.size() > 1 && there[there.size() - 2] == back[back.size() - 2]) {
      there.pop_back();
      back.pop_back();
    }
    back.pop_back();  // the place where both meet
    Loop loop{std::move(there), 0};
    loop.vertices.insert(loop.vertices.end(), back.rbegin(), back.rend());
    for (std::size_t i = 0; i < loop.vertices.size(); ++i)
      loop.length += (mesh_.vertices[static_cast<std::size_t>(loop.vertices[i])] -
                      mesh_.vertices[static_cast<std::size_t>(loop.vertices[(i + 1) % loop.vertices.size()])])
                         .norm();
    return loop;
  }

  const TriangleMesh& mesh_;
  EdgeTable table_;
  std::vector<double> length_;             // per edge
  std::vector<int> first_, edges_;         // edges at each vertex
  std::vector<std::array<int, 2>> faces_;  // per edge
  int face_count_ = 0;
};

}  // namespace

std::vector<int> short_handle_loop(const TriangleMesh& mesh) {
  assert(mesh.triangles.empty() || diagnose(mesh).is_oriented_manifold());
  if (mesh.triangles.empty() || handle_count(mesh) <= 0) return {};
  constexpr std::size_t followed = 3;  // loops of the first basis
  constexpr std::size_t starts = 4;    // places on each
  const LoopFinder finder(mesh);
  std::vector<Loop> loops = finder.from(mesh.triangles.front()[0]);
  Loop best = loops.front();
  loops.resize(std::min(loops.size(), followed));
  const auto follow = [&](const std::vector<Loop>& followed_loops) {
    std::vector<Loop> found(starts * followed_loops.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t k) {
      const std::vector<int>& loop = followed_loops[k / starts].vertices;
      found[k] = finder.from(loop[k % starts * loop.size() / starts]).front();
    });
    for (Loop& loop : found)
      if (loop.length < best.length) best = std::move(loop);
  };
  follow(loops);
  follow({best});
  return best.vertices;
}

}  // namespace rhizodont
