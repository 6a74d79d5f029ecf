// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Chamfer distance after Fan, Su, Guibas: A Point Set Generation Network, 2017, in the L1 form of AdaPoinTr (Yu et al.,
// 2023); closest points are found by an exact scan outside of the graph, distances are then taken inside of it.
#include "learning/losses.hpp"

#include <ATen/Parallel.h>

#include "learning/neighbours.hpp"

namespace rhizodont {
namespace {

std::span<const float> row(const torch::Tensor& points, std::int64_t b) {
  const std::int64_t size = points.size(1) * points.size(2);
  return {points.data_ptr<float>() + b * size, static_cast<std::size_t>(size)};
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
      const auto found =
          forward ? closest_keys(row(a, sample), row(b, sample)) : closest_keys(row(b, sample), row(a, sample));
      std::copy(found.begin(), found.end(), forward ? forth + sample * n : back + sample * m);
    }
  });
  return closest;
}

torch::Tensor gather_rows(const torch::Tensor& points, const torch::Tensor& indices) {
  const std::int64_t batch = points.size(0), count = points.size(1), channels = points.size(2);
  const torch::Tensor flat = (indices + torch::arange(batch, torch::kLong).unsqueeze(1) * count).flatten();
  return points.reshape({batch * count, channels}).index_select(0, flat).view({batch, indices.size(1), channels});
}

torch::Tensor safe_length(const torch::Tensor& vectors) { return torch::sqrt(vectors.square().sum(-1) + 1e-8); }

torch::Tensor weighted_chamfer(const torch::Tensor& predicted, const torch::Tensor& target,
                               const torch::Tensor& weights, const ClosestPoints& closest) {
  const torch::Tensor forth = safe_length(predicted - gather_rows(target, closest.first_to_second));
  const torch::Tensor back = safe_length(gather_rows(predicted, closest.second_to_first) - target);
  const torch::Tensor shares = gather_rows(weights.unsqueeze(-1), closest.first_to_second).squeeze(-1);
  return 0.5 * ((forth * shares).sum() / shares.sum() + (back * weights).sum() / weights.sum());
}

torch::Tensor patch_chamfer(const torch::Tensor& predicted, const torch::Tensor& target) {
  const torch::Tensor squared = (predicted.unsqueeze(3) - target.unsqueeze(2)).square().sum(-1) + 1e-8;
  const torch::Tensor forth = std::get<0>(squared.min(3)), back = std::get<0>(squared.min(2));
  return 0.5 * (torch::sqrt(forth).mean() + torch::sqrt(back).mean());
}

LossTerms training_loss(const Prediction& prediction, const TargetBatch& target, const TrainingOptions& options) {
  const torch::Tensor weights = 1 + (options.root_weight - 1) * target.root;
  const ClosestPoints coarse = closest_points(prediction.coarse, target.points);
  const ClosestPoints fine = closest_points(prediction.fine, target.points);
  LossTerms terms;
  terms.coarse = weighted_chamfer(prediction.coarse, target.points, weights, coarse);
  terms.fine = weighted_chamfer(prediction.fine, target.points, weights, fine);
  terms.denoise =
      prediction.denoised.defined() ? patch_chamfer(prediction.denoised, target.denoise_target) : torch::zeros({});
  terms.normal = (1 - (prediction.normals * gather_rows(target.normals, fine.first_to_second)).sum(-1)).mean();
  terms.total = terms.fine + options.coarse_weight * terms.coarse + options.denoise_weight * terms.denoise +
                options.normal_weight * terms.normal;
  return terms;
}

}  // namespace rhizodont
