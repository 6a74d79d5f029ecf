// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <cstdint>
#include <string>
#include <vector>

namespace rhizodont {

/// A trained tensor with what the optimiser keeps beside it; all float, contiguous, of one shape.
struct TrainedTensor {
  std::string name;
  torch::Tensor value;
  torch::Tensor mean;     ///< running mean of the gradient
  torch::Tensor square;   ///< running mean of the gradient's square
  torch::Tensor average;  ///< running mean of the value
  bool decays = false;    ///< weight decay applies
};

/// State for all parameters of a module; weight matrices decay, vectors and patches do not.
std::vector<TrainedTensor> trained_tensors(const torch::nn::Module& module);

/// Settings of one step.
struct StepOptions {
  double learning_rate = 1e-3;
  double weight_decay = 5e-4;
  double clip = 1;             ///< largest L2 norm of the whole gradient
  double average_decay = 0.9;  ///< share of the old running mean of the values that is kept
  std::int64_t step = 1;       ///< counted from 1, for the bias correction
};

/// One AdamW step (Loshchilov, Hutter: Decoupled Weight Decay Regularization, 2019; betas 0.9 and 0.99) with the
/// gradient clipped to `clip`, and the running mean of the values, in one pass over memory.
/// gradients[i] belongs to tensors[i]; an undefined one counts as zero. Returns the gradient's norm before clipping.
/// Throws NoResultError if the gradient is not finite.
double adamw_step(std::vector<TrainedTensor>& tensors, const std::vector<torch::Tensor>& gradients,
                  const StepOptions& options);

}  // namespace rhizodont
