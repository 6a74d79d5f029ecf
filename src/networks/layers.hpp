// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/product.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rhizodont::networks {

// The layers as the trainer has them (learning/layers.hpp), as functions of plain matrices. None keeps state; rows are
// worked on side by side with the same result for any number of threads. Preconditions: sizes fit, values are finite.

/// y = x W^T + b. The weight is held packed, with its bias (zero where the layer has none).
using Linear = PackedMatrix;
Matrix linear(const Linear& layer, const MatrixView& x);

/// Layer normalisation over the channels.
struct Norm {
  Eigen::RowVectorXf weight, bias;
};
Matrix normalised(const Norm& norm, Matrix x);

/// Linear layers with GELU between them.
using Mlp = std::vector<Linear>;
Matrix multilayer(const Mlp& layers, const MatrixView& x);

/// GELU(x + shared), where `shared` is one row for all.
Matrix activated_sum(Matrix x, const MatrixView& shared);

/// Largest value of each channel over all rows, of which there is at least one; one row.
Matrix largest_of_rows(const MatrixView& values);

/// Edge convolution (Wang et al., Dynamic Graph CNN, 2019), one product per point instead of one per edge:
/// LeakyReLU(norm(max_j (W1 f_j) + (W2 - W1) g_i + b)).
struct EdgeConvolution {
  Linear neighbour, centre;
  Norm norm;  ///< none where its weight is empty
};
/// keys: points with their features; queries: those that get new ones, with `neighbours` among the keys, equally many.
Matrix edge_convolution(const EdgeConvolution& layer, const MatrixView& keys, const MatrixView& queries,
                        std::span<const std::int32_t> neighbours);

/// Multi-head scaled dot-product attention (Vaswani et al., Attention Is All You Need, 2017).
struct Attention {
  Eigen::Index heads = 1;  ///< divides the width
  Linear to_query, to_memory, to_output;
};
/// queries: n x width; memory: m x width, m >= 1; both normalised already. Returns n x width.
Matrix attention(const Attention& layer, const MatrixView& queries, const MatrixView& memory);

}  // namespace rhizodont::networks
