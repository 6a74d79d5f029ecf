// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <vector>

#include "learning/layers.hpp"
#include "networks/scan_sample.hpp"

namespace rhizodont {

/// One level of a scan as tensors, with a batch axis of one in front.
struct LevelTensors {
  torch::Tensor from;           ///< int64, 1 x n
  torch::Tensor geometry;       ///< float, 1 x n x 6: position over the level's unit, normal
  torch::Tensor neighbours;     ///< int32, 1 x n x k
  torch::Tensor below;          ///< int32, 1 x n x k
  torch::Tensor above;          ///< int64, 1 x 3 n
  torch::Tensor above_weights;  ///< float, 1 x 3 n x 1
  torch::Tensor fine_geometry;  ///< of the next finer level, in this level's unit
};

struct ScanTensors {
  torch::Tensor features;  ///< float, 1 x n x scan_feature_count
  std::vector<LevelTensors> levels;
};

ScanTensors to_tensors(const ScanPyramid& scan, const ScanShape& shape);

/// x + MLP(edges(norm(x))).
struct EdgeBlockImpl : torch::nn::Module {
  explicit EdgeBlockImpl(std::int64_t width);
  torch::Tensor forward(const torch::Tensor& x, const LevelTensors& level);

  layers::Norm norm{nullptr};
  layers::EdgeConv edges{nullptr};
  layers::Mlp mlp{nullptr};
};
TORCH_MODULE(EdgeBlock);

struct TokenBlockImpl : torch::nn::Module {
  TokenBlockImpl(std::int64_t width, std::int64_t heads);
  torch::Tensor forward(torch::Tensor x);

  layers::Norm first{nullptr}, second{nullptr};
  layers::Attention attention{nullptr};
  layers::Mlp mlp{nullptr};
};
TORCH_MODULE(TokenBlock);

struct ScanLevelModuleImpl : torch::nn::Module {
  ScanLevelModuleImpl(const ScanShape& shape, std::size_t level);

  layers::EdgeConv down{nullptr};
  std::vector<EdgeBlock> blocks;
  layers::Linear from_above{nullptr}, from_side{nullptr};
  EdgeBlock last{nullptr};
};
TORCH_MODULE(ScanLevelModule);

/// What the network says, before softmax and logistic function.
struct ScanLogits {
  torch::Tensor each;   ///< n x scan_output_count
  torch::Tensor whole;  ///< scan_summary_count
};

/// The network of networks/scan_network.hpp as it is trained; parameters bear the names that it reads.
struct ScanNetImpl : torch::nn::Module {
  explicit ScanNetImpl(const ScanShape& shape);
  ScanLogits forward(const ScanTensors& scan);

  layers::Linear first{nullptr};
  std::vector<ScanLevelModule> levels;
  std::vector<TokenBlock> attention;
  layers::Norm head_norm{nullptr};
  layers::Mlp head{nullptr}, summary{nullptr};
};
TORCH_MODULE(ScanNet);

}  // namespace rhizodont
