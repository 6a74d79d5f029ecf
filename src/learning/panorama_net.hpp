// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <cstdint>
#include <functional>
#include <string>

#include "learning/training_options.hpp"
#include "networks/safetensors.hpp"
#include "training/labelled_panoramas.hpp"

namespace rhizodont {

/// What networks that look at panoramas have in common, as `PanoramaFeatures` runs it; batch normalisation follows each
/// convolution. panoramas [n, channels, rows, columns] -> [n, 6 width, columns / 4]
struct PanoramaTrunkImpl : torch::nn::Module {
  PanoramaTrunkImpl(std::int64_t channels, std::int64_t rows, int width);
  torch::Tensor forward(torch::Tensor x);
  /// The weights with the normalisation taken into them, under the names that `PanoramaFeatures` looks for.
  void store(TensorFile& file);

  torch::nn::ModuleList maps, map_norms, around, around_norms;
};
TORCH_MODULE(PanoramaTrunk);

/// A convolution over columns that wrap around, its normalisation, and what is above zero.
torch::Tensor convolved_around(const torch::Tensor& x, torch::nn::Conv1d convolution, torch::nn::BatchNorm1d norm);

/// A convolution with the normalisation that follows it, as one.
template <class Convolution, class Norm>
void store_folded(const std::string& name, const Convolution& convolution, const Norm& norm, TensorFile& file);

/// The panoramas [n, channels, rows, columns]; nothing is copied.
torch::Tensor panoramas_of(const LabelledPanoramas& samples);

/// The mirror images of panoramas where `which` [n] says so.
torch::Tensor mirrored_where(const torch::Tensor& which, const torch::Tensor& panoramas);

/// Each panorama turned by so many columns: column c comes from c + `columns` [n, 1].
torch::Tensor turned_by(const torch::Tensor& columns, const torch::Tensor& panoramas);

/// Panoramas as other scanners would have them: smoothed, scaled, with noise and with places missing.
torch::Tensor scanned_anew(torch::Tensor panoramas);

/// One cycle of the learning rate up to `largest` and down again (L. N. Smith, N. Topin, 2018).
double one_cycle_rate(int step, int steps, double largest);

struct PanoramaSteps {
  int steps = 0, batch = 0, report_steps = 0;
  double learning_rate = 0, weight_decay = 0;
  std::function<void(const TrainingProgress&)> progress;
};

/// Takes AdamW (Loshchilov, Hutter, 2019) steps down what `loss` says. Throws NoResultError where that is no number.
void train_on_panoramas(torch::nn::Module& net, const PanoramaSteps& how, const std::function<torch::Tensor()>& loss);

}  // namespace rhizodont
