// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

namespace rhizodont::layers {

/// How matrix products are done: in float, or in bfloat16 with float accumulation (weights stay float).
enum class Precision { single, half };

/// True if the processor multiplies bfloat16 matrices at speed (AVX-512; oneDNN falls back to slow loops elsewhere).
bool half_is_fast();

/// y = x W^T + b over the last axis. The result has the precision of the product.
struct LinearImpl : torch::nn::Module {
  LinearImpl(std::int64_t in, std::int64_t out, bool with_bias = true);
  torch::Tensor forward(const torch::Tensor& x, Precision precision);

  torch::Tensor weight, bias;
};
TORCH_MODULE(Linear);

/// Layer normalisation over the last axis, always in float.
struct NormImpl : torch::nn::Module {
  explicit NormImpl(std::int64_t width);
  torch::Tensor forward(const torch::Tensor& x);

  torch::Tensor weight, bias;
};
TORCH_MODULE(Norm);

/// Linear layers with GELU between them.
struct MlpImpl : torch::nn::Module {
  explicit MlpImpl(const std::vector<std::int64_t>& widths);
  torch::Tensor forward(torch::Tensor x, Precision precision);

  std::vector<Linear> layers;
};
TORCH_MODULE(Mlp);

/// Largest value of each channel over a query's neighbours.
/// values: B x N x C; neighbours: int32, B x Q x K, indices below N. Returns float B x Q x C.
/// The gradient goes to the neighbour that had the largest value (the first of equals).
torch::Tensor gather_max(const torch::Tensor& values, const torch::Tensor& neighbours);

/// Rows of `points` (B x N x C) at `indices` (int64, B x Q): B x Q x C, differentiable in `points`.
torch::Tensor gather_rows(const torch::Tensor& points, const torch::Tensor& indices);

/// Max over neighbours j of LeakyReLU(W [f_j - g_i, g_i] + b), the edge convolution of Wang et al., Dynamic Graph CNN,
/// 2019. Since LeakyReLU is monotone and W is linear, this equals LeakyReLU(max_j (W1 f_j) + (W2 - W1) g_i + b): the
/// product is taken once per point instead of once per edge.
struct EdgeConvImpl : torch::nn::Module {
  EdgeConvImpl(std::int64_t in, std::int64_t out, bool with_norm);
  /// keys: B x N x in; queries: B x Q x in; neighbours: int32, B x Q x K into keys. Returns float B x Q x out.
  torch::Tensor forward(const torch::Tensor& keys, const torch::Tensor& queries, const torch::Tensor& neighbours,
                        Precision precision);

  Linear neighbour{nullptr}, centre{nullptr};
  Norm norm{nullptr};  // over the channels of a point; no batch statistics, so that small batches do no harm
};
TORCH_MODULE(EdgeConv);

/// Multi-head scaled dot-product attention; queries, keys and values are already normalised.
struct AttentionImpl : torch::nn::Module {
  AttentionImpl(std::int64_t width, std::int64_t heads);
  /// queries: B x Q x C, memory: B x N x C. Queries from number `isolated` on see all of the memory, those before it
  /// only the memory's first `isolated` entries; -1: all see everything.
  torch::Tensor forward(const torch::Tensor& queries, const torch::Tensor& memory, Precision precision,
                        std::int64_t isolated = -1);

  std::int64_t heads_;
  Linear to_query{nullptr}, to_memory{nullptr}, to_output{nullptr};
};
TORCH_MODULE(Attention);

}  // namespace rhizodont::layers
