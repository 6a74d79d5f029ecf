// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Transformer layers: Vaswani et al., Attention Is All You Need, 2017; pre-norm as in Dosovitskiy et al., 2021. Edge
// convolutions: Wang et al., Dynamic Graph CNN, 2019.
#include "networks/layers.hpp"

#include "networks/elementwise.hpp"

#include <cmath>

namespace rhizodont::networks {
namespace {

/// Raises `largest` to a row's values; what is not a number stays so.
[[gnu::target_clones("avx512f", "avx2", "default")]] void raise(float* largest, const float* row,
                                                                Eigen::Index channels) {
  for (Eigen::Index c = 0; c < channels; ++c) {
    const float raised = row[c] <= largest[c] ? largest[c] : row[c];
    largest[c] = largest[c] != largest[c] ? largest[c] : raised;
  }
}

/// result's rows first .. first + count - 1: the largest over their neighbours.
void gather_max_rows(const MatrixView& values, std::span<const std::int32_t> neighbours, Eigen::Index each,
                     Eigen::Index first, Eigen::Index count, MatrixSpan result) {
  for (Eigen::Index q = first; q < first + count; ++q) {
    const std::int32_t* index = neighbours.data() + q * each;
    result.row(q - first) = values.row(index[0]);
    for (Eigen::Index k = 1; k < each; ++k)
      raise(result.data() + (q - first) * result.outerStride(), values.data() + index[k] * values.outerStride(),
            values.cols());
  }
}

}  // namespace

Matrix linear(const Linear& layer, const MatrixView& x) {
  Matrix result(x.rows(), layer.columns());
  for_row_blocks(x.rows(), [&](Eigen::Index first, Eigen::Index count) {
    product(x.middleRows(first, count), layer, result.middleRows(first, count));
  });
  return result;
}

Matrix normalised(const Norm& norm, Matrix x) {
  for_row_blocks(x.rows(), [&](Eigen::Index first, Eigen::Index count) {
    normalise_rows(x.middleRows(first, count), norm.weight, norm.bias);
  });
  return x;
}

Matrix multilayer(const Mlp& layers, const MatrixView& x) {
  Matrix result(x.rows(), layers.back().columns());
  for_row_blocks(x.rows(), [&](Eigen::Index first, Eigen::Index count) {
    Matrix hidden = x.middleRows(first, count);
    for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
      Matrix next(count, layers[i].columns());
      product(hidden, layers[i], next);
      gelu(next);
      hidden = std::move(next);
    }
    product(hidden, layers.back(), result.middleRows(first, count));
  });
  return result;
}

Matrix activated_sum(Matrix x, const MatrixView& shared) {
  for_row_blocks(x.rows(), [&](Eigen::Index first, Eigen::Index count) {
    auto rows = x.middleRows(first, count);
    rows.rowwise() += shared.row(0);
    gelu(rows);
  });
  return x;
}

Matrix largest_of_rows(const MatrixView& values) {
  Matrix result = values.row(0);
  for (Eigen::Index r = 1; r < values.rows(); ++r)
    raise(result.data(), values.data() + r * values.outerStride(), values.cols());
  return result;
}

Matrix edge_convolution(const EdgeConvolution& layer, const MatrixView& keys, const MatrixView& queries,
                        std::span<const std::int32_t> neighbours) {
  const Matrix around = linear(layer.neighbour, keys);
  const Eigen::Index each = static_cast<Eigen::Index>(neighbours.size()) / std::max<Eigen::Index>(queries.rows(), 1);
  Matrix result(queries.rows(), layer.centre.columns());
  for_row_blocks(queries.rows(), [&](Eigen::Index first, Eigen::Index count) {
    auto rows = result.middleRows(first, count);
    Matrix largest(count, around.cols());
    gather_max_rows(around, neighbours, each, first, count, largest);
    product(queries.middleRows(first, count), layer.centre, rows);
    rows += largest;
    if (layer.norm.weight.size() > 0) normalise_rows(rows, layer.norm.weight, layer.norm.bias);
    leaky_rectify(rows);
  });
  return result;
}

Matrix attention(const Attention& layer, const MatrixView& queries, const MatrixView& memory) {
  const Eigen::Index width = queries.cols(), channels = width / layer.heads, keys = memory.rows();
  const float scale = 1 / std::sqrt(static_cast<float>(channels));
  const Matrix known = linear(layer.to_memory, memory);  // keys of all heads, then values of all heads
  std::vector<PackedMatrix> key(static_cast<std::size_t>(layer.heads)), value(key.size());
  tbb::parallel_for(std::size_t{0}, key.size(), [&](std::size_t h) {
    const Eigen::Index first = static_cast<Eigen::Index>(h) * channels;
    key[h] = PackedMatrix::of_transposed(known.middleCols(first, channels));
    value[h] = PackedMatrix(known.middleCols(width + first, channels));
  });
  Matrix result(queries.rows(), width);
  for_row_blocks(queries.rows(), [&](Eigen::Index first, Eigen::Index count) {
    Matrix asked(count, width), mixed(count, width), scores(count, keys);
    product(queries.middleRows(first, count), layer.to_query, asked);
    asked *= scale;  // of the queries, which are fewer numbers than the scores
    for (std::size_t h = 0; h < key.size(); ++h) {
      const Eigen::Index column = static_cast<Eigen::Index>(h) * channels;
      product(asked.middleCols(column, channels), key[h], scores);
      softmax_rows(scores);
      product(scores, value[h], mixed.middleCols(column, channels));
    }
    product(mixed, layer.to_output, result.middleRows(first, count));
  });
  return result;
}

}  // namespace rhizodont::networks
