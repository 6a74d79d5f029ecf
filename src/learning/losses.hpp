// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include "learning/adapointr.hpp"

namespace rhizodont {

/// Indices of closest points between two batches of point sets, float B x N x 3 and B x M x 3.
struct ClosestPoints {
  torch::Tensor first_to_second;  ///< int64, B x N, below M
  torch::Tensor second_to_first;  ///< int64, B x M, below N
};

/// Exact; no gradient.
ClosestPoints closest_points(const torch::Tensor& first, const torch::Tensor& second);

/// Rows of `points` (B x N x C) at `indices` (int64, B x Q): B x Q x C, differentiable in `points`.
torch::Tensor gather_rows(const torch::Tensor& points, const torch::Tensor& indices);

/// Length of the last axis' vectors, sqrt(|v|^2 + 1e-8): finite gradient where points coincide.
torch::Tensor safe_length(const torch::Tensor& vectors);

/// Weighted Chamfer-L1 between predicted points (B x N x 3) and target points (B x M x 3, weights B x M):
/// half the weighted mean distance from target to prediction plus half that from prediction to target, where a
/// predicted point has the weight of the target point closest to it. Means run over the whole batch. A scalar.
torch::Tensor weighted_chamfer(const torch::Tensor& predicted, const torch::Tensor& target,
                               const torch::Tensor& weights, const ClosestPoints& closest);

/// Chamfer-L1 of small point sets, one pair per patch: predicted and target B x P x f x 3. A scalar.
torch::Tensor patch_chamfer(const torch::Tensor& predicted, const torch::Tensor& target);

/// The truth that a batch is compared with.
struct TargetBatch {
  torch::Tensor points;          ///< float, B x M x 3
  torch::Tensor normals;         ///< float, B x M x 3, unit length
  torch::Tensor root;            ///< float, B x M: 1 below the crown, 0 on it
  torch::Tensor seeds;           ///< float, B x n x 3: disturbed target points; undefined: no denoising
  torch::Tensor denoise_target;  ///< float, B x n x patch_points x 3
};

/// Terms of the training loss, canonical units.
struct LossTerms {
  torch::Tensor total;    ///< weighted sum
  torch::Tensor coarse;   ///< Chamfer-L1 of the queries' starting points
  torch::Tensor fine;     ///< Chamfer-L1 of all points
  torch::Tensor denoise;  ///< Chamfer-L1 per denoising patch; 0 without
  torch::Tensor normal;   ///< mean of 1 - cos between a point's normal and that of the closest target point
};

LossTerms training_loss(const Prediction& prediction, const TargetBatch& target, const TrainingOptions& options);

}  // namespace rhizodont
