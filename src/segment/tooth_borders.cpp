// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/tooth_borders.hpp"

#include "base/disjoint_sets.hpp"
#include "base/minimum_cut.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "networks/cloud_grid.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace rhizodont {
namespace {

/// The graph of a scan's vertices, in the units of ToothBorderOptions.
struct BorderGraph {
  std::size_t labels = 0;          ///< gum (0) and teeth (1...)
  std::vector<double> costs;       ///< labels per vertex: of giving it a label
  std::vector<double> worst;       ///< per vertex: of a label that nothing speaks for
  std::vector<CutEdge> edges;      ///< cost of two labels at its ends
  std::vector<int> first, around;  ///< edges at each vertex

  double cost(std::size_t v, int label) const { return costs[v * labels + static_cast<std::size_t>(label)]; }
};

struct VertexPlaces {
  std::vector<float> at, normals;  ///< 3 per vertex, in the reading's frame
};

VertexPlaces places_of(const TriangleMesh& scan, const ScanFrame& frame) {
  VertexPlaces places;
  const std::vector<Eigen::Vector3d> normals = vertex_normals(scan);
  for (std::size_t v = 0; v < scan.vertices.size(); ++v) {
    const Eigen::Vector3f p = (frame.rotation * (scan.vertices[v] - frame.origin)).cast<float>();
    const Eigen::Vector3f n = (frame.rotation * normals[v]).cast<float>();
    places.at.insert(places.at.end(), p.begin(), p.end());
    places.normals.insert(places.normals.end(), n.begin(), n.end());
  }
  return places;
}

/// What the points around each vertex say of it: labels per vertex, sum 1.
std::vector<double> shares_of(const VertexPlaces& places, const TeethReading& reading, const ToothInstances& found) {
  constexpr int near_points = 4;
  const std::size_t labels = found.teeth.size() + 1, n = places.at.size() / 3;
  const CloudGrid grid(reading.pyramid.levels[0].positions, 1.4F);
  const std::vector<std::int32_t> near = grid.nearest(places.at, near_points);
  std::vector<double> shares(labels * n, 0);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t v) {
    const Eigen::Vector3d at(places.at[3 * v], places.at[3 * v + 1], places.at[3 * v + 2]);
    const Eigen::Vector3d normal(places.normals[3 * v], places.normals[3 * v + 1], places.normals[3 * v + 2]);
    double total = 0;
    for (std::size_t j = 0; j < near_points; ++j) {
      const auto point = static_cast<std::size_t>(near[near_points * v + j]);
      const double w =
          std::max(0.02, normal.dot(reading.normal(point))) / ((reading.place(point) - at).squaredNorm() + 0.05);
      total += w;
      double tooth = 0;
      for (std::size_t t = 0; t < found.teeth.size(); ++t) {
        shares[v * labels + t + 1] += w * found.share(point, t);
        tooth += found.share(point, t);
      }
      shares[v * labels] += w * std::max(0.0, 1 - tooth);
    }
    for (std::size_t l = 0; l < labels; ++l) shares[v * labels + l] /= total;
  });
  return shares;
}

BorderGraph graph_of(const TriangleMesh& scan, const TeethReading& reading, const ToothInstances& found,
                     const ToothBorderOptions& options) {
  const VertexPlaces places = places_of(scan, reading.frame);
  BorderGraph graph;
  graph.labels = found.teeth.size() + 1;
  graph.costs = shares_of(places, reading, found);
  const std::size_t n = scan.vertices.size();
  std::vector<double> area(n, 0);
  std::vector<Point> middles;
  for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
    const double third = triangle_area(scan, t) / 3;
    Point middle = Point::Zero();
    for (const int v : scan.triangles[t]) {
      area[static_cast<std::size_t>(v)] += third;
      middle += scan.vertices[static_cast<std::size_t>(v)] / 3;
    }
    middles.push_back(middle);
  }
  for (std::size_t v = 0; v < n; ++v) {
    graph.worst.push_back(-area[v] * std::log(options.least_share));
    for (std::size_t l = 0; l < graph.labels; ++l) {
      double& cost = graph.costs[v * graph.labels + l];
      cost = -area[v] * std::log(std::max(cost, options.least_share));
    }
  }
  const CloudGrid cloud(reading.cloud.positions, 0.7F);
  const std::vector<std::int32_t> near = cloud.nearest(places.at, 1);
  const auto hollow = [&](int v) {
    const auto i = scan_curvature_count * static_cast<std::size_t>(near[static_cast<std::size_t>(v)]);
    return static_cast<double>(std::max(reading.cloud.curvatures[i], reading.cloud.curvatures[i + 1]));
  };
  const EdgeTable table = edge_table(scan);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto [a, b] = table.vertices[e];
    const Point middle = (scan.vertices[static_cast<std::size_t>(a)] + scan.vertices[static_cast<std::size_t>(b)]) / 2;
    double length = 0;
    for (int h = table.first[e]; h < table.first[e + 1]; ++h)
      length += (middles[static_cast<std::size_t>(half_edge_triangle(table.half_edges[static_cast<std::size_t>(h)]))] -
                 middle)
                    .norm();
    const double depth = std::max(0.0, (hollow(a) + hollow(b)) / 2);
    graph.edges.push_back({a, b, options.smoothness * length * (0.05 + 0.95 * std::exp(-options.crease * depth))});
  }
  graph.first.assign(n + 1, 0);
  for (const CutEdge& e : graph.edges) {
    ++graph.first[static_cast<std::size_t>(e.a) + 1];
    ++graph.first[static_cast<std::size_t>(e.b) + 1];
  }
  for (std::size_t v = 0; v < n; ++v) graph.first[v + 1] += graph.first[v];
  graph.around.resize(2 * graph.edges.size());
  std::vector<int> next(graph.first.begin(), graph.first.end() - 1);
  for (std::size_t e = 0; e < graph.edges.size(); ++e)
    for (const int v : {graph.edges[e].a, graph.edges[e].b})
      graph.around[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<int>(e);
  return graph;
}

/// Lets one label grow where that costs less; true if it did.
bool expand(const BorderGraph& graph, int label, std::vector<int>& labels) {
  std::vector<int> node(labels.size(), -1), vertices;
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (labels[v] != label && graph.cost(v, label) < 0.999 * graph.worst[v]) {
      node[v] = static_cast<int>(vertices.size());
      vertices.push_back(static_cast<int>(v));
    }
  if (vertices.empty()) return false;
  std::vector<double> grown, stays;
  std::vector<CutEdge> edges;
  for (const int v : vertices) {
    const auto at = static_cast<std::size_t>(v);
    grown.push_back(graph.cost(at, label));
    stays.push_back(graph.cost(at, labels[at]));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto v = static_cast<std::size_t>(vertices[i]);
    for (int k = graph.first[v]; k < graph.first[v + 1]; ++k) {
      const CutEdge& edge = graph.edges[static_cast<std::size_t>(graph.around[static_cast<std::size_t>(k)])];
      const auto other = static_cast<std::size_t>(edge.a == vertices[i] ? edge.b : edge.a);
      if (node[other] < 0) {
        if (labels[other] != label) grown[i] += edge.cost;
        if (labels[other] != labels[v]) stays[i] += edge.cost;
      } else if (static_cast<std::size_t>(node[other]) > i) {
        const bool same = labels[other] == labels[v];
        const double cost = same ? edge.cost : edge.cost / 2;
        edges.push_back({static_cast<int>(i), node[other], cost});
        if (same) continue;
        stays[i] += cost;
        stays[static_cast<std::size_t>(node[other])] += cost;
      }
    }
  }
  const std::vector<bool> grows = minimum_cut(grown, stays, edges);
  bool any = false;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (grows[i]) {
      labels[static_cast<std::size_t>(vertices[i])] = label;
      any = true;
    }
  return any;
}

}  // namespace

std::vector<int> draw_borders(const TriangleMesh& scan, const TeethReading& reading, const ToothInstances& instances,
                              const ToothBorderOptions& options) {
  const BorderGraph graph = graph_of(scan, reading, instances, options);
  std::vector<int> labels(scan.vertices.size(), 0);
  for (std::size_t v = 0; v < labels.size(); ++v)
    for (int l = 1; l < static_cast<int>(graph.labels); ++l)
      if (graph.cost(v, l) < graph.cost(v, labels[v])) labels[v] = l;
  for (int round = 0; round < options.rounds; ++round) {
    bool any = false;
    for (int l = 0; l < static_cast<int>(graph.labels); ++l) any = expand(graph, l, labels) || any;
    if (!any) break;
  }
  for (int& label : labels) --label;
  return labels;
}

void keep_largest_pieces(const TriangleMesh& scan, std::vector<int>& labels) {
  DisjointSets pieces(labels.size());
  for (const Triangle& t : scan.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (labels[static_cast<std::size_t>(a)] == labels[static_cast<std::size_t>(b)]) pieces.join(a, b);
    }
  std::map<int, int> size;
  for (int v = 0; v < static_cast<int>(labels.size()); ++v) ++size[pieces.find(v)];
  std::map<int, int> largest;  // root by label
  for (const auto& [root, count] : size) {
    const auto [entry, fresh] = largest.try_emplace(labels[static_cast<std::size_t>(root)], root);
    if (!fresh && count > size.at(entry->second)) entry->second = root;
  }
  for (int v = 0; v < static_cast<int>(labels.size()); ++v) {
    int& label = labels[static_cast<std::size_t>(v)];
    if (label >= 0 && largest.at(label) != pieces.find(v)) label = -1;
  }
}

}  // namespace rhizodont
