// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <string>

#include "networks/completion_shape.hpp"
#include "networks/safetensors.hpp"

namespace rhizodont {

/// Packs a float tensor.
StoredTensor store_tensor(const torch::Tensor& tensor, TensorType type);

/// Copies a stored tensor into one of the same shape. Throws InputError, naming `name`, if it is missing or of another
/// shape or has values that are not finite.
void load_tensor(const TensorFile& file, const std::string& name, torch::Tensor into);

}  // namespace rhizodont
