// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inference of surface networks (N. Sharp et al., DiffusionNet, 2022).
#include "learning/surface_network.hpp"

#include "learning/diffusion_net.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {

struct SurfaceNetwork::Impl {
  SurfaceShape shape;
  DiffusionNet network{nullptr};
  std::map<std::string, std::string> metadata;
};

SurfaceNetwork::SurfaceNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceNetwork::SurfaceNetwork(SurfaceNetwork&&) noexcept = default;
SurfaceNetwork& SurfaceNetwork::operator=(SurfaceNetwork&&) noexcept = default;
SurfaceNetwork::~SurfaceNetwork() = default;

SurfaceNetwork SurfaceNetwork::load(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  auto impl = std::make_unique<Impl>();
  impl->shape = read_surface_shape(file.metadata);
  impl->metadata = file.metadata;
  torch::NoGradGuard no_gradient;
  impl->network = DiffusionNet(impl->shape);
  for (auto& item : impl->network->named_parameters()) {
    load_tensor(file, item.key(), item.value());
    item.value().set_requires_grad(false);
  }
  return SurfaceNetwork(std::move(impl));
}

std::vector<float> SurfaceNetwork::confidence(const SurfaceSample& sample) const {
  // One thread: sums then have one order, whatever the machine is doing.
  const TensorThreads one_thread(1);
  torch::NoGradGuard no_gradient;
  const torch::Tensor result = torch::sigmoid(impl_->network->forward(to_tensors(sample, false))).contiguous();
  if (!torch::isfinite(result).all().item<bool>())
    throw NoResultError("The network that finds the skirt came to no result for this crown.");
  return {result.data_ptr<float>(), result.data_ptr<float>() + result.numel()};
}

const SurfaceShape& SurfaceNetwork::shape() const { return impl_->shape; }

const std::map<std::string, std::string>& SurfaceNetwork::metadata() const { return impl_->metadata; }

}  // namespace rhizodont
