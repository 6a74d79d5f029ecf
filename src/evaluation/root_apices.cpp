// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Apices from the merge tree of the height along the axis: H. Carr, J. Snoeyink, U. Axen, "Computing contour trees in
// all dimensions", 2003; prominence is the persistence of H. Edelsbrunner, D. Letscher, A. Zomorodian, "Topological
// persistence and simplification", 2002.
#include "evaluation/root_apices.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/mesh_checks.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace rhizodont {
namespace {

constexpr std::size_t most_matched_apices = 10;

/// Parts of the surface below a rising level, each known by its lowest vertex.
class RisingParts {
 public:
  explicit RisingParts(std::size_t vertices) : parent_(vertices, -1) {}

  bool holds(int vertex) const { return parent_[static_cast<std::size_t>(vertex)] >= 0; }
  void add(int vertex) { parent_[static_cast<std::size_t>(vertex)] = vertex; }
  int lowest_vertex_of_part(int vertex) {
    int root = vertex;
    while (parent_[static_cast<std::size_t>(root)] != root) root = parent_[static_cast<std::size_t>(root)];
    while (parent_[static_cast<std::size_t>(vertex)] != root)
      vertex = std::exchange(parent_[static_cast<std::size_t>(vertex)], root);
    return root;
  }
  void join(int deeper, int shallower) { parent_[static_cast<std::size_t>(shallower)] = deeper; }

 private:
  std::vector<int> parent_;
};

/// Neighbours of each vertex over edges, as pairs sorted by vertex.
std::vector<std::pair<int, int>> neighbour_pairs(const TriangleMesh& mesh) {
  const EdgeTable edges = edge_table(mesh);
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(2 * edges.size());
  for (const auto& [a, b] : edges.vertices) {
    pairs.emplace_back(a, b);
    pairs.emplace_back(b, a);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<std::size_t> most_prominent(const std::vector<RootApex>& apices) {
  std::vector<std::size_t> order(apices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return apices[a].prominence_mm > apices[b].prominence_mm; });
  order.resize(std::min(order.size(), most_matched_apices));
  std::sort(order.begin(), order.end());
  return order;
}

/// For each of the few, one of the many, all different, at least cost; `distance(i, j)` of few i and many j.
template <class Distance>
std::vector<std::size_t> assign(std::size_t few, std::size_t many, const Distance& distance) {
  // least[used]: cost of giving the first |used| of the few the set `used` of the many.
  std::vector<double> least(std::size_t{1} << many, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> last(least.size(), 0);
  least[0] = 0;
  std::size_t best = 0;
  for (std::size_t used = 0; used < least.size(); ++used) {
    const auto next = static_cast<std::size_t>(__builtin_popcountll(used));
    if (next == few && (best == 0 || least[used] < least[best])) best = used;
    if (next >= few) continue;
    for (std::size_t j = 0; j < many; ++j) {
      const std::size_t with = used | (std::size_t{1} << j);
      const double cost = least[used] + distance(next, j);
      if (with == used || cost >= least[with]) continue;
      least[with] = cost;
      last[with] = j;
    }
  }
  std::vector<std::size_t> chosen(few);
  for (std::size_t i = few; i-- > 0; best ^= std::size_t{1} << chosen[i]) chosen[i] = last[best];
  return chosen;
}

}  // namespace

std::vector<RootApex> root_apices(const TriangleMesh& tooth, const Eigen::Vector3d& axis, double level,
                                  double least_prominence_mm) {
  require_finite(tooth.vertices);
  const auto neighbours = neighbour_pairs(tooth);
  std::vector<double> height;
  for (const Point& p : tooth.vertices) height.push_back(p.dot(axis));
  const auto height_of = [&](int v) { return height[static_cast<std::size_t>(v)]; };

  std::vector<int> rising;
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    if ((i == 0 || neighbours[i].first != neighbours[i - 1].first) && height_of(neighbours[i].first) < level)
      rising.push_back(neighbours[i].first);
  std::stable_sort(rising.begin(), rising.end(), [&](int a, int b) { return height_of(a) < height_of(b); });

  RisingParts parts(tooth.vertices.size());
  std::vector<RootApex> apices;
  const auto keep = [&](int lowest, double top) {
    const double prominence = top - height_of(lowest);
    if (prominence >= least_prominence_mm)
      apices.push_back({tooth.vertices[static_cast<std::size_t>(lowest)], prominence});
  };
  for (const int v : rising) {
    parts.add(v);
    auto at = std::lower_bound(neighbours.begin(), neighbours.end(), std::pair(v, -1));
    for (; at != neighbours.end() && at->first == v; ++at) {
      if (!parts.holds(at->second)) continue;
      int deeper = parts.lowest_vertex_of_part(v), shallower = parts.lowest_vertex_of_part(at->second);
      if (deeper == shallower) continue;
      if (std::pair(height_of(deeper), deeper) > std::pair(height_of(shallower), shallower))
        std::swap(deeper, shallower);
      keep(shallower, height_of(v));
      parts.join(deeper, shallower);
    }
  }
  for (const int v : rising)
    if (parts.lowest_vertex_of_part(v) == v) keep(v, level);
  std::stable_sort(apices.begin(), apices.end(),
                   [&](const RootApex& a, const RootApex& b) { return a.point.dot(axis) < b.point.dot(axis); });
  return apices;
}

std::vector<ApexPair> match_apices(const std::vector<RootApex>& truth, const std::vector<RootApex>& predicted) {
  const std::vector<std::size_t> of_truth = most_prominent(truth), of_predicted = most_prominent(predicted);
  const auto distance = [&](std::size_t t, std::size_t p) {
    return (truth[of_truth[t]].point - predicted[of_predicted[p]].point).norm();
  };
  std::vector<ApexPair> pairs;
  const auto pair = [&](std::size_t t, std::size_t p) {
    pairs.push_back({of_truth[t], of_predicted[p], distance(t, p)});
  };
  if (of_truth.size() <= of_predicted.size()) {
    const auto chosen = assign(of_truth.size(), of_predicted.size(), distance);
    for (std::size_t t = 0; t < chosen.size(); ++t) pair(t, chosen[t]);
  } else {
    const auto chosen =
        assign(of_predicted.size(), of_truth.size(), [&](std::size_t p, std::size_t t) { return distance(t, p); });
    for (std::size_t p = 0; p < chosen.size(); ++p) pair(chosen[p], p);
  }
  std::sort(pairs.begin(), pairs.end(), [](const ApexPair& a, const ApexPair& b) { return a.truth < b.truth; });
  return pairs;
}

}  // namespace rhizodont
