// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/closest_point.hpp"

#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Point& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

struct ClosestPointIndex::Tree {
  Triangles triangles;   // those with area; the tree's primitives point into this
  std::vector<int> ids;  // of each in the mesh
  AabbTree tree;
};

ClosestPointIndex::ClosestPointIndex(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    // Without area there is no normal to project along; the neighbours cover the same points.
    if (!(triangle_area(mesh, t) > 0)) continue;
    tree_->triangles.emplace_back(to_cgal(mesh.vertices[static_cast<std::size_t>(corners[0])]),
                                  to_cgal(mesh.vertices[static_cast<std::size_t>(corners[1])]),
                                  to_cgal(mesh.vertices[static_cast<std::size_t>(corners[2])]));
    tree_->ids.push_back(static_cast<int>(t));
  }
  if (tree_->triangles.empty()) throw InputError("the mesh has no triangle with an area");
  tree_->tree.rebuild(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->tree.accelerate_distance_queries();
}
ClosestPointIndex::~ClosestPointIndex() = default;
ClosestPointIndex::ClosestPointIndex(ClosestPointIndex&&) noexcept = default;
ClosestPointIndex& ClosestPointIndex::operator=(ClosestPointIndex&&) noexcept = default;

ClosestPoint ClosestPointIndex::closest(const Point& query) const {
  const auto [found, primitive] = tree_->tree.closest_point_and_primitive(to_cgal(query));
  ClosestPoint answer;
  answer.point = Point(found.x(), found.y(), found.z());
  answer.triangle = tree_->ids[static_cast<std::size_t>(primitive - tree_->triangles.cbegin())];
  answer.distance = (answer.point - query).norm();
  return answer;
}

}  // namespace rhizodont
