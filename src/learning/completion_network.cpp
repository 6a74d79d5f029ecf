// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inference of the completion network (Yu et al., AdaPoinTr, 2023).
#include "learning/completion_network.hpp"

#include <cmath>

#include "learning/adapointr.hpp"
#include "learning/threads.hpp"
#include "learning/weights.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {

struct CompletionNetwork::Impl {
  CompletionShape shape;
  AdaPoinTr network{nullptr};
  std::map<std::string, std::string> metadata;
};

CompletionNetwork::CompletionNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CompletionNetwork::CompletionNetwork(CompletionNetwork&&) noexcept = default;
CompletionNetwork& CompletionNetwork::operator=(CompletionNetwork&&) noexcept = default;
CompletionNetwork::~CompletionNetwork() = default;

CompletionNetwork CompletionNetwork::load(const std::filesystem::path& path) {
  const TensorFile file = read_safetensors(path);
  auto impl = std::make_unique<Impl>();
  impl->shape = read_shape(file.metadata);
  impl->metadata = file.metadata;
  torch::NoGradGuard no_gradient;
  impl->network = AdaPoinTr(impl->shape);
  for (auto& item : impl->network->named_parameters()) {
    load_tensor(file, item.key(), item.value());
    item.value().set_requires_grad(false);
  }
  return CompletionNetwork(std::move(impl));
}

CompletedPoints CompletionNetwork::complete(std::span<const Eigen::Vector3f> crown, int type,
                                            const Eigen::Vector2f& form_axis) const {
  constexpr float widest = 4;
  if (type < 0 || type > unknown_type) throw UsageError("The completion network knows no such tooth type.");
  if (!form_axis.allFinite()) throw InputError("The axis of the crown's form is not a number.");
  if (crown.size() < static_cast<std::size_t>(impl_->shape.input_points))
    throw InputError("The crown has too few points for the completion network.");
  std::vector<float> xyz;
  for (const Eigen::Vector3f& p : crown) {
    if (!p.allFinite()) throw InputError("The crown has a point that is not a number.");
    if (p.cwiseAbs().maxCoeff() > widest) throw InputError("The crown is far larger than a tooth.");
    xyz.insert(xyz.end(), p.data(), p.data() + 3);
  }
  // One thread: sums then have one order, whatever the machine is doing; several teeth go side by side instead.
  const TensorThreads one_thread(1);
  torch::NoGradGuard no_gradient;
  const CrownBatch batch = make_crown_batch(impl_->shape, {xyz}, {type}, {form_axis.x(), form_axis.y()});
  if ((batch.points[0][0] - batch.points[0][impl_->shape.centres_2 - 1]).abs().max().item<float>() == 0)
    throw InputError("The crown's points coincide.");
  const Prediction prediction = impl_->network->forward(batch, {}, {}, layers::Precision::single);
  if (!torch::isfinite(prediction.fine).all().item<bool>() || !torch::isfinite(prediction.normals).all().item<bool>() ||
      !torch::isfinite(prediction.spread).all().item<bool>())
    throw NoResultError("The completion network came to no result for this crown.");

  CompletedPoints result;
  const auto fine = prediction.fine[0].contiguous(), normals = prediction.normals[0].contiguous();
  const auto spread = prediction.spread[0].contiguous();
  const float* point = fine.data_ptr<float>();
  const float* normal = normals.data_ptr<float>();
  for (std::int64_t i = 0; i < fine.size(0); ++i) {
    result.points.emplace_back(point[3 * i], point[3 * i + 1], point[3 * i + 2]);
    result.spread.push_back(std::exp(spread.data_ptr<float>()[i]));
    result.normals.push_back(Eigen::Vector3f(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]).normalized());
  }
  return result;
}

int CompletionNetwork::input_points() const { return impl_->shape.input_points; }

int CompletionNetwork::output_points() const { return impl_->shape.queries * impl_->shape.patch_points; }

const std::map<std::string, std::string>& CompletionNetwork::metadata() const { return impl_->metadata; }

}  // namespace rhizodont
