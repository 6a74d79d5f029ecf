// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/completion_network.hpp"

#include "base/parallel_tasks.hpp"
#include "networks/adapointr.hpp"
#include "networks/neighbours.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <cmath>

namespace rhizodont {
namespace {

/// The crown's points in farthest-point order, as many as the network takes. Throws as CompletionNetwork::complete.
networks::Matrix ordered_points(const CompletionShape& shape, std::span<const Eigen::Vector3f> crown) {
  constexpr float widest = 4;
  if (crown.size() < static_cast<std::size_t>(shape.input_points))
    throw InputError("The crown has too few points for the completion network.");
  std::vector<float> xyz;
  xyz.reserve(3 * crown.size());
  for (const Eigen::Vector3f& p : crown) {
    if (!p.allFinite()) throw InputError("The crown has a point that is not a number.");
    if (p.cwiseAbs().maxCoeff() > widest) throw InputError("The crown is far larger than a tooth.");
    xyz.insert(xyz.end(), p.data(), p.data() + 3);
  }
  networks::Matrix points(shape.input_points, 3);
  Eigen::Index row = 0;
  for (const std::int32_t i : farthest_point_order(xyz, shape.input_points))
    points.row(row++) = crown[static_cast<std::size_t>(i)];
  if (points.row(0) == points.row(shape.centres_2 - 1)) throw InputError("The crown's points coincide.");
  return points;
}

NoResultError no_result() { return NoResultError("The completion network came to no result for this crown."); }

}  // namespace

struct CompletionNetwork::Impl {
  networks::AdaPoinTr network;
  std::map<std::string, std::string> metadata;
};

CompletionNetwork::CompletionNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CompletionNetwork::CompletionNetwork(CompletionNetwork&&) noexcept = default;
CompletionNetwork& CompletionNetwork::operator=(CompletionNetwork&&) noexcept = default;
CompletionNetwork::~CompletionNetwork() = default;

CompletionNetwork CompletionNetwork::load(const std::filesystem::path& path) {
  TensorFile file = read_safetensors(path);
  networks::AdaPoinTr network(file);
  return CompletionNetwork(std::make_unique<Impl>(Impl{std::move(network), std::move(file.metadata)}));
}

CompletedPoints CompletionNetwork::complete(std::span<const Eigen::Vector3f> crown, int type,
                                            const Eigen::Vector2f& form_axis) const {
  if (type < 0 || type > unknown_type) throw UsageError("The completion network knows no such tooth type.");
  if (!form_axis.allFinite()) throw InputError("The axis of the crown's form is not a number.");
  const networks::Matrix points = ordered_points(impl_->network.shape, crown);
  const networks::Prediction prediction = networks::predict(impl_->network, points, type, form_axis);
  if (!prediction.points.allFinite() || !prediction.normals.allFinite() || !prediction.spread.allFinite())
    throw no_result();
  CompletedPoints result;
  for (Eigen::Index i = 0; i < prediction.points.rows(); ++i) {
    result.points.emplace_back(prediction.points.row(i));
    const Eigen::Vector3f normal = prediction.normals.row(i);
    const float spread = std::exp(prediction.spread.data()[i]);
    if (!(normal.squaredNorm() > 0) || !(spread > 0) || !std::isfinite(spread)) throw no_result();
    result.normals.push_back(normal.normalized());
    result.spread.push_back(spread);
  }
  return result;
}

std::vector<CompletedPoints> CompletionNetwork::complete(std::span<const CrownPoints> crowns) const {
  std::vector<CompletedPoints> result(crowns.size());
  // Crown by crown, not layer by layer: a crown's matrices stay in the cache, and two threads need not meet in between.
  parallel_tasks(crowns.size(),
                 [&](std::size_t i) { result[i] = complete(crowns[i].points, crowns[i].type, crowns[i].form_axis); });
  return result;
}

int CompletionNetwork::input_points() const { return impl_->network.shape.input_points; }

int CompletionNetwork::output_points() const {
  return impl_->network.shape.queries * impl_->network.shape.patch_points;
}

const std::map<std::string, std::string>& CompletionNetwork::metadata() const { return impl_->metadata; }

}  // namespace rhizodont
