// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/matrix.hpp"

#include <tbb/cache_aligned_allocator.h>

#include <span>
#include <vector>

namespace rhizodont::networks {

/// The right factor of a product, laid out as the product reads it: sixteen columns after each other, each row's
/// sixteen numbers side by side, filled up with zeros.
class PackedMatrix {
 public:
  PackedMatrix() = default;
  /// Copies `right`, depth x columns; `added`: as many numbers as columns, added to each row of a product, or none.
  explicit PackedMatrix(const MatrixView& right, std::span<const float> added = {});
  /// The same of the transposed: `right` is columns x depth, as weights and keys are stored.
  static PackedMatrix of_transposed(const MatrixView& right, std::span<const float> added = {});

  Eigen::Index depth() const { return depth_; }
  Eigen::Index columns() const { return columns_; }

 private:
  friend void product(const MatrixView& left, const PackedMatrix& right, MatrixSpan result);
  PackedMatrix(Eigen::Index depth, Eigen::Index columns, std::span<const float> added);

  using Numbers = std::vector<float, tbb::cache_aligned_allocator<float>>;
  Eigen::Index depth_ = 0, columns_ = 0;
  Numbers panels_, added_;
};

/// result = left right + added, on this thread. Each number of the result is one sum in the order of the depth,
/// whatever matrix it is part of: the same row gives the same bits alone and among others. Precondition: sizes fit, and
/// `result` overlaps no factor.
void product(const MatrixView& left, const PackedMatrix& right, MatrixSpan result);

}  // namespace rhizodont::networks
