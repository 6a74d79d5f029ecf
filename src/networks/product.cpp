// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tiles in registers over packed panels: K. Goto, R. van de Geijn, "Anatomy of High-Performance Matrix Multiplication",
// ACM Transactions on Mathematical Software 34(3), 2008. The matrices here are small: one level of blocks is enough.
#include "networks/product.hpp"

#include <array>

namespace rhizodont::networks {
namespace {

constexpr Eigen::Index panel_columns = 16;
constexpr Eigen::Index tile_rows =
    6;  // twelve sums, two numbers of the panel and one of the left: AVX has 16 registers
constexpr std::size_t lanes = 8;
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
using FloatsInMemory = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));

const FloatsInMemory& at(const float* values) { return *reinterpret_cast<const FloatsInMemory*>(values); }
FloatsInMemory& at(float* values) { return *reinterpret_cast<FloatsInMemory*>(values); }

/// Six rows times one panel. AVX-512 would be wider, but all processors with fused multiply-add then agree to the bit.
[[gnu::target_clones("fma", "default")]] void multiply_tile(const float* const* left, Eigen::Index depth,
                                                            const float* panel, const float* added,
                                                            float* const* result) {
  Floats first[tile_rows], second[tile_rows];
  const float* row[tile_rows];
  for (Eigen::Index r = 0; r < tile_rows; ++r) {
    first[r] = at(added);
    second[r] = at(added + lanes);
    row[r] = left[r];
  }
  for (Eigen::Index k = 0; k < depth; ++k, panel += panel_columns) {
    const Floats a = at(panel), b = at(panel + lanes);
    for (Eigen::Index r = 0; r < tile_rows; ++r) {
      const float x = row[r][k];
      first[r] += x * a;
      second[r] += x * b;
    }
  }
  for (Eigen::Index r = 0; r < tile_rows; ++r) {
    at(result[r]) = first[r];
    at(result[r] + lanes) = second[r];
  }
}

}  // namespace

PackedMatrix::PackedMatrix(Eigen::Index depth, Eigen::Index columns, std::span<const float> added)
    : depth_(depth), columns_(columns) {
  const Eigen::Index filled = (columns + panel_columns - 1) / panel_columns * panel_columns;
  panels_.assign(static_cast<std::size_t>(filled * depth), 0);
  added_.assign(static_cast<std::size_t>(filled), 0);
  std::copy(added.begin(), added.end(), added_.begin());
}

PackedMatrix::PackedMatrix(const MatrixView& right, std::span<const float> added)
    : PackedMatrix(right.rows(), right.cols(), added) {
  for (Eigen::Index first = 0; first < columns_; first += panel_columns) {
    const Eigen::Index width = std::min(panel_columns, columns_ - first);
    float* to = panels_.data() + first * depth_;
    for (Eigen::Index k = 0; k < depth_; ++k, to += panel_columns)
      std::copy_n(right.data() + k * right.outerStride() + first, width, to);
  }
}

PackedMatrix PackedMatrix::of_transposed(const MatrixView& right, std::span<const float> added) {
  PackedMatrix packed(right.cols(), right.rows(), added);
  for (Eigen::Index column = 0; column < packed.columns_; ++column) {
    const float* from = right.data() + column * right.outerStride();
    float* to = packed.panels_.data() + column / panel_columns * panel_columns * packed.depth_ + column % panel_columns;
    for (Eigen::Index k = 0; k < packed.depth_; ++k) to[k * panel_columns] = from[k];
  }
  return packed;
}

void product(const MatrixView& left, const PackedMatrix& right, MatrixSpan result) {
  std::array<const float*, tile_rows> from{};
  std::array<float*, tile_rows> to{};
  for (Eigen::Index column = 0; column < right.columns_; column += panel_columns) {
    const Eigen::Index width = std::min(panel_columns, right.columns_ - column);
    const float* panel = right.panels_.data() + column * right.depth_;
    for (Eigen::Index row = 0; row < left.rows(); row += tile_rows) {
      std::array<float, tile_rows * panel_columns> narrow;  // where the result has fewer columns than the panel
      for (Eigen::Index r = 0; r < tile_rows; ++r) {
        // Rows beyond the last one do the last one's work again.
        const Eigen::Index at_row = std::min(row + r, left.rows() - 1);
        from[static_cast<std::size_t>(r)] = left.data() + at_row * left.outerStride();
        to[static_cast<std::size_t>(r)] = width == panel_columns
                                              ? result.data() + at_row * result.outerStride() + column
                                              : narrow.data() + r * panel_columns;
      }
      multiply_tile(from.data(), right.depth_, panel, right.added_.data() + column, to.data());
      if (width == panel_columns) continue;
      for (Eigen::Index r = 0; r < std::min(tile_rows, left.rows() - row); ++r)
        std::copy_n(narrow.data() + r * panel_columns, width,
                    result.data() + (row + r) * result.outerStride() + column);
    }
  }
}

}  // namespace rhizodont::networks
