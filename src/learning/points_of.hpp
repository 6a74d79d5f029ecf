// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace rhizodont {

/// The values of element `b` of a batch of point sets: float, contiguous, batch x points x coordinates.
inline std::span<const float> points_of(const torch::Tensor& batch, std::int64_t b) {
  const std::int64_t size = batch.size(1) * batch.size(2);
  return {batch.data_ptr<float>() + b * size, static_cast<std::size_t>(size)};
}

}  // namespace rhizodont
