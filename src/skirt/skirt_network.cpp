// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Decimation: P. Lindstrom, G. Turk, "Fast and memory efficient polygonal simplification", 1998 (CGAL).
#include "skirt/skirt_network.hpp"

#include "base/option_range.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/surface_mesh.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt_features.hpp"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Edge_length_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Midpoint_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <tbb/parallel_for.h>
#include <Eigen/Geometry>

namespace rhizodont {
namespace {

/// Values of a mesh's vertices at other points, by the nearest place of its surface.
std::vector<float> carried(const TriangleMesh& from, const std::vector<float>& values, const TriangleMesh& to) {
  const ClosestPointIndex surface(from);
  std::vector<float> result(to.vertices.size());
  tbb::parallel_for(std::size_t{0}, to.vertices.size(), [&](std::size_t v) {
    const ClosestPoint near = surface.closest(to.vertices[v]);
    const Triangle& t = from.triangles[static_cast<std::size_t>(near.triangle)];
    const auto at = [&](std::size_t i) -> const Point& { return from.vertices[static_cast<std::size_t>(t[i % 3])]; };
    double sum = 0, weight = 1e-300;
    for (std::size_t i = 0; i < 3; ++i) {
      const double share = (at(i + 1) - near.point).cross(at(i + 2) - near.point).norm();
      sum += share * static_cast<double>(values[static_cast<std::size_t>(t[i])]);
      weight += share;
    }
    result[v] = static_cast<float>(sum / weight);
  });
  return result;
}

}  // namespace

TriangleMesh decimated(const TriangleMesh& crown, std::size_t vertices) {
  if (crown.vertices.size() <= vertices || !diagnose(crown).is_oriented_manifold()) return crown;
  namespace SMS = CGAL::Surface_mesh_simplification;
  SurfaceMesh surface = to_surface_mesh(crown);
  const std::size_t edges = surface.number_of_edges() * vertices / crown.vertices.size();
  // Shortest edges first: triangles come out even, as those that the network was trained on.
  SMS::edge_collapse(surface, SMS::Count_stop_predicate<SurfaceMesh>(edges),
                     CGAL::parameters::get_cost(SMS::Edge_length_cost<SurfaceMesh>())
                         .get_placement(SMS::Midpoint_placement<SurfaceMesh>()));
  return compact(from_surface_mesh(surface)).mesh;
}

std::vector<float> skirt_confidence(const TriangleMesh& crown, const SurfaceNetwork& network,
                                    const SkirtNetworkOptions& options) {
  require_ranges("the search for a skirt", {{"most_vertices", options.most_vertices, OptionRange::at_least(200)}});
  const auto most = static_cast<std::size_t>(options.most_vertices);
  const int eigenvectors = network.shape().eigenvectors;
  if (crown.vertices.size() <= most) return network.confidence(skirt_features(crown, eigenvectors));
  const TriangleMesh copy = decimated(crown, most);
  return carried(copy, network.confidence(skirt_features(copy, eigenvectors)), crown);
}

}  // namespace rhizodont
