// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section 3.6: the biharmonic
// equation. M. Botsch and L. Kobbelt, "An intuitive framework for real-time freeform modeling", 2004: boundary
// conditions of higher order by fixing vertices on both sides of the band.

#include "fusion/biharmonic.hpp"

#include "mesh/geometry.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace rhizodont {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The band with the two rings of vertices around it that the equation looks at.
struct Band {
  TriangleMesh mesh;           // with numbers of its own
  std::vector<int> of_vertex;  // number in the band per vertex of the tooth, -1 outside
};

Band cut_out_band(const TriangleMesh& mesh, const std::vector<int>& free_vertices) {
  std::vector<bool> inside(mesh.vertices.size(), false);
  for (const int v : free_vertices) inside[static_cast<std::size_t>(v)] = true;
  std::vector<bool> taken(mesh.triangles.size(), false);
  for (int ring = 0; ring < 2; ++ring) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& tri = mesh.triangles[t];
      taken[t] =
          taken[t] || std::any_of(tri.begin(), tri.end(), [&](int v) { return inside[static_cast<std::size_t>(v)]; });
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (taken[t])
        for (const int v : mesh.triangles[t]) inside[static_cast<std::size_t>(v)] = true;
  }
  Band band;
  band.of_vertex.assign(mesh.vertices.size(), -1);
  // The second ring's own triangles are needed too: they make its Laplacian that of the whole mesh's one-ring.
  for (const Triangle& t : mesh.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int v) { return inside[static_cast<std::size_t>(v)]; })) continue;
    Triangle local = t;
    for (std::int32_t& v : local) {
      int& number = band.of_vertex[static_cast<std::size_t>(v)];
      if (number < 0) {
        number = static_cast<int>(band.mesh.vertices.size());
        band.mesh.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = number;
    }
    band.mesh.triangles.push_back(local);
  }
  return band;
}

/// Cotangent Laplacian, negative semi-definite, and the lumped masses. Cotangents are bounded, so that one needle
/// triangle of the crown does not outweigh all others.
struct Operators {
  SparseMatrix laplacian;
  Eigen::VectorXd mass;
};

Operators build_operators(const TriangleMesh& mesh) {
  constexpr double largest_cotangent = 20;  // an angle of 2.9 degrees
  const auto n = static_cast<Eigen::Index>(mesh.vertices.size());
  Operators result{SparseMatrix(n, n), Eigen::VectorXd::Zero(n)};
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& tri = mesh.triangles[t];
    const auto angles = triangle_angles(mesh, t);
    const double area = triangle_area(mesh, t);
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = tri[(i + 1) % 3];
      const int b = tri[(i + 2) % 3];
      const double cotangent = std::cos(angles[i]) / std::max(std::sin(angles[i]), 1e-12);
      const double w = 0.5 * std::clamp(cotangent, -largest_cotangent, largest_cotangent);
      entries.emplace_back(a, b, w);
      entries.emplace_back(b, a, w);
      entries.emplace_back(a, a, -w);
      entries.emplace_back(b, b, -w);
      result.mass[tri[i]] += area / 3;
    }
  }
  result.laplacian.setFromTriplets(entries.begin(), entries.end());
  const double floor = 1e-6 * result.mass.mean();
  result.mass = result.mass.cwiseMax(floor);
  return result;
}

/// The biharmonic equation of the free vertices.
struct FreeSystem {
  SparseMatrix matrix;
  Eigen::MatrixXd right;  // what the fixed vertices' positions ask for
  Eigen::VectorXd mass;
};

FreeSystem free_system(const TriangleMesh& mesh, const std::vector<int>& free_vertices) {
  const Band band = cut_out_band(mesh, free_vertices);
  const Operators operators = build_operators(band.mesh);
  const SparseMatrix bilaplacian =
      operators.laplacian * operators.mass.cwiseInverse().asDiagonal() * operators.laplacian;
  std::vector<int> row(band.mesh.vertices.size(), -1);
  std::vector<int> in_band;
  for (const int v : free_vertices) {
    in_band.push_back(band.of_vertex[static_cast<std::size_t>(v)]);
    row[static_cast<std::size_t>(in_band.back())] = static_cast<int>(in_band.size()) - 1;
  }
  const auto n = static_cast<Eigen::Index>(free_vertices.size());
  FreeSystem system{SparseMatrix(n, n), Eigen::MatrixXd::Zero(n, 3), Eigen::VectorXd(n)};
  std::vector<Eigen::Triplet<double>> entries;
  for (const int v : in_band) {
    const int r = row[static_cast<std::size_t>(v)];
    system.mass[r] = operators.mass[v];
    for (SparseMatrix::InnerIterator it(bilaplacian, v); it; ++it) {
      const int c = row[static_cast<std::size_t>(it.row())];
      if (c >= 0)
        entries.emplace_back(r, c, it.value());
      else
        system.right.row(r) -= it.value() * band.mesh.vertices[static_cast<std::size_t>(it.row())].transpose();
    }
  }
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

Eigen::MatrixXd solved(const SparseMatrix& matrix, const Eigen::MatrixXd& right) {
  const Eigen::SimplicialLDLT<SparseMatrix> solver(matrix);
  if (solver.info() != Eigen::Success) return {};
  Eigen::MatrixXd solution = solver.solve(right);
  return solution.allFinite() ? solution : Eigen::MatrixXd{};
}

}  // namespace

Eigen::MatrixXd biharmonic_positions(const TriangleMesh& mesh, const std::vector<int>& free_vertices) {
  const FreeSystem system = free_system(mesh, free_vertices);
  return solved(system.matrix, system.right);
}

Eigen::MatrixXd smoothest_displacements(const TriangleMesh& mesh, const std::vector<int>& free_vertices,
                                        const std::vector<std::optional<Eigen::Vector3d>>& wishes, double weight) {
  FreeSystem system = free_system(mesh, free_vertices);
  system.right.setZero();
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    if (!wishes[i]) continue;
    const auto r = static_cast<Eigen::Index>(i);
    system.matrix.coeffRef(r, r) += weight * system.mass[r];
    system.right.row(r) = weight * system.mass[r] * wishes[i]->transpose();
  }
  return solved(system.matrix, system.right);
}

}  // namespace rhizodont
