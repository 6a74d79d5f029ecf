// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/similarity.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace rhizodont {
namespace {

Eigen::Matrix3Xd corners() {
  Eigen::Matrix3Xd points(3, 5);
  points << 0, 1, 0, 0, 2,  //
      0, 0, 2, 0, 1,        //
      0, 0, 0, 3, -1;
  return points;
}

TEST(Similarity, ThatPointsWereMovedByIsFound) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d shift(4, -7, 100);
  const Eigen::Matrix3Xd to = (1.2 * turn * corners()).colwise() + shift;
  const Similarity found = similarity_of_pairs(corners(), to, {0.5, 2});
  EXPECT_NEAR(found.scale, 1.2, 1e-12);
  EXPECT_LT((found.rotation - turn).norm(), 1e-12);
  EXPECT_LT((found.shift - shift).norm(), 1e-11);
}

TEST(Similarity, ScaleStaysInItsRangeAndTheMiddlesMeet) {
  const Eigen::Matrix3Xd to = 3 * corners();
  const Similarity found = similarity_of_pairs(corners(), to, {0.5, 2});
  EXPECT_EQ(found.scale, 2);
  const Eigen::Vector3d middle = corners().rowwise().mean();
  EXPECT_LT((found.scale * found.rotation * middle + found.shift - 3 * middle).norm(), 1e-12);
}

TEST(Similarity, OfMirroredPointsIsStillARotation) {
  Eigen::Matrix3Xd to = corners();
  to.row(0) *= -1;
  EXPECT_NEAR(similarity_of_pairs(corners(), to, {0.1, 10}).rotation.determinant(), 1, 1e-12);
}

}  // namespace
}  // namespace rhizodont
