// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/adapointr.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "learning/capsules.hpp"
#include "learning/completion_training_batch.hpp"
#include "learning/losses.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using layers::Precision;

const std::vector<PointLayout>& tiny_layouts() {
  static const std::vector<PointLayout> layouts = initial_layout(testing::tiny_sample, testing::tiny_shape()).points;
  return layouts;
}

CompletionTrainingBatch tiny_batch(int count = 3) {
  return make_completion_training_batch(testing::tiny_sample, tiny_layouts(), 0, count, testing::tiny_options(), true);
}

TEST(AdaPoinTr, Shapes) {
  torch::manual_seed(1);
  const CompletionShape shape = testing::tiny_shape();
  AdaPoinTr network(shape);
  const CompletionTrainingBatch batch = tiny_batch();
  const Prediction p = network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, Precision::single);
  EXPECT_EQ(p.coarse.sizes(), (torch::IntArrayRef{3, 24, 3}));
  EXPECT_EQ(p.fine.sizes(), (torch::IntArrayRef{3, 96, 3}));
  EXPECT_EQ(p.normals.sizes(), (torch::IntArrayRef{3, 96, 3}));
  EXPECT_EQ(p.spread.sizes(), (torch::IntArrayRef{3, 96}));
  EXPECT_EQ(p.denoised.sizes(), (torch::IntArrayRef{3, 8, 4, 3}));
  EXPECT_TRUE(torch::allclose(p.normals.norm(2, -1), torch::ones({3, 96}), 0, 1e-3));
  EXPECT_FALSE(network->forward(batch.crowns, {}, {}, Precision::single).denoised.defined());
}

TEST(AdaPoinTr, DenoisingQueriesDoNotLeak) {
  torch::manual_seed(2);
  AdaPoinTr network(testing::tiny_shape());
  const CompletionTrainingBatch batch = tiny_batch();
  const Prediction with =
      network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, Precision::single);
  const Prediction without = network->forward(batch.crowns, {}, {}, Precision::single);
  const Prediction moved =
      network->forward(batch.crowns, batch.target.seeds + 0.3, batch.target.seed_patches, Precision::single);
  for (const auto& other : {without, moved}) {
    EXPECT_TRUE(torch::allclose(with.coarse, other.coarse, 0, 1e-5));
    EXPECT_TRUE(torch::allclose(with.fine, other.fine, 0, 1e-5));
    EXPECT_TRUE(torch::allclose(with.normals, other.normals, 0, 1e-4));
  }
  EXPECT_FALSE(torch::allclose(with.denoised - batch.target.seeds.unsqueeze(2),
                               moved.denoised - (batch.target.seeds + 0.3).unsqueeze(2), 0, 1e-4));
}

TEST(AdaPoinTr, SamplesOfABatchDoNotMix) {
  torch::manual_seed(3);
  AdaPoinTr network(testing::tiny_shape());
  const Prediction together = network->forward(tiny_batch(3).crowns, {}, {}, Precision::single);
  const Prediction alone = network->forward(tiny_batch(1).crowns, {}, {}, Precision::single);
  EXPECT_TRUE(torch::allclose(together.fine[0], alone.fine[0], 0, 1e-5));
}

TEST(AdaPoinTr, GradientReachesEveryParameter) {
  torch::manual_seed(4);
  AdaPoinTr network(testing::tiny_shape());
  // All types, so that no row of the tables per type is left out.
  const CompletionTrainingOptions options = testing::tiny_options();
  const CompletionTrainingBatch batch =
      make_completion_training_batch(testing::tiny_sample, tiny_layouts(), 0, 17, options, true);
  batch.crowns.types.copy_(torch::arange(17));
  batch.crowns.form_axes.uniform_(-0.2, 0.2);
  const Prediction p = network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, Precision::single);
  completion_loss(p, batch.target, options).total.backward();
  for (const auto& item : network->named_parameters()) {
    ASSERT_TRUE(item.value().grad().defined()) << item.key();
    EXPECT_GT(item.value().grad().abs().max().item<double>(), 1e-9) << item.key();
  }
  EXPECT_GT(std::get<0>(network->patches.grad().abs().flatten(1).max(1)).min().item<double>(), 0);
}

TEST(AdaPoinTr, BatchesHaveTheAxesOfTheirSamples) {
  const CompletionSampleProvider provider = [](std::uint64_t index) {
    CompletionTrainingSample sample = testing::tiny_sample(index);
    sample.form_axis = {0.01F * static_cast<float>(index), -0.1F};
    return sample;
  };
  const CompletionTrainingBatch batch =
      make_completion_training_batch(provider, tiny_layouts(), 5, 3, testing::tiny_options(), true);
  for (int b = 0; b < 3; ++b) {
    EXPECT_FLOAT_EQ(batch.crowns.form_axes[b][0].item<float>(), 0.01F * static_cast<float>(5 + b));
    EXPECT_FLOAT_EQ(batch.crowns.form_axes[b][1].item<float>(), -0.1F);
  }
}

TEST(AdaPoinTr, AxisOfTheFormMovesItsOwnCrownAlone) {
  torch::manual_seed(6);
  AdaPoinTr network(testing::tiny_shape());
  CompletionTrainingBatch batch = tiny_batch();
  const Prediction before = network->forward(batch.crowns, {}, {}, Precision::single);
  batch.crowns.form_axes[1][0] = 0.1;
  const Prediction after = network->forward(batch.crowns, {}, {}, Precision::single);
  EXPECT_TRUE(torch::equal(before.fine[0], after.fine[0]));
  EXPECT_GT((before.fine[1] - after.fine[1]).abs().max().item<double>(), 1e-5);
}

TEST(AdaPoinTr, ExpectedDistancesMoveNothingElse) {
  torch::manual_seed(4);
  AdaPoinTr network(testing::tiny_shape());
  const CompletionTrainingBatch batch = tiny_batch();
  const Prediction p = network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, Precision::single);
  completion_loss(p, batch.target, testing::tiny_options()).spread.backward();
  for (const auto& item : network->named_parameters()) {
    if (item.key().starts_with("head_spread"))
      EXPECT_GT(item.value().grad().abs().max().item<double>(), 1e-9) << item.key();
    else
      EXPECT_FALSE(item.value().grad().defined()) << item.key();
  }
}

TEST(AdaPoinTr, CrownsDoNotDependOnTheOrderOfTheirPoints) {
  const CompletionShape shape = testing::tiny_shape();
  const CompletionTrainingSample sample = testing::capsule(5, 80, 10);
  std::vector<float> given, shuffled;
  std::vector<std::size_t> order(80);
  std::iota(order.begin(), order.end(), 0);
  for (const std::size_t i : order) given.insert(given.end(), sample.input[i].data(), sample.input[i].data() + 3);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  for (const std::size_t i : order) shuffled.insert(shuffled.end(), sample.input[i].data(), sample.input[i].data() + 3);
  const CrownBatch a = make_crown_batch(shape, {given}, {3}, {0, 0}),
                   b = make_crown_batch(shape, {shuffled}, {3}, {0, 0});
  EXPECT_TRUE(torch::equal(a.points, b.points));
  EXPECT_TRUE(torch::equal(a.near_input, b.near_input));
  EXPECT_TRUE(torch::equal(a.near_2, b.near_2));
}

TEST(AdaPoinTr, TypeMatters) {
  torch::manual_seed(5);
  AdaPoinTr network(testing::tiny_shape());
  CompletionTrainingBatch batch = tiny_batch(1);
  batch.crowns.types.fill_(2);
  const torch::Tensor one = network->forward(batch.crowns, {}, {}, Precision::single).coarse;
  batch.crowns.types.fill_(unknown_type);
  EXPECT_FALSE(torch::allclose(one, network->forward(batch.crowns, {}, {}, Precision::single).coarse));
}

TEST(AdaPoinTr, HalfPrecisionIsClose) {
  if (!layers::half_is_fast()) GTEST_SKIP() << "this processor multiplies bfloat16 slowly";
  torch::manual_seed(6);
  AdaPoinTr network(testing::tiny_shape());
  const CompletionTrainingBatch batch = tiny_batch();
  const torch::Tensor single = network->forward(batch.crowns, {}, {}, Precision::single).fine;
  const torch::Tensor half = network->forward(batch.crowns, {}, {}, Precision::half).fine;
  EXPECT_LT((single - half).abs().max().item<double>(), 0.05);
}

TEST(Layers, GatherMaxAgreesWithLoops) {
  torch::manual_seed(7);
  torch::Tensor values = torch::randn({2, 5, 3}, torch::requires_grad());
  const torch::Tensor neighbours = torch::randint(0, 5, {2, 4, 3}, torch::kInt);
  const torch::Tensor result = layers::gather_max(values, neighbours);
  torch::Tensor expected = torch::zeros({2, 4, 3});
  for (int b = 0; b < 2; ++b) {
    for (int q = 0; q < 4; ++q)
      expected[b][q] = std::get<0>(values[b].index_select(0, neighbours[b][q].to(torch::kLong)).max(0));
  }
  EXPECT_TRUE(torch::equal(result, expected));
  const torch::Tensor weights = torch::randn({2, 4, 3});
  const torch::Tensor own = torch::autograd::grad({(result * weights).sum()}, {values})[0];
  const torch::Tensor reference = torch::autograd::grad({(expected * weights).sum()}, {values})[0];
  EXPECT_TRUE(torch::allclose(own, reference, 0, 1e-6));
}

TEST(Layers, EdgeConvolutionEqualsItsDefinition) {
  torch::manual_seed(8);
  layers::EdgeConv conv(4, 6, false);
  const torch::Tensor keys = torch::randn({1, 7, 4}), queries = torch::randn({1, 3, 4});
  const torch::Tensor neighbours = torch::randint(0, 7, {1, 3, 5}, torch::kInt);
  // With W1 the neighbours' weights and W2 = W_centre + W1: max over j of LeakyReLU(W1 (f_j - g) + W2 g + b).
  const torch::Tensor w1 = conv->neighbour->weight, w2 = conv->centre->weight + w1, bias = conv->centre->bias;
  torch::Tensor expected = torch::zeros({1, 3, 6});
  for (int q = 0; q < 3; ++q) {
    const torch::Tensor f = keys[0].index_select(0, neighbours[0][q].to(torch::kLong)), g = queries[0][q];
    const torch::Tensor edges = torch::leaky_relu((f - g).matmul(w1.t()) + g.matmul(w2.t()).unsqueeze(0) + bias, 0.2);
    expected[0][q] = std::get<0>(edges.max(0));
  }
  EXPECT_TRUE(torch::allclose(conv->forward(keys, queries, neighbours, Precision::single), expected, 0, 1e-5));
}

TEST(Layers, AttentionEqualsItsDefinition) {
  torch::manual_seed(9);
  layers::Attention attention(8, 2);
  const torch::Tensor queries = torch::randn({2, 3, 8}), memory = torch::randn({2, 5, 8});
  const torch::Tensor q = attention->to_query->forward(queries, Precision::single);
  const torch::Tensor kv = attention->to_memory->forward(memory, Precision::single);
  std::vector<torch::Tensor> heads;
  for (int h = 0; h < 2; ++h) {
    const torch::Tensor k = kv.narrow(2, 4 * h, 4), v = kv.narrow(2, 8 + 4 * h, 4);
    heads.push_back(torch::softmax(q.narrow(2, 4 * h, 4).matmul(k.transpose(1, 2)) / 2, -1).matmul(v));
  }
  const torch::Tensor expected = attention->to_output->forward(torch::cat(heads, -1), Precision::single);
  EXPECT_TRUE(torch::allclose(attention->forward(queries, memory, Precision::single), expected, 0, 1e-5));
}

TEST(Layers, IsolatedQueriesSeeOnlyTheFirstEntries) {
  torch::manual_seed(10);
  layers::Attention attention(8, 2);
  torch::Tensor x = torch::randn({1, 6, 8});
  const torch::Tensor before = attention->forward(x, x, Precision::single, 4);
  x = x.clone();
  x[0][5] += 1;
  const torch::Tensor after = attention->forward(x, x, Precision::single, 4);
  EXPECT_TRUE(torch::allclose(before.narrow(1, 0, 4), after.narrow(1, 0, 4), 0, 1e-6));
  EXPECT_FALSE(torch::allclose(before[0][4], after[0][4], 0, 1e-4));
}

TEST(CompletionTrainingBatch, RefusesSamplesThatCannotBeUsed) {
  const CompletionShape shape = testing::tiny_shape();
  const CompletionTrainingSample good = testing::tiny_sample(1);
  EXPECT_NO_THROW(check_completion_sample(good, shape));
  CompletionTrainingSample bad = good;
  bad.input.pop_back();
  EXPECT_THROW(check_completion_sample(bad, shape), InputError);
  bad = good;
  bad.normals.pop_back();
  EXPECT_THROW(check_completion_sample(bad, shape), InputError);
  bad = good;
  bad.target[3].x() = std::numeric_limits<float>::infinity();
  EXPECT_THROW(check_completion_sample(bad, shape), InputError);
  bad = good;
  bad.matched_normals.pop_back();
  EXPECT_THROW(check_completion_sample(bad, shape), InputError);
  bad = good;
  bad.type = 17;
  EXPECT_THROW(check_completion_sample(bad, shape), InputError);
}

TEST(CompletionTrainingBatch, PatchesLieOnTheTooth) {
  const QueryLayout layout = initial_layout(testing::tiny_sample, testing::tiny_shape());
  ASSERT_EQ(layout.patches.size(), 17U);
  ASSERT_EQ(layout.points.size(), 16U);
  for (const ToothPatches& patches : layout.patches) {
    ASSERT_EQ(patches.points.size(), 3U * 96);
    ASSERT_EQ(patches.normals.size(), 3U * 96);
    int below = 0;
    for (std::size_t i = 0; i < 96; ++i) {
      below += patches.points[3 * i + 2] < -0.2F;
      EXPECT_NEAR(std::hypot(patches.normals[3 * i], patches.normals[3 * i + 1]), 1, 1e-5);
    }
    EXPECT_GE(below, 40);
    EXPECT_LT(below, 96);
  }
}

TEST(AdaPoinTr, StartsFromTheTypesTooth) {
  torch::manual_seed(11);
  AdaPoinTr network(testing::tiny_shape());
  const QueryLayout layout = initial_layout(testing::tiny_sample, testing::tiny_shape());
  for (int type = 0; type <= unknown_type; ++type) {
    const ToothPatches& patches = layout.patches[static_cast<std::size_t>(type)];
    network->set_patches(type, patches.points, patches.normals);
  }
  EXPECT_THROW(network->set_patches(17, layout.patches[0].points, layout.patches[0].normals), UsageError);
  EXPECT_THROW(network->set_patches(0, layout.patches[0].points, std::vector<float>(3)), UsageError);
  const CompletionTrainingBatch batch = tiny_batch(1);
  const Prediction p = network->forward(batch.crowns, batch.target.seeds, batch.target.seed_patches, Precision::single);
  const auto type = batch.crowns.types[0].item<std::int64_t>();
  // what an untrained head adds is small beside the tooth, once the bend of the queries is taken away
  const torch::Tensor tooth = network->patches[type];
  const torch::Tensor bend = (p.coarse[0] - tooth.mean(1)).unsqueeze(1);
  EXPECT_LT((p.fine[0].view({24, 4, 3}) - tooth - bend).abs().max().item<double>(), 0.3);
  EXPECT_GT((p.normals[0].view({24, 4, 3}) * network->patch_normals[type]).sum(-1).mean().item<double>(), 0.9);
  // a seed brings its patch's points along
  const torch::Tensor patch = batch.target.seed_patches[0];
  ASSERT_GE(patch.min().item<std::int64_t>(), 0);
  const torch::Tensor own = tooth.index_select(0, patch);
  const torch::Tensor offsets = own - own.mean(1, true);
  EXPECT_LT((p.denoised[0] - batch.target.seeds[0].unsqueeze(1) - offsets).abs().max().item<double>(), 0.3);
}

TEST(CompletionTrainingBatch, LayoutGroupsDistinctNeighbours) {
  const QueryLayout layout = initial_layout(testing::tiny_sample, testing::tiny_shape());
  const CompletionTrainingSample sample = testing::tiny_sample(16 + 3);
  for (std::size_t type = 0; type < 16; ++type) EXPECT_EQ(layout.points[type].size(), type < 8 ? 96U : 0U);
  const PointLayout& points = layout.points[3];
  EXPECT_EQ(std::set<std::int32_t>(points.begin(), points.end()).size(), 96U);
  for (std::size_t patch = 0; patch < 24; ++patch) {
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < 4; ++i) box.extend(sample.matched[static_cast<std::size_t>(points[4 * patch + i])]);
    EXPECT_LT(box.diagonal().norm(), 0.7F);  // the tube itself is more than 1.2 long
  }
}

TEST(CompletionTrainingBatch, MatchesAreTheSamplesOwnPoints) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.unknown_share = 0;
  const CompletionTrainingBatch batch =
      make_completion_training_batch(testing::tiny_sample, tiny_layouts(), 0, 10, options, true);
  for (int b = 0; b < 10; ++b) {
    ASSERT_EQ(batch.target.is_matched[b].item<float>(), b < 8 ? 1.0F : 0.0F);
    if (b >= 8) continue;
    const CompletionTrainingSample sample = testing::tiny_sample(static_cast<std::uint64_t>(b));
    const PointLayout& layout = tiny_layouts()[static_cast<std::size_t>(b)];
    for (int i = 0; i < 96; ++i) {
      const auto v = static_cast<std::size_t>(layout[static_cast<std::size_t>(i)]);
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(batch.target.matched[b][i][axis].item<float>(), sample.matched[v][axis]);
      EXPECT_EQ(batch.target.matched_root[b][i].item<float>(), static_cast<float>(sample.matched_root[v]));
    }
    // each denoising seed lies near the middle of its patch
    const torch::Tensor middles = batch.target.denoise_target[b].mean(1);
    EXPECT_LT((middles - batch.target.seeds[b]).norm(2, -1).max().item<double>(), 0.3);
  }
}

TEST(CompletionTrainingBatch, HidesTypesInTrainingOnly) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.unknown_share = 0.5;
  const auto hidden = [&](bool training) {
    return (make_completion_training_batch(testing::tiny_sample, tiny_layouts(), 0, 64, options, training)
                .crowns.types == unknown_type)
        .sum()
        .item<std::int64_t>();
  };
  EXPECT_GT(hidden(true), 16);
  EXPECT_LT(hidden(true), 48);
  EXPECT_EQ(hidden(false), 0);
}

}  // namespace
}  // namespace rhizodont
