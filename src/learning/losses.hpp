// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include "learning/adapointr.hpp"
#include "learning/train_completion.hpp"

namespace rhizodont {

/// Indices of closest points between two batches of point sets, float B x N x 3 and B x M x 3.
struct ClosestPoints {
  torch::Tensor first_to_second;  ///< int64, B x N, below M
  torch::Tensor second_to_first;  ///< int64, B x M, below N
};

/// Exact; no gradient.
ClosestPoints closest_points(const torch::Tensor& first, const torch::Tensor& second);

/// Length of the last axis' vectors, sqrt(|v|^2 + 1e-8): finite gradient where points coincide.
torch::Tensor safe_length(const torch::Tensor& vectors);

/// Weighted Chamfer-L1 between predicted points (B x N x 3) and target points (B x M x 3, weights B x M):
/// half the weighted mean distance from target to prediction plus half that from prediction to target, where a
/// predicted point has the weight of the target point closest to it. One value per sample: B.
torch::Tensor weighted_chamfer(const torch::Tensor& predicted, const torch::Tensor& target,
                               const torch::Tensor& weights, const ClosestPoints& closest);

/// Mean Chamfer-L1 of small point sets, one pair per patch: predicted and target B x P x f x 3. One value per sample.
torch::Tensor patch_chamfer(const torch::Tensor& predicted, const torch::Tensor& target);

/// The truth that a batch is compared with.
struct TargetBatch {
  torch::Tensor points;           ///< float, B x M x 3
  torch::Tensor normals;          ///< float, B x M x 3, unit length
  torch::Tensor root;             ///< float, B x M: 1 below the crown, 0 on it
  torch::Tensor seeds;            ///< float, B x n x 3: disturbed target points; undefined: no denoising
  torch::Tensor seed_patches;     ///< int64, B x n: the patch whose points a seed is to become, -1 where unmatched
  torch::Tensor denoise_target;   ///< float, B x n x patch_points x 3; in the patch's own order where matched
  torch::Tensor is_matched;       ///< float, B: 1 where the next three are known, 0 where they are zero
  torch::Tensor matched;          ///< float, B x (queries patch_points) x 3: where each predicted point belongs
  torch::Tensor matched_normals;  ///< as matched, unit length
  torch::Tensor matched_root;     ///< float, B x (queries patch_points): 1 on the root
};

/// Terms of the training loss, canonical units, means over the batch.
struct LossTerms {
  torch::Tensor total;    ///< weighted sum
  torch::Tensor coarse;   ///< of the queries' starting points
  torch::Tensor match;    ///< weighted mean distance of points from where they belong; over matched samples
  torch::Tensor chamfer;  ///< Chamfer-L1 of all points
  torch::Tensor denoise;  ///< of the denoising patches; 0 without
  torch::Tensor normal;   ///< mean of 1 - cos between a point's normal and the true one
  torch::Tensor spread;   ///< of the distances that the network expects of its points; over matched samples
};

/// Where it is known which target point is which, each point is drawn to its own place: unlike the Chamfer distance,
/// which is least for points scattered over all places where an unpredictable surface may be, this has the median
/// surface as its optimum, smooth and evenly covered. The Chamfer distance does the rest: samples without
/// correspondence, and a share of `chamfer_weight` of the others. The expected distance s of a point that is r off
/// costs r / s + log s, least on average where s is the mean of r (the likelihood of an exponential distribution).
LossTerms completion_loss(const Prediction& prediction, const TargetBatch& target,
                          const CompletionTrainingOptions& options);

}  // namespace rhizodont
