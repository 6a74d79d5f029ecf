// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/surface_network.hpp"

#include "networks/diffusion_net.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <cmath>

namespace rhizodont {

struct SurfaceNetwork::Impl {
  networks::DiffusionNet network;
  std::map<std::string, std::string> metadata;
};

SurfaceNetwork::SurfaceNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceNetwork::SurfaceNetwork(SurfaceNetwork&&) noexcept = default;
SurfaceNetwork& SurfaceNetwork::operator=(SurfaceNetwork&&) noexcept = default;
SurfaceNetwork::~SurfaceNetwork() = default;

SurfaceNetwork SurfaceNetwork::load(const std::filesystem::path& path) {
  TensorFile file = read_safetensors(path);
  networks::DiffusionNet network(file);
  return SurfaceNetwork(std::make_unique<Impl>(Impl{std::move(network), std::move(file.metadata)}));
}

std::vector<float> SurfaceNetwork::confidence(const SurfaceSample& sample) const {
  check_surface_sample(sample, false);
  std::vector<float> result;
  for (const float x : networks::predict(impl_->network, sample)) {
    if (!std::isfinite(x)) throw NoResultError("The network that finds the skirt came to no result for this crown.");
    result.push_back(1 / (1 + std::exp(-x)));
  }
  return result;
}

const SurfaceShape& SurfaceNetwork::shape() const { return impl_->network.shape; }

const std::map<std::string, std::string>& SurfaceNetwork::metadata() const { return impl_->metadata; }

}  // namespace rhizodont
