// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/product.hpp"

#include <gtest/gtest.h>

namespace rhizodont::networks {
namespace {

/// Small whole numbers: their products and sums are exact in float.
Matrix whole_numbers(Eigen::Index rows, Eigen::Index columns, int seed) {
  Matrix result(rows, columns);
  for (Eigen::Index i = 0; i < result.size(); ++i)
    result.data()[i] = static_cast<float>((i * 7919 + seed * 104729) % 17 - 8);
  return result;
}

TEST(Product, OfWholeNumbersIsExactForAllSizes) {
  for (const Eigen::Index rows : {1, 5, 6, 7, 48, 50})
    for (const Eigen::Index depth : {1, 3, 16, 33})
      for (const Eigen::Index columns : {1, 3, 15, 16, 17, 40}) {
        const Matrix left = whole_numbers(rows, depth, 1), right = whole_numbers(depth, columns, 2);
        const Matrix added = whole_numbers(1, columns, 3);
        const std::vector<float> numbers(added.data(), added.data() + columns);
        Matrix expected = left.lazyProduct(right);
        expected.rowwise() += added.row(0);
        Matrix result(rows, columns);
        product(left, PackedMatrix(right, numbers), result);
        EXPECT_EQ(result, expected) << rows << " x " << depth << " x " << columns;
        result.setZero();
        product(left, PackedMatrix::of_transposed(right.transpose(), numbers), result);
        EXPECT_EQ(result, expected) << rows << " x " << depth << " x " << columns;
      }
}

TEST(Product, OfBlocksLeavesTheRestAlone) {
  const Matrix left = whole_numbers(12, 20, 4), right = whole_numbers(30, 40, 5);
  Matrix result = Matrix::Constant(14, 30, -99);
  product(left.block(2, 3, 7, 10), PackedMatrix(right.block(5, 6, 10, 19)), result.block(3, 4, 7, 19));
  Matrix expected = Matrix::Constant(14, 30, -99);
  expected.block(3, 4, 7, 19) = left.block(2, 3, 7, 10).lazyProduct(right.block(5, 6, 10, 19));
  EXPECT_EQ(result, expected);
}

TEST(Product, RowHasTheSameBitsAloneAndAmongOthers) {
  const Matrix left = Matrix::Random(50, 192), right = Matrix::Random(192, 72);
  const PackedMatrix packed(right);
  Matrix together(50, 72), alone(1, 72);
  product(left, packed, together);
  for (Eigen::Index r = 0; r < 50; ++r) {
    product(left.row(r), packed, alone);
    EXPECT_EQ(alone.row(0), together.row(r)) << r;
  }
}

}  // namespace
}  // namespace rhizodont::networks
