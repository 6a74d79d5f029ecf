// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/surface_operators.hpp"

#include "operators/intrinsic_triangulation.hpp"
#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <numbers>

namespace rhizodont {
namespace {

using test::bowl;
using test::rectangle;

using std::numbers::pi;

double largest_difference(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  return Eigen::MatrixXd(a - b).cwiseAbs().maxCoeff();
}

TEST(SurfaceOperators, CotangentWeightsOfAHexagon) {
  // Six equilateral triangles: each inner edge weighs cot 60 = 1 / sqrt 3, each outer one half of it.
  TriangleMesh mesh{{{0, 0, 0}}, {}};
  for (int i = 0; i < 6; ++i) mesh.vertices.emplace_back(std::cos(i * pi / 3), std::sin(i * pi / 3), 0);
  for (int i = 0; i < 6; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
  const SurfaceOperators operators = surface_operators(mesh);
  const Eigen::MatrixXd l = operators.stiffness;
  EXPECT_NEAR(l(0, 0), 6 / std::sqrt(3.0), 1e-4);
  EXPECT_NEAR(l(0, 1), -1 / std::sqrt(3.0), 1e-4);
  EXPECT_NEAR(l(1, 2), -0.5 / std::sqrt(3.0), 1e-4);
  EXPECT_EQ(l(1, 4), 0);
  EXPECT_NEAR(operators.mass[0] / operators.mass[1], 3, 1e-9);
  EXPECT_NEAR(operators.mass.sum(), 4 * pi, 1e-9);
  EXPECT_NEAR(operators.unit, std::sqrt(6 * std::sqrt(3.0) / 4 / (4 * pi)), 1e-4);
}

TEST(SurfaceOperators, LinearFunctionIsHarmonicInsideAFlatMesh) {
  TriangleMesh mesh = rectangle(9, 7, 3, 2);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Point& p = mesh.vertices[v];
    if (p.x() > 0 && p.x() < 3 && p.y() > 0 && p.y() < 2)
      p += Point(0.11 * std::sin(3.0 * v), 0.09 * std::cos(7.0 * v), 0);
  }
  const SurfaceOperators operators = surface_operators(mesh);
  Eigen::VectorXd f(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    f[static_cast<Eigen::Index>(v)] = 2 * mesh.vertices[v].x() - mesh.vertices[v].y();
  const Eigen::VectorXd laplacian = operators.stiffness * f;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Point& p = mesh.vertices[v];
    if (p.x() > 0 && p.x() < 3 && p.y() > 0 && p.y() < 2) {
      EXPECT_NEAR(laplacian[static_cast<Eigen::Index>(v)], 0, 1e-9);
    }
  }
  // Energy of the gradient: |(2, -1)|^2 times the area.
  EXPECT_NEAR(f.dot(laplacian), 5 * 6, 1e-9);
}

TEST(SurfaceOperators, GradientOfALinearFunctionInSpace) {
  TriangleMesh mesh = rectangle(8, 6, 4, 3);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (Point& p : mesh.vertices) p = turn * p;
  const SurfaceOperators operators = surface_operators(mesh);
  const Eigen::MatrixX3d positions = positions_in_units(mesh, operators);
  const Eigen::Vector3d slope(0.3, -1.2, 0.7), normal = turn.col(2);
  const Eigen::Vector3d in_plane = slope - slope.dot(normal) * normal;
  const Eigen::VectorXd f = positions * slope;
  const Eigen::VectorXd gx = operators.gradient_x * f, gy = operators.gradient_y * f;
  for (Eigen::Index v = 0; v < f.size(); ++v) {
    const Eigen::Vector3d x = operators.tangents.row(v);
    const Eigen::Vector3d gradient = gx[v] * x + gy[v] * normal.cross(x);
    EXPECT_NEAR((gradient - in_plane).norm(), 0, 1e-4);
  }
}

TEST(SurfaceOperators, GradientVanishesForConstants) {
  const SurfaceOperators operators = surface_operators(test::sphere(2));
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(operators.mass.size());
  EXPECT_LT((operators.gradient_x * one).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((operators.gradient_y * one).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((operators.stiffness * one).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SurfaceOperators, SameForAnySizeAndPose) {
  const TriangleMesh mesh = bowl(9);
  TriangleMesh moved = mesh;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 2).normalized()).toRotationMatrix();
  for (Point& p : moved.vertices) p = 37 * (turn * p) + Point(5, -80, 3);
  const SurfaceOperators a = surface_operators(mesh), b = surface_operators(moved);
  EXPECT_LT(largest_difference(a.stiffness, b.stiffness), 1e-9);
  EXPECT_LT((a.mass - b.mass).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(b.unit / a.unit, 37, 1e-9);
  // The tangent planes' axes differ; lengths of gradients do not.
  Eigen::VectorXd f(a.mass.size());
  for (Eigen::Index v = 0; v < f.size(); ++v) f[v] = std::sin(0.7 * static_cast<double>(v));
  const Eigen::VectorXd ga = (a.gradient_x * f).cwiseAbs2() + (a.gradient_y * f).cwiseAbs2();
  const Eigen::VectorXd gb = (b.gradient_x * f).cwiseAbs2() + (b.gradient_y * f).cwiseAbs2();
  EXPECT_LT((ga - gb).cwiseAbs().maxCoeff(), 1e-7 * ga.maxCoeff());
}

TEST(SurfaceOperators, FollowTheOrderOfVertices) {
  const TriangleMesh mesh = bowl(6);
  const int n = static_cast<int>(mesh.vertices.size());
  const auto moved = [n](int v) { return (v * 5 + 3) % n; };  // 49 vertices: a permutation
  TriangleMesh shuffled = mesh;
  for (int v = 0; v < n; ++v)
    shuffled.vertices[static_cast<std::size_t>(moved(v))] = mesh.vertices[static_cast<std::size_t>(v)];
  for (Triangle& t : shuffled.triangles) t = {moved(t[1]), moved(t[2]), moved(t[0])};
  const Eigen::MatrixXd a = surface_operators(mesh).stiffness, b = surface_operators(shuffled).stiffness;
  for (int v = 0; v < n; ++v)
    for (int w = 0; w < n; ++w) EXPECT_NEAR(a(v, w), b(moved(v), moved(w)), 1e-9);
}

TEST(SurfaceOperators, WeightsAreNotNegativeWhateverTheTriangles) {
  TriangleMesh mesh = rectangle(12, 12, 1, 1);
  for (Point& p : mesh.vertices) p.y() *= 0.02 + 0.01 * std::sin(9 * p.x());  // needles
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));       // and one without area, at the border
  mesh.triangles.push_back({1, 0, static_cast<int>(mesh.vertices.size()) - 1});
  const SurfaceOperators operators = surface_operators(mesh);
  for (int c = 0; c < operators.stiffness.outerSize(); ++c)
    for (Eigen::SparseMatrix<double>::InnerIterator it(operators.stiffness, c); it; ++it) {
      EXPECT_TRUE(std::isfinite(it.value()));
      if (it.row() == it.col()) {
        EXPECT_GT(it.value(), 0);
      }
    }
  EXPECT_GT(operators.mass.minCoeff(), 0);
  EXPECT_TRUE(Eigen::MatrixXd(operators.gradient_x).allFinite());
}

TEST(IntrinsicDelaunay, FlipsTheLongDiagonal) {
  // A flat kite whose edge is the long diagonal: the short one, of length 1, must come out.
  const TriangleMesh kite{{{-2, 0, 0}, {2, 0, 0}, {0, 0.5, 0}, {0, -0.5, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  const IntrinsicTriangulation result = intrinsic_delaunay(kite, 0);
  EXPECT_EQ(
      std::count_if(result.lengths.begin(), result.lengths.end(), [](double l) { return std::abs(l - 1) < 1e-12; }), 2);
  EXPECT_NEAR(intrinsic_area(result, 0) + intrinsic_area(result, 1), 2, 1e-12);
  for (std::size_t h = 0; h < 6; ++h)
    if (std::abs(result.lengths[h] - 1) < 1e-12) {
      EXPECT_GT(opposite_cotangent(result, h), 0);
    }
}

TEST(IntrinsicDelaunay, KeepsAreaAndMakesAllInnerEdgesDelaunay) {
  TriangleMesh mesh = rectangle(10, 10, 5, 0.7);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    Point& p = mesh.vertices[v];
    if (p.x() > 0 && p.x() < 5 && p.y() > 0 && p.y() < 0.7)
      p += Point(0.2 * std::sin(5.0 * v), 0.03 * std::cos(11.0 * v), 0);
  }
  const IntrinsicTriangulation result = intrinsic_delaunay(mesh, 0);
  double area = 0;
  std::map<std::pair<int, int>, double> weight;
  for (std::size_t h = 0; h < result.lengths.size(); ++h) {
    if (h % 3 == 0) area += intrinsic_area(result, h / 3);
    const Triangle& t = result.triangles[h / 3];
    weight[std::minmax(t[h % 3], t[(h + 1) % 3])] += opposite_cotangent(result, h);
    // In the plane, intrinsic lengths are distances.
    const Point& a = mesh.vertices[static_cast<std::size_t>(t[h % 3])];
    const Point& b = mesh.vertices[static_cast<std::size_t>(t[(h + 1) % 3])];
    EXPECT_NEAR(result.lengths[h], (a - b).norm(), 1e-9);
  }
  EXPECT_NEAR(area, 3.5, 1e-9);
  int negative = 0;
  for (const auto& [edge, w] : weight) {
    const Point& a = mesh.vertices[static_cast<std::size_t>(edge.first)];
    const Point& b = mesh.vertices[static_cast<std::size_t>(edge.second)];
    const bool border =
        (a.x() == b.x() && (a.x() == 0 || a.x() == 5)) || (a.y() == b.y() && (a.y() == 0 || a.y() == 0.7));
    if (!border && w < -1e-9) ++negative;
  }
  EXPECT_EQ(negative, 0);
}

TEST(Diffused, KeepsHeatAndDampsAWaveAsItsEigenvalueSays) {
  const TriangleMesh mesh = rectangle(60, 12, 5, 1);
  const SurfaceOperators operators = surface_operators(mesh);
  const double length = 5 / operators.unit, lambda = std::pow(2 * pi / length, 2);
  Eigen::VectorXd wave(operators.mass.size());
  const Eigen::MatrixX3d p = positions_in_units(mesh, operators);
  for (Eigen::Index v = 0; v < wave.size(); ++v) wave[v] = 1 + std::cos(2 * pi * p(v, 0) / length);
  const double time = 0.4;
  const Eigen::VectorXd after = diffused(operators, wave, time);
  EXPECT_NEAR(operators.mass.dot(after), operators.mass.dot(wave), 1e-9);
  const Eigen::VectorXd expected = (1 + (wave.array() - 1) / (1 + time * lambda)).matrix();
  EXPECT_LT((after - expected).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT((diffused(operators, wave, 0) - wave).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_THROW(diffused(operators, wave, -1), UsageError);
}

TEST(SurfaceOperators, BadInputIsRefusedWithTheElements) {
  EXPECT_THROW(surface_operators({}), InputError);
  TriangleMesh mesh = bowl(3);
  mesh.vertices.emplace_back(0, 0, 5);
  try {
    surface_operators(mesh);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), (std::vector<std::int64_t>{16}));
  }
  const int n = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 1, 5);
  mesh.vertices.emplace_back(1, 0, 5);
  mesh.triangles.push_back({n - 1, n, n + 1});
  EXPECT_THROW(surface_operators(mesh), InputError);  // two pieces
  mesh = bowl(3);
  mesh.vertices[4].x() = std::nan("");
  EXPECT_THROW(surface_operators(mesh), InputError);
  EXPECT_THROW(surface_operators({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), InputError);  // no area
  EXPECT_THROW(surface_operators({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}), InputError);
}

}  // namespace
}  // namespace rhizodont
