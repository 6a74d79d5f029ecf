// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Y. Wang et al., "Dynamic Graph CNN for Learning on Point Clouds", 2019; C. Qi et al., "PointNet++: Deep Hierarchical
// Feature Learning on Point Sets in a Metric Space", 2017.
#include "learning/scan_net.hpp"

#include <string>

namespace rhizodont {
namespace {

using layers::Precision;

/// Positions begin as differences alone: where a point is in the arch it is told once, by its features.
void forget_places(layers::EdgeConv& edges, std::int64_t width) {
  torch::NoGradGuard no_gradient;
  edges->centre->weight.slice(1, width, width + 3).copy_(-edges->neighbour->weight.slice(1, width, width + 3));
}

torch::Tensor floats(const std::vector<float>& values, std::initializer_list<std::int64_t> shape) {
  return torch::from_blob(const_cast<float*>(values.data()), shape).clone();
}

torch::Tensor integers(const std::vector<std::int32_t>& values, std::initializer_list<std::int64_t> shape) {
  return torch::from_blob(const_cast<std::int32_t*>(values.data()), shape, torch::kInt).clone();
}

torch::Tensor geometry_of(const ScanLevel& level, float unit) {
  const auto n = static_cast<std::int64_t>(level.size());
  return torch::cat({floats(level.positions, {1, n, 3}) / unit, floats(level.normals, {1, n, 3})}, 2);
}

}  // namespace

ScanTensors to_tensors(const ScanPyramid& scan, const ScanShape& shape) {
  ScanTensors tensors;
  const auto finest = static_cast<std::int64_t>(scan.levels[0].size());
  tensors.features = floats(scan.features, {1, finest, scan_feature_count});
  for (std::size_t l = 0; l < ScanShape::levels; ++l) {
    const ScanLevel& level = scan.levels[l];
    const auto n = static_cast<std::int64_t>(level.size());
    LevelTensors t;
    t.from = integers(level.from, {1, n}).to(torch::kLong);
    t.geometry = geometry_of(level, scan_edge_unit(shape, l));
    t.neighbours = integers(level.neighbours, {1, n, shape.neighbours});
    if (l > 0) {
      t.below = integers(level.below, {1, n, shape.neighbours});
      t.fine_geometry = geometry_of(scan.levels[l - 1], scan_edge_unit(shape, l));
    }
    if (l + 1 < ScanShape::levels) {
      t.above = integers(level.above, {1, 3 * n}).to(torch::kLong);
      t.above_weights = floats(level.above_weights, {1, 3 * n, 1});
    }
    tensors.levels.push_back(std::move(t));
  }
  return tensors;
}

EdgeBlockImpl::EdgeBlockImpl(std::int64_t width)
    : norm(register_module("norm", layers::Norm(width))),
      edges(register_module("edges", layers::EdgeConv(width + 6, width, true))),
      mlp(register_module("mlp", layers::Mlp(std::vector<std::int64_t>{width, 2 * width, width}))) {
  forget_places(edges, width);
}

torch::Tensor EdgeBlockImpl::forward(const torch::Tensor& x, const LevelTensors& level) {
  const torch::Tensor known = torch::cat({norm->forward(x), level.geometry}, 2);
  return x + mlp->forward(edges->forward(known, known, level.neighbours, Precision::single), Precision::single);
}

TokenBlockImpl::TokenBlockImpl(std::int64_t width, std::int64_t heads)
    : first(register_module("first", layers::Norm(width))),
      second(register_module("second", layers::Norm(width))),
      attention(register_module("attention", layers::Attention(width, heads))),
      mlp(register_module("mlp", layers::Mlp(std::vector<std::int64_t>{width, 2 * width, width}))) {}

torch::Tensor TokenBlockImpl::forward(torch::Tensor x) {
  const torch::Tensor known = first->forward(x);
  x = x + attention->forward(known, known, Precision::single);
  return x + mlp->forward(second->forward(x), Precision::single);
}

ScanLevelModuleImpl::ScanLevelModuleImpl(const ScanShape& shape, std::size_t level) {
  const std::int64_t width = shape.widths[level];
  if (level > 0) {
    const std::int64_t finer = shape.widths[level - 1];
    down = register_module("down", layers::EdgeConv(finer + 6, width, true));
    forget_places(down, finer);
  }
  for (int b = 0; b < shape.blocks[level]; ++b)
    blocks.push_back(register_module("block_" + std::to_string(b), EdgeBlock(width)));
  if (level + 1 == ScanShape::levels) return;
  from_above = register_module("from_above", layers::Linear(shape.widths[level + 1], width, false));
  from_side = register_module("from_side", layers::Linear(width, width));
  last = register_module("last", EdgeBlock(width));
}

ScanNetImpl::ScanNetImpl(const ScanShape& shape) {
  check_scan_shape(shape);
  first = register_module("first", layers::Linear(scan_feature_count, shape.widths[0]));
  for (std::size_t l = 0; l < ScanShape::levels; ++l)
    levels.push_back(register_module("level_" + std::to_string(l), ScanLevelModule(shape, l)));
  const std::int64_t width = shape.widths.back(), finest = shape.widths[0];
  for (int b = 0; b < 2; ++b)
    attention.push_back(register_module("attention_" + std::to_string(b), TokenBlock(width, shape.heads)));
  head_norm = register_module("head_norm", layers::Norm(finest));
  head = register_module("head", layers::Mlp(std::vector<std::int64_t>{finest, 2 * finest, scan_output_count}));
  summary = register_module("summary", layers::Mlp(std::vector<std::int64_t>{width, width, scan_summary_count}));
}

ScanLogits ScanNetImpl::forward(const ScanTensors& scan) {
  std::vector<torch::Tensor> x;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const LevelTensors& level = scan.levels[l];
    if (l == 0) {
      x.push_back(first->forward(scan.features, Precision::single));
    } else {
      const torch::Tensor keys = torch::cat({x[l - 1], level.fine_geometry}, 2);
      x.push_back(
          levels[l]->down->forward(keys, layers::gather_rows(keys, level.from), level.below, Precision::single));
    }
    for (EdgeBlock& block : levels[l]->blocks) x[l] = block->forward(x[l], level);
  }
  for (TokenBlock& block : attention) x.back() = block->forward(x.back());
  const torch::Tensor mean = x.back().mean(1);
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    const LevelTensors& level = scan.levels[l];
    const torch::Tensor coarse = levels[l]->from_above->forward(x[l + 1], Precision::single);
    const std::int64_t n = x[l].size(1), width = x[l].size(2);
    const torch::Tensor spread =
        (layers::gather_rows(coarse, level.above) * level.above_weights).view({1, n, 3, width}).sum(2);
    x[l] = levels[l]->last->forward(levels[l]->from_side->forward(x[l], Precision::single) + spread, level);
  }
  return {head->forward(head_norm->forward(x[0]), Precision::single).squeeze(0),
          summary->forward(mean, Precision::single).squeeze(0)};
}

}  // namespace rhizodont
