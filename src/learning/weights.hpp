// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <string>

#include "learning/completion_shape.hpp"
#include "learning/safetensors.hpp"

namespace rhizodont {

/// Packs a float tensor.
StoredTensor store_tensor(const torch::Tensor& tensor, TensorType type);

/// Copies a stored tensor into one of the same shape. Throws InputError, naming `name`, if it is missing or of another
/// shape or has values that are not finite.
void load_tensor(const TensorFile& file, const std::string& name, torch::Tensor into);

/// Notes the sizes of a network in a file's metadata ("shape.width" and so on, "format").
void note_shape(const CompletionShape& shape, std::map<std::string, std::string>& metadata);

/// The sizes noted. Throws InputError if they are missing or out of range.
CompletionShape read_shape(const std::map<std::string, std::string>& metadata);

/// Throws UsageError if a size is out of range.
void check_shape(const CompletionShape& shape);

}  // namespace rhizodont
