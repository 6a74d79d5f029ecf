// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Chamfer distance after Fan, Su, Guibas: A Point Set Generation Network, 2017, in the L1 form of AdaPoinTr (Yu et al.,
// 2023); closest points are found by an exact scan outside of the graph, distances are then taken inside of it.
#include "learning/losses.hpp"

#include <ATen/Parallel.h>

#include "learning/points_of.hpp"
#include "networks/neighbours.hpp"

namespace rhizodont {
namespace {

using layers::gather_rows;

/// Over the second axis; 0 where all weights are.
torch::Tensor weighted_mean(const torch::Tensor& values, const torch::Tensor& weights) {
  return (values * weights).sum(1) / weights.sum(1).clamp_min(1e-6);
}

}  // namespace

ClosestPoints closest_points(const torch::Tensor& first, const torch::Tensor& second) {
  torch::NoGradGuard no_gradient;
  const torch::Tensor a = first.detach().contiguous(), b = second.detach().contiguous();
  const std::int64_t batch = a.size(0), n = a.size(1), m = b.size(1);
  ClosestPoints closest{torch::empty({batch, n}, torch::kLong), torch::empty({batch, m}, torch::kLong)};
  std::int64_t* forth = closest.first_to_second.data_ptr<std::int64_t>();
  std::int64_t* back = closest.second_to_first.data_ptr<std::int64_t>();
  at::parallel_for(0, 2 * batch, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t job = begin; job < end; ++job) {
      const std::int64_t sample = job / 2;
      const bool forward = job % 2 == 0;
      const auto found = forward ? closest_keys(points_of(a, sample), points_of(b, sample))
                                 : closest_keys(points_of(b, sample), points_of(a, sample));
      std::copy(found.begin(), found.end(), forward ? forth + sample * n : back + sample * m);
    }
  });
  return closest;
}

torch::Tensor safe_length(const torch::Tensor& vectors) { return torch::sqrt(vectors.square().sum(-1) + 1e-8); }

torch::Tensor weighted_chamfer(const torch::Tensor& predicted, const torch::Tensor& target,
                               const torch::Tensor& weights, const ClosestPoints& closest) {
  const torch::Tensor forth = safe_length(predicted - gather_rows(target, closest.first_to_second));
  const torch::Tensor back = safe_length(gather_rows(predicted, closest.second_to_first) - target);
  const torch::Tensor shares = gather_rows(weights.unsqueeze(-1), closest.first_to_second).squeeze(-1);
  return 0.5 * (weighted_mean(forth, shares) + weighted_mean(back, weights));
}

torch::Tensor patch_chamfer(const torch::Tensor& predicted, const torch::Tensor& target) {
  const torch::Tensor squared = (predicted.unsqueeze(3) - target.unsqueeze(2)).square().sum(-1) + 1e-8;
  const torch::Tensor forth = std::get<0>(squared.min(3)), back = std::get<0>(squared.min(2));
  return 0.5 * (torch::sqrt(forth) + torch::sqrt(back)).mean({1, 2});
}

LossTerms completion_loss(const Prediction& prediction, const TargetBatch& target,
                          const CompletionTrainingOptions& options) {
  const torch::Tensor weights = 1 + (options.root_weight - 1) * target.root;
  const torch::Tensor matched_weights = 1 + (options.root_weight - 1) * target.matched_root;
  const torch::Tensor is_matched = target.is_matched, is_free = 1 - is_matched;
  const std::int64_t batch = target.points.size(0), queries = prediction.coarse.size(1);
  const ClosestPoints closest = closest_points(prediction.fine, target.points);
  const ClosestPoints closest_coarse = closest_points(prediction.coarse, target.points);

  const torch::Tensor chamfer = weighted_chamfer(prediction.fine, target.points, weights, closest);
  const torch::Tensor distances = safe_length(prediction.fine - target.matched);
  const torch::Tensor match = weighted_mean(distances, matched_weights);
  const torch::Tensor spread = (distances.detach() * torch::exp(-prediction.spread) + prediction.spread).mean(1);
  const torch::Tensor middles = target.matched.view({batch, queries, -1, 3}).mean(2);
  const torch::Tensor coarse = is_matched * weighted_mean(safe_length(prediction.coarse - middles),
                                                          matched_weights.view({batch, queries, -1}).select(2, 0)) +
                               is_free * weighted_chamfer(prediction.coarse, target.points, weights, closest_coarse);
  const torch::Tensor true_normals = gather_rows(target.normals, closest.first_to_second);
  const torch::Tensor wanted = torch::where(is_matched.view({-1, 1, 1}) > 0, target.matched_normals, true_normals);
  const torch::Tensor normal = (1 - (prediction.normals * wanted).sum(-1)).mean(1);

  LossTerms terms;
  terms.coarse = coarse.mean();
  terms.match = (is_matched * match).sum() / is_matched.sum().clamp_min(1);
  terms.spread = (is_matched * spread).sum() / is_matched.sum().clamp_min(1);
  terms.chamfer = chamfer.mean();
  terms.normal = normal.mean();
  terms.denoise = torch::zeros({});
  if (prediction.denoised.defined())
    terms.denoise = (is_matched * safe_length(prediction.denoised - target.denoise_target).mean({1, 2}) +
                     is_free * patch_chamfer(prediction.denoised, target.denoise_target))
                        .mean();
  terms.total = (is_matched * (match + options.chamfer_weight * chamfer) + is_free * chamfer).mean() +
                options.coarse_weight * terms.coarse + options.denoise_weight * terms.denoise +
                options.normal_weight * terms.normal + options.spread_weight * terms.spread;
  return terms;
}

}  // namespace rhizodont
