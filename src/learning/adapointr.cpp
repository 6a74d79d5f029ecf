// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Yu X., Rao Y., Wang Z., Lu J., Zhou J.: AdaPoinTr: Diverse Point Cloud Completion with Adaptive Geometry-Aware
// Transformers, IEEE TPAMI 2023; used for teeth by Completing Dental Models While Preserving Crown Geometry and Meshing
// Topology, section 3.3. Tancik M. et al.: Fourier Features Let Networks Learn High Frequency Functions in Low
// Dimensional Domains, NeurIPS 2020.
#include "learning/adapointr.hpp"

#include <ATen/Parallel.h>

#include <numeric>

#include "learning/points_of.hpp"
#include "networks/neighbours.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using layers::Precision;

constexpr std::int64_t group_neighbours = 16;
constexpr std::int64_t token_neighbours = 8;
constexpr std::int64_t octaves = 5;
constexpr std::int64_t position_features = 3 + 6 * octaves;

/// x, y, z and sines and cosines with wavelengths of 75, 38, 19, 9 and 5 mm (unit 12 mm).
torch::Tensor fourier_features(const torch::Tensor& points) {
  const torch::Tensor frequencies = torch::pow(2.0, torch::arange(octaves, torch::kFloat));
  const torch::Tensor phases = (points.unsqueeze(-1) * frequencies).flatten(-2);
  return torch::cat({points, torch::sin(phases), torch::cos(phases)}, -1);
}

/// int32 B x queries x k: neighbours of each crown's queries among its keys (both contiguous float B x n x 3).
torch::Tensor batch_neighbours(const torch::Tensor& queries, const torch::Tensor& keys, std::int64_t k) {
  const std::int64_t batch = queries.size(0), stride = queries.size(1) * k;
  torch::Tensor result = torch::empty({batch, queries.size(1), k}, torch::kInt);
  std::int32_t* out = result.data_ptr<std::int32_t>();
  at::parallel_for(0, batch, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t b = begin; b < end; ++b) {
      const auto found = nearest_keys(points_of(queries, b), points_of(keys, b), static_cast<int>(k));
      std::copy(found.begin(), found.end(), out + b * stride);
    }
  });
  return result;
}

/// Neighbours of the main queries among themselves, of the denoising ones among all; all of them among the centres.
QueryNeighbours query_neighbours(const torch::Tensor& starts, std::int64_t main, const torch::Tensor& centres) {
  torch::NoGradGuard no_gradient;
  const torch::Tensor all = starts.detach().contiguous();
  const torch::Tensor first = all.narrow(1, 0, main).contiguous();
  QueryNeighbours neighbours;
  neighbours.self = batch_neighbours(first, first, token_neighbours);
  if (main < all.size(1)) {
    const torch::Tensor rest = all.narrow(1, main, all.size(1) - main).contiguous();
    neighbours.self = torch::cat({neighbours.self, batch_neighbours(rest, all, token_neighbours)}, 1);
  }
  neighbours.cross = batch_neighbours(all, centres, token_neighbours);
  return neighbours;
}

torch::Tensor largest(const torch::Tensor& x) { return std::get<0>(x.to(torch::kFloat).max(1)); }

}  // namespace

CrownBatch make_crown_batch(const CompletionShape& shape, const std::vector<std::vector<float>>& crowns,
                            const std::vector<std::int64_t>& types, const std::vector<float>& form_axes) {
  const auto batch = static_cast<std::int64_t>(crowns.size());
  CrownBatch result;
  result.points = torch::empty({batch, shape.input_points, 3});
  float* out = result.points.data_ptr<float>();
  at::parallel_for(0, batch, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t b = begin; b < end; ++b) {
      const std::vector<float>& crown = crowns[static_cast<std::size_t>(b)];
      float* to = out + b * shape.input_points * 3;
      for (const std::int32_t i : farthest_point_order(crown, shape.input_points))
        to = std::copy_n(crown.data() + 3 * static_cast<std::size_t>(i), 3, to);
    }
  });
  result.types = torch::tensor(types, torch::kLong);
  result.form_axes = torch::tensor(form_axes, torch::kFloat).view({batch, 2});
  const torch::Tensor first = result.points.narrow(1, 0, shape.centres_1).contiguous();
  const torch::Tensor second = result.points.narrow(1, 0, shape.centres_2).contiguous();
  result.near_input = batch_neighbours(result.points, result.points, group_neighbours);
  result.near_1_of_input = result.near_input.narrow(1, 0, shape.centres_1).contiguous();
  result.near_1 = batch_neighbours(first, first, group_neighbours);
  result.near_2_of_1 = result.near_1.narrow(1, 0, shape.centres_2).contiguous();
  result.near_2 = batch_neighbours(second, second, token_neighbours);
  return result;
}

EncoderBlockImpl::EncoderBlockImpl(const CompletionShape& shape, bool with_graph)
    : norm_attention(register_module("norm_attention", layers::Norm(shape.width))),
      norm_mlp(register_module("norm_mlp", layers::Norm(shape.width))),
      attention(register_module("attention", layers::Attention(shape.width, shape.heads))),
      mlp(register_module(
          "mlp", layers::Mlp(std::vector<std::int64_t>{shape.width, 2L * shape.width, std::int64_t{shape.width}}))) {
  if (!with_graph) return;
  graph = register_module("graph", layers::EdgeConv(shape.width, shape.width, false));
  merge = register_module("merge", layers::Linear(2L * shape.width, shape.width));
}

torch::Tensor EncoderBlockImpl::forward(torch::Tensor x, const torch::Tensor& neighbours, Precision precision) {
  const torch::Tensor n = norm_attention->forward(x);
  torch::Tensor mixed = attention->forward(n, n, precision);
  if (graph) {
    const torch::Tensor local = graph->forward(n, n, neighbours, precision);
    mixed = merge->forward(torch::cat({mixed.to(torch::kFloat), local}, -1), precision);
  }
  x = x + mixed;
  return x + mlp->forward(norm_mlp->forward(x), precision);
}

DecoderBlockImpl::DecoderBlockImpl(const CompletionShape& shape, bool with_graph)
    : norm_self(register_module("norm_self", layers::Norm(shape.width))),
      norm_query(register_module("norm_query", layers::Norm(shape.width))),
      norm_memory(register_module("norm_memory", layers::Norm(shape.width))),
      norm_mlp(register_module("norm_mlp", layers::Norm(shape.width))),
      self_attention(register_module("self_attention", layers::Attention(shape.width, shape.heads))),
      cross_attention(register_module("cross_attention", layers::Attention(shape.width, shape.heads))),
      mlp(register_module(
          "mlp", layers::Mlp(std::vector<std::int64_t>{shape.width, 2L * shape.width, std::int64_t{shape.width}}))) {
  if (!with_graph) return;
  self_graph = register_module("self_graph", layers::EdgeConv(shape.width, shape.width, false));
  cross_graph = register_module("cross_graph", layers::EdgeConv(shape.width, shape.width, false));
  merge_self = register_module("merge_self", layers::Linear(2L * shape.width, shape.width));
  merge_cross = register_module("merge_cross", layers::Linear(2L * shape.width, shape.width));
}

torch::Tensor DecoderBlockImpl::forward(torch::Tensor q, const torch::Tensor& memory, const QueryNeighbours& neighbours,
                                        std::int64_t isolated, Precision precision) {
  const torch::Tensor n = norm_self->forward(q);
  torch::Tensor mixed = self_attention->forward(n, n, precision, isolated);
  if (self_graph) {
    const torch::Tensor local = self_graph->forward(n, n, neighbours.self, precision);
    mixed = merge_self->forward(torch::cat({mixed.to(torch::kFloat), local}, -1), precision);
  }
  q = q + mixed;
  const torch::Tensor asking = norm_query->forward(q), known = norm_memory->forward(memory);
  mixed = cross_attention->forward(asking, known, precision);
  if (cross_graph) {
    const torch::Tensor local = cross_graph->forward(known, asking, neighbours.cross, precision);
    mixed = merge_cross->forward(torch::cat({mixed.to(torch::kFloat), local}, -1), precision);
  }
  q = q + mixed;
  return q + mlp->forward(norm_mlp->forward(q), precision);
}

AdaPoinTrImpl::AdaPoinTrImpl(const CompletionShape& given) : shape(given) {
  using Widths = std::vector<std::int64_t>;
  const std::int64_t width = shape.width, wide = shape.global_width, types = tooth_types + 1;
  const std::int64_t outputs = 6L * shape.patch_points;
  patches = register_parameter("patches", torch::randn({types, shape.queries, shape.patch_points, 3}) * 0.5);
  patch_normals = register_parameter("patch_normals", torch::randn({types, shape.queries, shape.patch_points, 3}));
  type_embedding = register_parameter("type_embedding", torch::randn({types, width}) * 0.02);
  input_lift = register_module("input_lift", layers::Linear(3, 16));
  edge_1 = register_module("edge_1", layers::EdgeConv(16, 32, true));
  edge_2 = register_module("edge_2", layers::EdgeConv(32, 64, true));
  edge_3 = register_module("edge_3", layers::EdgeConv(64, 64, true));
  edge_4 = register_module("edge_4", layers::EdgeConv(64, 128, true));
  input_projection = register_module("input_projection", layers::Mlp(Widths{128, width, width}));
  position = register_module("position", layers::Mlp(Widths{position_features, 128, width}));
  form_axis = register_module("form_axis", layers::Mlp(Widths{2, 64, width}));
  encoder = register_module("encoder", torch::nn::ModuleList());
  for (int i = 0; i < shape.encoder_depth; ++i) encoder->push_back(EncoderBlock(shape, i == 0));
  norm_memory = register_module("norm_memory", layers::Norm(width));
  to_global = register_module("to_global", layers::Mlp(Widths{width, wide, wide}));
  coarse_global = register_module("coarse_global", layers::Linear(wide, wide));
  coarse_anchor = register_module("coarse_anchor", layers::Linear(position_features, wide, false));
  coarse_out = register_module("coarse_out", layers::Mlp(Widths{wide, width, 3}));
  query_global = register_module("query_global", layers::Linear(wide, wide));
  query_position = register_module("query_position", layers::Linear(position_features, wide, false));
  query_identity = register_module("query_identity", layers::Linear(position_features + 3, wide, false));
  query_out = register_module("query_out", layers::Mlp(Widths{wide, width}));
  decoder = register_module("decoder", torch::nn::ModuleList());
  for (int i = 0; i < shape.decoder_depth; ++i) decoder->push_back(DecoderBlock(shape, i == 0));
  norm_queries = register_module("norm_queries", layers::Norm(width));
  head_global = register_module("head_global", layers::Mlp(Widths{width, wide, wide}));
  head_global_in = register_module("head_global_in", layers::Linear(wide, width));
  head_query_in = register_module("head_query_in", layers::Linear(width, width, false));
  head_position_in = register_module("head_position_in", layers::Linear(position_features, width, false));
  head_hidden = register_module("head_hidden", layers::Linear(width, wide));
  head_summary = register_module("head_summary", layers::Linear(width, wide, false));
  head_out = register_module("head_out", layers::Linear(wide, outputs));
  head_spread = register_module("head_spread", layers::Linear(wide, shape.patch_points));
  torch::NoGradGuard no_gradient;
  for (layers::Linear* linear :
       {&input_lift, &position->layers.front(), &coarse_anchor, &query_position, &query_identity, &head_position_in})
    (*linear)->weight.normal_(0, 0.3);              // few inputs, and all depends on them
  form_axis->layers.front()->weight.normal_(0, 5);  // a tenth of a radian is much
  head_out->weight.mul_(0.1);                       // patches start as they are on the type's tooth
}

void AdaPoinTrImpl::set_patches(int type, std::span<const float> points, std::span<const float> normals) {
  const std::int64_t each = std::int64_t{3} * shape.queries * shape.patch_points;
  if (type < 0 || type > unknown_type || points.size() != static_cast<std::size_t>(each) ||
      normals.size() != points.size())
    throw UsageError("The patches do not fit the network.");
  torch::NoGradGuard no_gradient;
  std::copy(points.begin(), points.end(), patches.data_ptr<float>() + type * each);
  std::copy(normals.begin(), normals.end(), patch_normals.data_ptr<float>() + type * each);
}

/// The queries before they are bent to a crown.
Starts AdaPoinTrImpl::patch_starts(const torch::Tensor& types) const {
  const torch::Tensor points = patches.index_select(0, types), normals = patch_normals.index_select(0, types);
  Starts starts;
  starts.points = points.mean(2);
  starts.offsets = (points - starts.points.unsqueeze(2)).flatten(2);
  starts.normals = normals.flatten(2);
  starts.identity = torch::cat({fourier_features(starts.points), normals.mean(2)}, -1);
  return starts;
}

torch::Tensor AdaPoinTrImpl::encode(const CrownBatch& crowns, Precision precision) {
  const torch::Tensor lifted = input_lift->forward(crowns.points, precision);
  const torch::Tensor f1 = edge_1->forward(lifted, lifted, crowns.near_input, precision);
  const torch::Tensor f2 = edge_2->forward(f1, f1.narrow(1, 0, shape.centres_1), crowns.near_1_of_input, precision);
  const torch::Tensor f3 = edge_3->forward(f2, f2, crowns.near_1, precision);
  const torch::Tensor f4 = edge_4->forward(f3, f3.narrow(1, 0, shape.centres_2), crowns.near_2_of_1, precision);
  const torch::Tensor centres = crowns.points.narrow(1, 0, shape.centres_2);
  torch::Tensor x =
      input_projection->forward(f4, precision).to(torch::kFloat) +
      position->forward(fourier_features(centres), precision) +
      (type_embedding.index_select(0, crowns.types) + form_axis->forward(crowns.form_axes, precision).to(torch::kFloat))
          .unsqueeze(1);
  for (const auto& block : *encoder) x = block->as<EncoderBlock>()->forward(x, crowns.near_2, precision);
  return norm_memory->forward(x);
}

void AdaPoinTrImpl::rebuild(const torch::Tensor& q, const Starts& starts, std::int64_t main, Prediction& prediction,
                            Precision precision) {
  const std::int64_t batch = q.size(0), total = q.size(1), points = shape.patch_points;
  const torch::Tensor summary = largest(head_global->forward(q.narrow(1, 0, main), precision));
  const torch::Tensor features = torch::gelu(head_query_in->forward(q, precision).to(torch::kFloat) +
                                             head_position_in->forward(fourier_features(starts.points), precision) +
                                             head_global_in->forward(summary, precision).unsqueeze(1));
  const torch::Tensor overall = largest(features.narrow(1, 0, main));
  const torch::Tensor hidden =
      torch::gelu(head_hidden->forward(features, precision) + head_summary->forward(overall, precision).unsqueeze(1));
  const torch::Tensor out = head_out->forward(hidden, precision).to(torch::kFloat).view({batch, total, points, 6});
  const torch::Tensor fine =
      starts.points.unsqueeze(2) + starts.offsets.view({batch, total, points, 3}) + out.narrow(3, 0, 3);
  const torch::Tensor direction = starts.normals.view({batch, total, points, 3}) + out.narrow(3, 3, 3);
  const torch::Tensor normals = direction / torch::sqrt(direction.square().sum(-1, true) + 1e-8);
  prediction.fine = fine.narrow(1, 0, main).reshape({batch, main * points, 3});
  prediction.normals = normals.narrow(1, 0, main).reshape({batch, main * points, 3});
  // How far off the points are is read from what they were made of, without a say in how they are made.
  prediction.spread = head_spread->forward(hidden.narrow(1, 0, main).detach(), precision)
                          .to(torch::kFloat)
                          .reshape({batch, main * points});
  if (main < total) prediction.denoised = fine.narrow(1, main, total - main);
}

Prediction AdaPoinTrImpl::forward(const CrownBatch& crowns, const torch::Tensor& seeds,
                                  const torch::Tensor& seed_patches, Precision precision) {
  const torch::Tensor memory = encode(crowns, precision);
  const torch::Tensor global = largest(to_global->forward(memory, precision));
  Starts starts = patch_starts(crowns.types);
  const torch::Tensor bend =
      coarse_out->forward(torch::gelu(coarse_anchor->forward(fourier_features(starts.points), precision) +
                                      coarse_global->forward(global, precision).unsqueeze(1)),
                          precision);
  Prediction prediction;
  prediction.coarse = starts.points + bend;
  // The fine points' gradient also moves the queries: a patch that is off as a whole is mended where it starts.
  starts.points = prediction.coarse;
  if (seeds.defined()) {
    const torch::Tensor known = (seed_patches >= 0).to(torch::kFloat).unsqueeze(-1), index = seed_patches.clamp_min(0);
    starts.points = torch::cat({starts.points, seeds}, 1);
    for (torch::Tensor* part : {&starts.offsets, &starts.normals, &starts.identity})
      *part = torch::cat({*part, known * layers::gather_rows(*part, index)}, 1);
  }
  const std::int64_t main = shape.queries;
  const QueryNeighbours neighbours =
      query_neighbours(starts.points, main, crowns.points.narrow(1, 0, shape.centres_2).contiguous());
  torch::Tensor q = query_out
                        ->forward(torch::gelu(query_position->forward(fourier_features(starts.points), precision) +
                                              query_identity->forward(starts.identity, precision) +
                                              query_global->forward(global, precision).unsqueeze(1)),
                                  precision)
                        .to(torch::kFloat);
  for (const auto& block : *decoder)
    q = block->as<DecoderBlock>()->forward(q, memory, neighbours, seeds.defined() ? main : -1, precision);
  rebuild(norm_queries->forward(q), starts, main, prediction, precision);
  return prediction;
}

}  // namespace rhizodont
