// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <cstdint>
#include <vector>

#include "learning/adapointr.hpp"
#include "learning/losses.hpp"
#include "learning/training_sample.hpp"

namespace rhizodont {

/// Some samples as tensors.
struct TrainingBatch {
  CrownBatch crowns;
  TargetBatch target;
};

/// Throws InputError if a sample cannot be used: too few points, arrays of different lengths, values that are not
/// finite, an unknown type.
void check_sample(const TrainingSample& sample, const CompletionShape& shape);

/// Samples `first` .. `first + count - 1` of the provider. With `training`, some types are hidden and denoising seeds
/// are added, both drawn from the options' seed and the sample's number alone.
TrainingBatch make_training_batch(const SampleProvider& provider, std::uint64_t first, int count,
                                  const TrainingOptions& options, bool training);

/// Starting points of the queries for each type and for "unknown": (tooth_types + 1) lists of queries x 3 numbers.
/// A type's anchors are spread over a tooth of median depth among its first samples, three quarters of them on the
/// root; those of "unknown" are taken in turn from all types.
std::vector<std::vector<float>> initial_anchors(const SampleProvider& provider, const CompletionShape& shape);

}  // namespace rhizodont
