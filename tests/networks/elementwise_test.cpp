// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/elementwise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rhizodont::networks {
namespace {

/// -20 .. 20, in a row that is no multiple of a register.
Matrix arguments() {
  Matrix x(3, 1337);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x.data()[i] = static_cast<float>(i) * 40 / static_cast<float>(x.size() - 1) - 20;
  return x;
}

TEST(Elementwise, GeluIsWithinItsError) {
  const Matrix x = arguments();
  Matrix y = x;
  gelu(y);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double z = static_cast<double>(x.data()[i]);
    EXPECT_NEAR(static_cast<double>(y.data()[i]), z / 2 * (1 + std::erf(z / std::sqrt(2.0))), 3e-7 * (1 + std::abs(z)));
  }
}

TEST(Elementwise, TangentIsWithinItsError) {
  const Matrix x = arguments();
  Matrix y = x;
  hyperbolic_tangent(y);
  for (Eigen::Index i = 0; i < x.size(); ++i)
    EXPECT_NEAR(static_cast<double>(y.data()[i]), std::tanh(static_cast<double>(x.data()[i])), 3e-7);
}

TEST(Elementwise, RectifiersKeepWhatIsPositive) {
  Matrix x(1, 4), leaky(1, 4);
  x << -2, 0, 3, -0.5F;
  leaky = x;
  rectify(x);
  EXPECT_EQ(x, Matrix(Eigen::RowVector4f(0, 0, 3, 0)));
  leaky_rectify(leaky);
  EXPECT_TRUE(leaky.isApprox(Matrix(Eigen::RowVector4f(-0.4F, 0, 3, -0.1F))));
}

TEST(Elementwise, SoftmaxOfLogarithmsIsTheirShares) {
  Matrix x(2, 3);
  x << 0, std::log(2.0F), std::log(5.0F), 1000, 1000 + std::log(3.0F), -1000;  // no overflow, no division by zero
  softmax_rows(x);
  EXPECT_NEAR(x(0, 0), 0.125, 1e-6);
  EXPECT_NEAR(x(0, 1), 0.25, 1e-6);
  EXPECT_NEAR(x(0, 2), 0.625, 1e-6);
  EXPECT_NEAR(x(1, 0), 0.25, 1e-4);  // 1000 has few digits after the point
  EXPECT_NEAR(x(1, 1), 0.75, 1e-4);
  EXPECT_NEAR(x(1, 2), 0, 1e-30);
}

TEST(Elementwise, NormalisedRowHasTheMeanAndDeviationGiven) {
  Matrix x(2, 2), wide = Matrix::Random(1, 203) * 7;
  x << 1, 3, -5, -5;
  normalise_rows(x, Eigen::RowVector2f(2, 4), Eigen::RowVector2f(10, 20));
  EXPECT_NEAR(x(0, 0), 8, 1e-4);
  EXPECT_NEAR(x(0, 1), 24, 1e-4);
  EXPECT_EQ(x.row(1), Eigen::RowVector2f(10, 20));
  normalise_rows(wide, Eigen::RowVectorXf::Ones(203), Eigen::RowVectorXf::Zero(203));
  EXPECT_NEAR(wide.mean(), 0, 1e-6);
  EXPECT_NEAR(wide.squaredNorm() / 203, 1, 1e-4);
}

TEST(Elementwise, WhatIsNotANumberStaysSo) {
  const Matrix bad = Matrix::Constant(1, 19, std::numeric_limits<float>::quiet_NaN());
  for (void (*function)(MatrixSpan) : {gelu, hyperbolic_tangent, rectify, leaky_rectify, softmax_rows}) {
    Matrix x = bad;
    function(x);
    for (Eigen::Index i = 0; i < x.size(); ++i) EXPECT_TRUE(std::isnan(x.data()[i]));
  }
}

}  // namespace
}  // namespace rhizodont::networks
