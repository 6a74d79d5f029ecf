// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <Eigen/Core>

#include <algorithm>

namespace rhizodont::networks {

/// A point, token or vertex per row, a channel per column.
using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// Any block of rows and columns of one.
using MatrixView = Eigen::Ref<const Matrix, 0, Eigen::OuterStride<>>;
using MatrixSpan = Eigen::Ref<Matrix, 0, Eigen::OuterStride<>>;

/// Calls `work(first, count)` for rows that do not overlap, side by side. What a layer says of a row depends on that
/// row (and on whole matrices that stay as they are), never on where blocks begin: threads do not change the result.
template <typename Work>
void for_row_blocks(Eigen::Index rows, const Work& work) {
  constexpr Eigen::Index block = 48;  // what a block makes on its way stays in the second cache
  const Eigen::Index blocks = (rows + block - 1) / block;
  const auto run = [&](Eigen::Index b) { work(b * block, std::min(block, rows - b * block)); };
  if (blocks <= 1) {
    if (blocks == 1) run(0);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, blocks), [&](const tbb::blocked_range<Eigen::Index>& range) {
    for (Eigen::Index b = range.begin(); b < range.end(); ++b) run(b);
  });
}

}  // namespace rhizodont::networks
