// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/completion_training_batch.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>

#include "networks/neighbours.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr double root_share = 0.75;

std::vector<float> flatten(const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> xyz;
  xyz.reserve(3 * points.size());
  for (const Eigen::Vector3f& p : points) xyz.insert(xyz.end(), p.data(), p.data() + 3);
  return xyz;
}

bool all_finite(const std::vector<Eigen::Vector3f>& points) {
  return std::all_of(points.begin(), points.end(), [](const Eigen::Vector3f& p) { return p.allFinite(); });
}

/// Up to `count` indices spread over the points whose flag is `root`.
std::vector<std::int32_t> spread(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint8_t>& is_root,
                                 bool root, int count) {
  std::vector<float> xyz;
  std::vector<std::int32_t> chosen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((is_root[i] != 0) != root) continue;
    xyz.insert(xyz.end(), points[i].data(), points[i].data() + 3);
    chosen.push_back(static_cast<std::int32_t>(i));
  }
  std::vector<std::int32_t> order = farthest_point_order(xyz, std::min(count, static_cast<int>(chosen.size())));
  for (std::int32_t& i : order) i = chosen[static_cast<std::size_t>(i)];
  return order;
}

/// `count` indices spread over root and crown, three quarters of them on the root if both have enough.
std::vector<std::int32_t> spread_over_tooth(const std::vector<Eigen::Vector3f>& points,
                                            const std::vector<std::uint8_t>& is_root, int count) {
  const auto on_root = static_cast<int>(std::count(is_root.begin(), is_root.end(), 1));
  const auto on_crown = static_cast<int>(points.size()) - on_root;
  if (on_root + on_crown < count) throw InputError("A training sample has too few points for the network's output.");
  const int wanted = static_cast<int>(std::lround(count * root_share));
  const int root_count = std::min(std::max(wanted, count - on_crown), on_root);
  std::vector<std::int32_t> chosen = spread(points, is_root, true, root_count);
  const std::vector<std::int32_t> crown = spread(points, is_root, false, count - root_count);
  chosen.insert(chosen.end(), crown.begin(), crown.end());
  return chosen;
}

/// Orders indices so that those of each of `groups` equally large groups lie side by side in space and in the list:
/// halves along the longest axis, again and again.
void group(std::span<std::int32_t> indices, const std::vector<Eigen::Vector3f>& points, std::size_t groups) {
  if (indices.size() < 2) return;
  Eigen::AlignedBox3f box;
  for (const std::int32_t i : indices) box.extend(points[static_cast<std::size_t>(i)]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto before = [&](std::int32_t a, std::int32_t b) {
    const float p = points[static_cast<std::size_t>(a)][axis], q = points[static_cast<std::size_t>(b)][axis];
    return p < q || (p == q && a < b);
  };
  std::sort(indices.begin(), indices.end(), before);
  // Within a group the halving goes on, so that a patch's points come in a similar order everywhere.
  const std::size_t first = groups > 1 ? groups / 2 * (indices.size() / groups) : indices.size() / 2;
  group(indices.first(first), points, std::max<std::size_t>(groups / 2, 1));
  group(indices.subspan(first), points, std::max<std::size_t>(groups - groups / 2, 1));
}

PointLayout layout_of(const CompletionTrainingSample& sample, const CompletionShape& shape) {
  if (sample.matched.empty()) return {};
  PointLayout layout = spread_over_tooth(sample.matched, sample.matched_root, shape.queries * shape.patch_points);
  group(layout, sample.matched, static_cast<std::size_t>(shape.queries));
  return layout;
}

void append(std::vector<float>& numbers, const Eigen::Vector3f& vector) {
  numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
}

/// The sample's own points of a layout; without one, patches around points spread over the target.
ToothPatches patches_of(const CompletionTrainingSample& sample, const PointLayout& layout,
                        const CompletionShape& shape) {
  ToothPatches patches;
  for (const std::int32_t index : layout) {
    append(patches.points, sample.matched[static_cast<std::size_t>(index)]);
    append(patches.normals, sample.matched_normals[static_cast<std::size_t>(index)]);
  }
  if (!layout.empty()) return patches;
  std::vector<float> middles;
  for (const std::int32_t index : spread_over_tooth(sample.target, sample.is_root, shape.queries))
    append(middles, sample.target[static_cast<std::size_t>(index)]);
  for (const std::int32_t index : nearest_keys(middles, flatten(sample.target), shape.patch_points)) {
    append(patches.points, sample.target[static_cast<std::size_t>(index)]);
    append(patches.normals, sample.normals[static_cast<std::size_t>(index)]);
  }
  return patches;
}

float depth(const CompletionTrainingSample& sample) {
  float lowest = 0;
  for (const Eigen::Vector3f& p : sample.target) lowest = std::min(lowest, p.z());
  return lowest;
}

/// Disturbed middles of patches that are drawn at random, and where the points of these patches belong.
void add_matched_seeds(const float* matched, const CompletionTrainingOptions& options, std::mt19937_64& random,
                       float* seeds, std::int64_t* seed_patches, float* patches) {
  const int each = options.shape.patch_points;
  std::uniform_int_distribution<int> patch(0, options.shape.queries - 1);
  std::normal_distribution<float> normal;
  const auto jitter = static_cast<float>(options.denoise_jitter);
  for (int s = 0; s < options.denoise_queries; ++s, seeds += 3, patches += 3 * each) {
    *seed_patches = patch(random);
    const float* points = matched + 3 * each * *seed_patches++;
    std::copy_n(points, 3 * each, patches);
    for (int axis = 0; axis < 3; ++axis) {
      seeds[axis] = jitter * normal(random);
      for (int i = 0; i < each; ++i) seeds[axis] += points[3 * i + axis] / static_cast<float>(each);
    }
  }
}

/// Disturbed target points and what a patch that starts at each of them has to become.
void add_seeds(const std::vector<float>& target, const CompletionTrainingOptions& options, std::mt19937_64& random,
               float* seeds, float* patches) {
  // Target points come in random order, so the first ones are spread like all of them.
  const auto count = static_cast<std::size_t>(options.denoise_queries);
  const std::span<const float> centres{target.data(), 3 * count};
  std::normal_distribution<float> normal;
  const auto jitter = static_cast<float>(options.denoise_jitter);
  for (std::size_t i = 0; i < 3 * count; ++i) seeds[i] = centres[i] + jitter * std::clamp(normal(random), -5.F, 5.F);
  for (const std::int32_t i : nearest_keys(centres, target, options.shape.patch_points))
    patches = std::copy_n(target.data() + 3 * static_cast<std::size_t>(i), 3, patches);
}

void reserve(TargetBatch& target, std::int64_t count, std::int64_t points, std::int64_t seeds,
             const CompletionShape& shape) {
  const std::int64_t outputs = std::int64_t{shape.queries} * shape.patch_points;
  target.points = torch::empty({count, points, 3});
  target.normals = torch::empty({count, points, 3});
  target.root = torch::empty({count, points});
  target.is_matched = torch::zeros({count});
  target.matched = torch::zeros({count, outputs, 3});
  target.matched_normals = torch::zeros({count, outputs, 3});
  target.matched_root = torch::zeros({count, outputs});
  if (seeds == 0) return;
  target.seeds = torch::empty({count, seeds, 3});
  target.seed_patches = torch::full({count, seeds}, -1, torch::kLong);
  target.denoise_target = torch::empty({count, seeds, shape.patch_points, 3});
}

void add_matches(const CompletionTrainingSample& sample, const PointLayout& layout, TargetBatch& target,
                 std::int64_t b) {
  float* points = target.matched[b].data_ptr<float>();
  float* normals = target.matched_normals[b].data_ptr<float>();
  float* root = target.matched_root[b].data_ptr<float>();
  for (const std::int32_t index : layout) {
    const auto i = static_cast<std::size_t>(index);
    if (i >= sample.matched.size())
      throw InputError("Training samples of a type differ in their corresponding points.");
    points = std::copy_n(sample.matched[i].data(), 3, points);
    normals = std::copy_n(sample.matched_normals[i].data(), 3, normals);
    *root++ = static_cast<float>(sample.matched_root[i]);
  }
  target.is_matched[b] = 1;
}

}  // namespace

void check_completion_sample(const CompletionTrainingSample& sample, const CompletionShape& shape) {
  if (sample.input.size() < static_cast<std::size_t>(shape.input_points))
    throw InputError("A training sample has fewer crown points than the network looks at.");
  if (sample.target.empty() || sample.normals.size() != sample.target.size() ||
      sample.is_root.size() != sample.target.size())
    throw InputError("A training sample's target points, normals and marks are not equally many.");
  if (!all_finite(sample.input) || !all_finite(sample.target) || !all_finite(sample.normals) ||
      !sample.form_axis.allFinite())
    throw InputError("A training sample has values that are not numbers.");
  if (sample.matched_normals.size() != sample.matched.size() || sample.matched_root.size() != sample.matched.size() ||
      !all_finite(sample.matched) || !all_finite(sample.matched_normals))
    throw InputError("A training sample's corresponding points, normals and marks do not fit together.");
  if (sample.type < 0 || sample.type > unknown_type) throw InputError("A training sample's tooth type is unknown.");
}

CompletionTrainingBatch make_completion_training_batch(const CompletionSampleProvider& provider,
                                                       const std::vector<PointLayout>& layouts, std::uint64_t first,
                                                       int count, const CompletionTrainingOptions& options,
                                                       bool training) {
  std::vector<std::vector<float>> crowns;
  std::vector<std::int64_t> types;
  std::vector<float> form_axes;
  CompletionTrainingBatch batch;
  TargetBatch& target = batch.target;
  const std::int64_t seeds = training ? options.denoise_queries : 0;
  for (int b = 0; b < count; ++b) {
    const std::uint64_t number = first + static_cast<std::uint64_t>(b);
    const CompletionTrainingSample sample = provider(number);
    check_completion_sample(sample, options.shape);
    const auto points = static_cast<std::int64_t>(sample.target.size());
    if (b == 0) reserve(target, count, points, seeds, options.shape);
    if (points != target.points.size(1)) throw InputError("Training samples differ in their number of target points.");
    if (points < std::max<std::int64_t>(seeds, options.shape.patch_points))
      throw InputError("A training sample has fewer target points than denoising queries.");
    crowns.push_back(flatten(sample.input));
    const std::vector<float> xyz = flatten(sample.target), normals = flatten(sample.normals);
    std::copy(xyz.begin(), xyz.end(), target.points[b].data_ptr<float>());
    std::copy(normals.begin(), normals.end(), target.normals[b].data_ptr<float>());
    std::copy(sample.is_root.begin(), sample.is_root.end(), target.root[b].data_ptr<float>());
    std::seed_seq sequence{options.loop.seed, number >> 32, number & 0xffffffffU};
    std::mt19937_64 random(sequence);
    const bool hide = training && std::uniform_real_distribution<double>(0, 1)(random) < options.unknown_share;
    const int type = hide ? unknown_type : sample.type;
    types.push_back(type);
    form_axes.insert(form_axes.end(), sample.form_axis.data(), sample.form_axis.data() + 2);
    // Who does not know the type cannot know which point is which either.
    const bool matched =
        type != unknown_type && !sample.matched.empty() && !layouts[static_cast<std::size_t>(type)].empty();
    if (matched) add_matches(sample, layouts[static_cast<std::size_t>(type)], target, b);
    if (seeds == 0) continue;
    float* starts = target.seeds[b].data_ptr<float>();
    float* patches = target.denoise_target[b].data_ptr<float>();
    if (matched) {
      add_matched_seeds(target.matched[b].data_ptr<float>(), options, random, starts,
                        target.seed_patches[b].data_ptr<std::int64_t>(), patches);
    } else {
      add_seeds(xyz, options, random, starts, patches);
    }
  }
  batch.crowns = make_crown_batch(options.shape, crowns, types, form_axes);
  return batch;
}

QueryLayout initial_layout(const CompletionSampleProvider& provider, const CompletionShape& shape) {
  constexpr std::size_t samples_per_type = 7;
  constexpr std::uint64_t most_samples = 300;
  std::array<std::vector<CompletionTrainingSample>, tooth_types> found;
  ToothPatches any;
  for (std::uint64_t number = 0; number < most_samples; ++number) {
    CompletionTrainingSample sample = provider(number);
    check_completion_sample(sample, shape);
    if (any.points.empty()) any = patches_of(sample, {}, shape);
    if (sample.type == unknown_type) continue;
    auto& list = found[static_cast<std::size_t>(sample.type)];
    // Where a type has samples with and without corresponding points, only the former count.
    if (!list.empty() && list.front().matched.empty() && !sample.matched.empty()) list.clear();
    const bool same_kind = list.empty() || list.front().matched.empty() == sample.matched.empty();
    if (same_kind && list.size() < samples_per_type) list.push_back(std::move(sample));
  }
  QueryLayout result;
  for (auto& list : found) {
    if (list.empty()) {
      result.patches.push_back(any);
      result.points.emplace_back();
      continue;
    }
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::nth_element(
        list.begin(), middle, list.end(),
        [](const CompletionTrainingSample& a, const CompletionTrainingSample& b) { return depth(a) < depth(b); });
    result.points.push_back(layout_of(*middle, shape));
    result.patches.push_back(patches_of(*middle, result.points.back(), shape));
  }
  ToothPatches mixed;
  const auto each = std::ptrdiff_t{3} * shape.patch_points;
  for (std::ptrdiff_t i = 0; i < shape.queries; ++i) {
    const ToothPatches& from = result.patches[static_cast<std::size_t>(i % tooth_types)];
    const auto copy = [&](const std::vector<float>& source, std::vector<float>& to) {
      to.insert(to.end(), source.begin() + each * i, source.begin() + each * (i + 1));
    };
    copy(from.points, mixed.points);
    copy(from.normals, mixed.normals);
  }
  result.patches.push_back(std::move(mixed));
  return result;
}

}  // namespace rhizodont
