// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// N. Sharp, S. Attaiki, K. Crane, M. Ovsjanikov, "DiffusionNet: Discretization Agnostic Learning on Surfaces", ACM
//   Transactions on Graphics 41(3), 2022.
// N. Sharp, K. Crane, "A Laplacian for Nonmanifold Triangle Meshes", Computer Graphics Forum 39(5), 2020.
#include "operators/surface_operators.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "operators/intrinsic_triangulation.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <numbers>

namespace rhizodont {
namespace {

void require_one_piece(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError("The mesh has no triangles.");
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
  DisjointSets sets(mesh.vertices.size());
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      used[static_cast<std::size_t>(t[i])] = true;
      sets.join(t[i], t[(i + 1) % 3]);
    }
  }
  std::vector<std::int64_t> isolated, apart;
  const int first = sets.find(mesh.triangles[0][0]);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v])
      isolated.push_back(static_cast<std::int64_t>(v));
    else if (sets.find(static_cast<int>(v)) != first)
      apart.push_back(static_cast<std::int64_t>(v));
  }
  if (!isolated.empty())
    throw InputError("The mesh has vertices that no triangle uses.", isolated, ElementKind::vertices);
  if (!apart.empty())
    throw InputError("The mesh consists of several pieces (vertices of all but one).", apart, ElementKind::vertices);
}

/// Triangles around a vertex whose areas vanish give no normal: then that of the whole surface's mean is as good as
/// any.
Eigen::MatrixX3d normals_of(const TriangleMesh& mesh) {
  const auto at_vertices = vertex_normals(mesh);
  Eigen::MatrixX3d normals(at_vertices.size(), 3);
  for (std::size_t v = 0; v < at_vertices.size(); ++v)
    normals.row(static_cast<Eigen::Index>(v)) =
        (at_vertices[v].norm() > 0.5 ? at_vertices[v] : Eigen::Vector3d::UnitZ().eval()).transpose();
  return normals;
}

/// An axis in the plane across `normal`. Any will do.
Eigen::Vector3d tangent_of(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d axis = std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return (axis - axis.dot(normal) * normal).normalized();
}

void set_laplacian(const TriangleMesh& mesh, SurfaceOperators& operators) {
  const IntrinsicTriangulation surface = intrinsic_delaunay(mesh);
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  operators.mass = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
      operators.mass[a] += intrinsic_area(surface, t) / 3;
      if (a == b) continue;
      const double w = 0.5 * opposite_cotangent(surface, 3 * t + i);
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
    }
  }
  operators.stiffness.resize(n, n);
  operators.stiffness.setFromTriplets(entries.begin(), entries.end());
  const double area = operators.mass.sum();
  if (!(area > 0)) throw InputError("The mesh has no area.");
  operators.mass = operators.mass.cwiseMax(1e-6 * area / static_cast<double>(n));
  operators.unit = std::sqrt(operators.mass.sum() / (4 * std::numbers::pi));
  operators.mass /= operators.unit * operators.unit;
}

void set_gradients(const TriangleMesh& mesh, SurfaceOperators& operators) {
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  const EdgeTable edges = edge_table(mesh);
  for (const auto& [a, b] : edges.vertices) {
    neighbours[static_cast<std::size_t>(a)].push_back(b);
    neighbours[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<Eigen::Triplet<double>> along_x, along_y;
  for (Eigen::Index v = 0; v < n; ++v) {
    const auto& around = neighbours[static_cast<std::size_t>(v)];
    const Eigen::Vector3d x = operators.tangents.row(v), normal = operators.normals.row(v);
    const Eigen::Vector3d y = normal.cross(x);
    Eigen::Matrix2Xd flat(2, around.size());
    double squares = 0;
    for (std::size_t j = 0; j < around.size(); ++j) {
      const Eigen::Vector3d edge =
          (mesh.vertices[static_cast<std::size_t>(around[j])] - mesh.vertices[static_cast<std::size_t>(v)]) /
          operators.unit;
      flat.col(static_cast<Eigen::Index>(j)) << edge.dot(x), edge.dot(y);
      squares += edge.squaredNorm();
    }
    // Relative to the edges: an absolute term would damp the gradients of fine meshes.
    const double ridge = 1e-5 * squares / static_cast<double>(around.size()) + 1e-30;
    const Eigen::Matrix2d normal_matrix = flat * flat.transpose() + ridge * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2Xd rows = normal_matrix.inverse() * flat;
    Eigen::Vector2d own = Eigen::Vector2d::Zero();
    for (std::size_t j = 0; j < around.size(); ++j) {
      const Eigen::Vector2d entry = rows.col(static_cast<Eigen::Index>(j));
      along_x.emplace_back(v, around[j], entry.x());
      along_y.emplace_back(v, around[j], entry.y());
      own -= entry;
    }
    along_x.emplace_back(v, v, own.x());
    along_y.emplace_back(v, v, own.y());
  }
  operators.gradient_x.resize(n, n);
  operators.gradient_y.resize(n, n);
  operators.gradient_x.setFromTriplets(along_x.begin(), along_x.end());
  operators.gradient_y.setFromTriplets(along_y.begin(), along_y.end());
}

}  // namespace

SurfaceOperators surface_operators(const TriangleMesh& mesh) {
  require_one_piece(mesh);
  if (!(surface_area(mesh) > 0)) throw InputError("The mesh has no area.");
  SurfaceOperators operators;
  set_laplacian(mesh, operators);
  operators.normals = normals_of(mesh);
  operators.tangents.resize(operators.normals.rows(), 3);
  for (Eigen::Index v = 0; v < operators.normals.rows(); ++v)
    operators.tangents.row(v) = tangent_of(operators.normals.row(v)).transpose();
  set_gradients(mesh, operators);
  return operators;
}

Eigen::MatrixXd diffused(const SurfaceOperators& operators, const Eigen::MatrixXd& values, double time) {
  if (!(time >= 0)) throw UsageError("Heat diffuses over a time of at least 0.");
  Eigen::SparseMatrix<double> system = time * operators.stiffness;
  system.diagonal() += operators.mass;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  if (solver.info() != Eigen::Success) throw InputError("The mesh is too degenerate to diffuse values over it.");
  return solver.solve(operators.mass.asDiagonal() * values);
}

Eigen::MatrixX3d positions_in_units(const TriangleMesh& mesh, const SurfaceOperators& operators) {
  Eigen::MatrixX3d positions(mesh.vertices.size(), 3);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    positions.row(static_cast<Eigen::Index>(v)) = mesh.vertices[v].transpose() / operators.unit;
  return positions;
}

}  // namespace rhizodont
