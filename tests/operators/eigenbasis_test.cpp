// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/eigenbasis.hpp"

#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <numbers>

namespace rhizodont {
namespace {

using test::bowl;
using test::rectangle;

using std::numbers::pi;

TEST(Eigenbasis, SphereHasItsHarmonicsWithTheirMultiplicities) {
  const SurfaceOperators operators = surface_operators(test::sphere(5, 3.0));  // 4098 vertices
  const Eigenbasis basis = eigenbasis(operators, 36);
  Eigen::Index at = 0;
  for (int l = 0; l <= 5; ++l)
    for (int m = 0; m < 2 * l + 1; ++m, ++at)
      EXPECT_NEAR(basis.values[at], l * (l + 1), 0.01 * l * (l + 1) + 1e-9) << l;
}

TEST(Eigenbasis, RectangleWithFreeBorders) {
  const TriangleMesh mesh = rectangle(64, 40, 1.6, 1);
  const SurfaceOperators operators = surface_operators(mesh);
  const Eigenbasis basis = eigenbasis(operators, 20);
  std::vector<double> expected;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j) expected.push_back(pi * pi * (i * i / 2.56 + j * j) * operators.unit * operators.unit);
  std::sort(expected.begin(), expected.end());
  for (Eigen::Index i = 0; i < 20; ++i)
    EXPECT_NEAR(basis.values[i], expected[static_cast<std::size_t>(i)],
                0.01 * expected[static_cast<std::size_t>(i)] + 1e-9);
}

TEST(Eigenbasis, EqualsADenseSolution) {
  const SurfaceOperators operators = surface_operators(bowl(14));
  const Eigenbasis basis = eigenbasis(operators, 50);
  const Eigen::MatrixXd mass = operators.mass.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(Eigen::MatrixXd(operators.stiffness), mass);
  for (Eigen::Index i = 0; i < 50; ++i) EXPECT_NEAR(basis.values[i], dense.eigenvalues()[i], 1e-8);
  const Eigen::MatrixXd agreement = (basis.vectors.transpose() * mass * dense.eigenvectors().leftCols(50)).cwiseAbs();
  for (Eigen::Index i = 0; i < 50; ++i) EXPECT_NEAR(agreement(i, i), 1, 1e-5);
}

TEST(Eigenbasis, IsOrthonormalAndSolvesTheProblem) {
  const SurfaceOperators operators = surface_operators(bowl(30));
  const Eigenbasis basis = eigenbasis(operators, 64);
  const Eigen::MatrixXd gram = basis.vectors.transpose() * operators.mass.asDiagonal() * basis.vectors;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(64, 64)).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::MatrixXd rest =
      operators.stiffness * basis.vectors - operators.mass.asDiagonal() * basis.vectors * basis.values.asDiagonal();
  EXPECT_LT(rest.cwiseAbs().maxCoeff(), 1e-4);
  for (Eigen::Index i = 0; i < 64; ++i) {
    EXPECT_EQ(basis.vectors.col(i).cwiseAbs().maxCoeff(), basis.vectors.col(i).maxCoeff());
    if (i > 0) {
      EXPECT_LE(basis.values[i - 1], basis.values[i]);
    }
  }
}

TEST(Eigenbasis, SameBitsEachTime) {
  const SurfaceOperators operators = surface_operators(bowl(12));
  const Eigenbasis a = eigenbasis(operators, 16), b = eigenbasis(operators, 16);
  EXPECT_EQ(a.vectors, b.vectors);
  EXPECT_EQ(a.values, b.values);
}

TEST(Eigenbasis, RefusesWhatItCannotGive) {
  const SurfaceOperators operators = surface_operators(bowl(4));
  EXPECT_THROW(eigenbasis(operators, 0), UsageError);
  EXPECT_THROW(eigenbasis(operators, 20), InputError);
}

TEST(HeatKernelSignature, OfASphereIsTheSameEverywhereAndAsItsSpectrumSays) {
  const SurfaceOperators operators = surface_operators(test::sphere(4));
  const Eigenbasis basis = eigenbasis(operators, 49);
  Eigen::VectorXd times(2);
  times << 0.3, 1.0;
  const Eigen::MatrixXd signature = heat_kernel_signatures(basis, times);
  for (Eigen::Index j = 0; j < 2; ++j) {
    double expected = 0;  // addition theorem: sum over m of Y_lm^2 = (2 l + 1) / (4 pi)
    for (int l = 0; l < 7; ++l) expected += (2 * l + 1) / (4 * pi) * std::exp(-l * (l + 1) * times[j]);
    for (Eigen::Index v = 0; v < signature.rows(); ++v) EXPECT_NEAR(signature(v, j), expected, 0.02 * expected);
  }
}

TEST(HeatKernelSignature, DoesNotChangeWithRemeshing) {
  const auto at_middle = [](int size) {
    const TriangleMesh mesh = bowl(size);
    const Eigen::MatrixXd signature =
        heat_kernel_signatures(eigenbasis(surface_operators(mesh), 40), Eigen::Vector2d(0.1, 0.6));
    const auto middle = static_cast<Eigen::Index>((size + 1) * (size / 2) + size / 2);
    return Eigen::Vector4d(signature(0, 0), signature(0, 1), signature(middle, 0), signature(middle, 1));
  };
  const Eigen::Vector4d coarse = at_middle(24), fine = at_middle(48);
  for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(coarse[i], fine[i], 0.02 * fine[i]);
}

}  // namespace
}  // namespace rhizodont
