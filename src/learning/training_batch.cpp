// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/training_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "learning/neighbours.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double root_share_of_queries = 0.75;

std::vector<float> flatten(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> xyz;
  xyz.reserve(3 * points.size());
  for (const Eigen::Vector3f& p : points) xyz.insert(xyz.end(), p.data(), p.data() + 3);
  return xyz;
}

bool all_finite(const std::vector<Eigen::Vector3f>& points) {
  return std::all_of(points.begin(), points.end(), [](const Eigen::Vector3f& p) { return p.allFinite(); });
}

/// `count` points spread over those with the flag; empty if there are too few.
std::vector<float> spread(const TrainingSample& sample, std::optional<bool> root, int count) {
  std::vector<float> xyz;
  for (std::size_t i = 0; i < sample.target.size(); ++i) {
    if (root && (sample.is_root[i] != 0) != *root) continue;
    xyz.insert(xyz.end(), sample.target[i].data(), sample.target[i].data() + 3);
  }
  if (xyz.size() < 3 * static_cast<std::size_t>(count)) return {};
  std::vector<float> chosen;
  for (const std::int32_t i : farthest_point_order(xyz, count))
    chosen.insert(chosen.end(), xyz.begin() + 3 * i, xyz.begin() + 3 * i + 3);
  return chosen;
}

std::vector<float> anchors_on(const TrainingSample& sample, int queries) {
  const int on_root = static_cast<int>(std::lround(queries * root_share_of_queries));
  std::vector<float> anchors = spread(sample, true, on_root);
  const std::vector<float> crown = spread(sample, false, queries - on_root);
  if (anchors.empty() || crown.empty())
    anchors = spread(sample, std::nullopt, queries);
  else
    anchors.insert(anchors.end(), crown.begin(), crown.end());
  if (anchors.empty()) throw InputError("A training sample has fewer target points than the network has queries.");
  return anchors;
}

float depth(const TrainingSample& sample) {
  float lowest = 0;
  for (const Eigen::Vector3f& p : sample.target) lowest = std::min(lowest, p.z());
  return lowest;
}

/// Disturbed target points and what a patch that starts at each of them has to become.
void add_seeds(const std::vector<float>& target, const TrainingOptions& options, std::mt19937_64& random, float* seeds,
               float* patches) {
  // Target points come in random order, so the first ones are spread like all of them.
  const auto count = static_cast<std::size_t>(options.denoise_queries);
  const std::span<const float> centres{target.data(), 3 * count};
  std::normal_distribution<float> jitter(0, static_cast<float>(options.denoise_jitter));
  const auto widest = static_cast<float>(5 * options.denoise_jitter);
  for (std::size_t i = 0; i < 3 * count; ++i) seeds[i] = centres[i] + std::clamp(jitter(random), -widest, widest);
  for (const std::int32_t i : nearest_keys(centres, target, options.shape.patch_points))
    patches = std::copy_n(target.data() + 3 * static_cast<std::size_t>(i), 3, patches);
}

}  // namespace

void check_sample(const TrainingSample& sample, const CompletionShape& shape) {
  if (sample.input.size() < static_cast<std::size_t>(shape.input_points))
    throw InputError("A training sample has fewer crown points than the network looks at.");
  if (sample.target.empty() || sample.normals.size() != sample.target.size() ||
      sample.is_root.size() != sample.target.size())
    throw InputError("A training sample's target points, normals and marks are not equally many.");
  if (!all_finite(sample.input) || !all_finite(sample.target) || !all_finite(sample.normals))
    throw InputError("A training sample has values that are not numbers.");
  if (sample.type < 0 || sample.type > unknown_type) throw InputError("A training sample's tooth type is unknown.");
}

TrainingBatch make_training_batch(const SampleProvider& provider, std::uint64_t first, int count,
                                  const TrainingOptions& options, bool training) {
  std::vector<std::vector<float>> crowns;
  std::vector<std::int64_t> types;
  TrainingBatch batch;
  TargetBatch& target = batch.target;
  const std::int64_t seeds = training ? options.denoise_queries : 0;
  for (int b = 0; b < count; ++b) {
    const std::uint64_t number = first + static_cast<std::uint64_t>(b);
    const TrainingSample sample = provider(number);
    check_sample(sample, options.shape);
    const auto points = static_cast<std::int64_t>(sample.target.size());
    if (b == 0) {
      target.points = torch::empty({count, points, 3});
      target.normals = torch::empty({count, points, 3});
      target.root = torch::empty({count, points});
      if (seeds > 0) {
        target.seeds = torch::empty({count, seeds, 3});
        target.denoise_target = torch::empty({count, seeds, options.shape.patch_points, 3});
      }
    } else if (points != target.points.size(1)) {
      throw InputError("Training samples differ in their number of target points.");
    }
    if (points < std::max<std::int64_t>(seeds, options.shape.patch_points))
      throw InputError("A training sample has fewer target points than denoising queries.");
    crowns.push_back(flatten(sample.input));
    const std::vector<float> xyz = flatten(sample.target), normals = flatten(sample.normals);
    std::copy(xyz.begin(), xyz.end(), target.points[b].data_ptr<float>());
    std::copy(normals.begin(), normals.end(), target.normals[b].data_ptr<float>());
    std::copy(sample.is_root.begin(), sample.is_root.end(), target.root[b].data_ptr<float>());
    std::seed_seq sequence{options.seed, number >> 32, number & 0xffffffffU};
    std::mt19937_64 random(sequence);
    const bool hide = std::uniform_real_distribution<double>(0, 1)(random) < options.unknown_share;
    types.push_back(training && hide ? unknown_type : sample.type);
    if (seeds > 0)
      add_seeds(xyz, options, random, target.seeds[b].data_ptr<float>(), target.denoise_target[b].data_ptr<float>());
  }
  batch.crowns = make_crown_batch(options.shape, crowns, types);
  return batch;
}

std::vector<std::vector<float>> initial_anchors(const SampleProvider& provider, const CompletionShape& shape) {
  constexpr std::size_t samples_per_type = 7;
  constexpr std::uint64_t most_samples = 300;
  std::array<std::vector<TrainingSample>, tooth_types> found;
  std::vector<float> any;
  for (std::uint64_t number = 0; number < most_samples; ++number) {
    TrainingSample sample = provider(number);
    check_sample(sample, shape);
    if (any.empty()) any = anchors_on(sample, shape.queries);
    if (sample.type == unknown_type) continue;
    auto& list = found[static_cast<std::size_t>(sample.type)];
    if (list.size() < samples_per_type) list.push_back(std::move(sample));
  }
  std::vector<std::vector<float>> anchors;
  for (auto& list : found) {
    if (list.empty()) {
      anchors.push_back(any);
      continue;
    }
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(list.begin(), middle, list.end(),
                     [](const TrainingSample& a, const TrainingSample& b) { return depth(a) < depth(b); });
    anchors.push_back(anchors_on(*middle, shape.queries));
  }
  std::vector<float> mixed;
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.queries); ++i) {
    const auto& from = anchors[i % tooth_types];
    mixed.insert(mixed.end(), from.begin() + static_cast<std::ptrdiff_t>(3 * i),
                 from.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
  }
  anchors.push_back(std::move(mixed));
  return anchors;
}

}  // namespace rhizodont
