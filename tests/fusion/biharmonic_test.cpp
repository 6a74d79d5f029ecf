// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "fusion/biharmonic.hpp"

#include "mesh/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace rhizodont {
namespace {

constexpr int size = 12;

/// The vertices of `test::grid(size)` that lie more than 1.5 mm from its border.
std::vector<int> inner_vertices(const TriangleMesh& mesh) {
  std::vector<int> inner;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Point& p = mesh.vertices[v];
    if (std::min({p.x(), size - p.x(), p.y(), size - p.y()}) > 1.5) inner.push_back(static_cast<int>(v));
  }
  return inner;
}

class SmoothestDisplacements : public testing::Test {
 protected:
  TriangleMesh mesh = test::grid(size);
  std::vector<int> free = inner_vertices(mesh);
  std::size_t middle = free.size() / 2;

  Eigen::MatrixXd found(const Eigen::Vector3d& wish, double weight) const {
    std::vector<std::optional<Eigen::Vector3d>> wishes(free.size());
    wishes[middle] = wish;
    return smoothest_displacements(mesh, free, wishes, weight);
  }
};

TEST_F(SmoothestDisplacements, AHeavyWishIsMetAndTheRestFollows) {
  const Eigen::Vector3d wish(0, 0, 0.2);
  const Eigen::MatrixXd u = found(wish, 1e9);
  ASSERT_EQ(u.rows(), static_cast<Eigen::Index>(free.size()));
  EXPECT_NEAR(u(static_cast<Eigen::Index>(middle), 2), 0.2, 1e-4);
  double sum = 0;
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    EXPECT_EQ(u(i, 0), 0);
    EXPECT_LT(u(i, 2), 0.2001);
    EXPECT_GT(u(i, 2), -0.05);
    sum += u(i, 2);
  }
  EXPECT_GT(sum, 1) << "those around come along";
  EXPECT_LT(found(wish, 1e-3)(static_cast<Eigen::Index>(middle), 2), 0.1) << "a light one hardly counts";
}

TEST_F(SmoothestDisplacements, AreLinearInTheWishesAndTurnWithThem) {
  const Eigen::MatrixXd up = found({0, 0, 0.2}, 50), aside = found({0.6, 0, 0}, 50);
  EXPECT_TRUE((3 * up.col(2)).isApprox(aside.col(0), 1e-9));
  EXPECT_TRUE(found(Eigen::Vector3d::Zero(), 50).isZero(0));
}

TEST_F(SmoothestDisplacements, HaveTheShapeOfTheGreensFunction) {
  const Eigen::MatrixXd strong = found({0, 0, 0.2}, 100), weak = found({0, 0, 0.2}, 10);
  const auto m = static_cast<Eigen::Index>(middle);
  EXPECT_GT(strong(m, 2), weak(m, 2));
  // Of one wish only the height depends on the weight.
  EXPECT_TRUE((strong / strong(m, 2)).isApprox(weak / weak(m, 2), 1e-9));
}

TEST(BiharmonicPositions, LeaveAPlaneAndFlattenABump) {
  TriangleMesh mesh = test::grid(size);
  const std::vector<int> free = inner_vertices(mesh);
  const TriangleMesh flat = mesh;
  for (const int v : free) mesh.vertices[static_cast<std::size_t>(v)].z() += 0.01 * (v % 3);
  const Eigen::MatrixXd solved = biharmonic_positions(flat, free);
  ASSERT_EQ(solved.rows(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    EXPECT_NEAR(solved(static_cast<Eigen::Index>(i), 2), flat.vertices[static_cast<std::size_t>(free[i])].z(), 1e-9);
  EXPECT_LT(biharmonic_positions(mesh, free).col(2).cwiseAbs().maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace rhizodont
