// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <cstdint>
#include <vector>

#include "learning/adapointr.hpp"
#include "learning/losses.hpp"
#include "training/completion_training_sample.hpp"

namespace rhizodont {

/// Some samples as tensors.
struct CompletionTrainingBatch {
  CrownBatch crowns;
  TargetBatch target;
};

/// Which of a type's corresponding points each point of the output is to become: queries x patch_points indices into
/// CompletionTrainingSample::matched, those of a patch side by side. Empty for a type without correspondence.
using PointLayout = std::vector<std::int32_t>;

/// The points that a type's output starts from: queries x patch_points x 3 numbers each.
struct ToothPatches {
  std::vector<float> points;
  std::vector<float> normals;
};

/// What a network's queries start from.
struct QueryLayout {
  std::vector<ToothPatches> patches;  ///< per type and for "unknown" last
  std::vector<PointLayout> points;    ///< per type
};

/// Throws InputError if a sample cannot be used: too few points, arrays of different lengths, values that are not
/// finite, an unknown type.
void check_completion_sample(const CompletionTrainingSample& sample, const CompletionShape& shape);

/// Samples `first` .. `first + count - 1` of the provider. With `training`, some types are hidden and denoising seeds
/// are added, both drawn from the options' seed and the sample's number alone.
/// `layouts`: per type, as of initial_layout.
CompletionTrainingBatch make_completion_training_batch(const CompletionSampleProvider& provider,
                                                       const std::vector<PointLayout>& layouts, std::uint64_t first,
                                                       int count, const CompletionTrainingOptions& options,
                                                       bool training);

/// Starting points of the queries and, where samples have corresponding points, the layout of the output.
/// Both are spread over a tooth of median depth among a type's first samples, three quarters of the queries on the root
/// as far as there are points; the patches of "unknown" are taken in turn from all types.
QueryLayout initial_layout(const CompletionSampleProvider& provider, const CompletionShape& shape);

}  // namespace rhizodont
