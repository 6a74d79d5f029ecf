// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/losses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learning/optimiser.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// Weighted Chamfer-L1 over full distance tables, in double.
double brute_chamfer(const torch::Tensor& predicted, const torch::Tensor& target, const torch::Tensor& weights) {
  const torch::Tensor table = torch::cdist(predicted.to(torch::kDouble), target.to(torch::kDouble), 2, 2);
  const auto [forth, closest] = table.min(2);
  const torch::Tensor back = std::get<0>(table.min(1)), w = weights.to(torch::kDouble);
  const torch::Tensor shares = w.gather(1, closest);
  return 0.5 * ((forth * shares).sum() / shares.sum() + (back * w).sum() / w.sum()).item<double>();
}

TEST(Losses, ChamferAgreesWithFullTables) {
  torch::manual_seed(1);
  const torch::Tensor predicted = torch::randn({3, 50, 3}), target = torch::randn({3, 70, 3});
  const torch::Tensor weights = 1 + 2 * (torch::rand({3, 70}) > 0.5).to(torch::kFloat);
  const torch::Tensor loss = weighted_chamfer(predicted, target, weights, closest_points(predicted, target));
  ASSERT_EQ(loss.sizes(), (torch::IntArrayRef{3}));
  for (int b = 0; b < 3; ++b) {
    const double expected = brute_chamfer(predicted.narrow(0, b, 1), target.narrow(0, b, 1), weights.narrow(0, b, 1));
    EXPECT_NEAR(loss[b].item<double>(), expected, 1e-5);
  }
}

TEST(Losses, ChamferOfAShiftedPointPair) {
  const torch::Tensor predicted = torch::zeros({1, 1, 3});
  const torch::Tensor target = torch::tensor({{{3.0F, 4.0F, 0.0F}}});
  EXPECT_NEAR(
      weighted_chamfer(predicted, target, torch::ones({1, 1}), closest_points(predicted, target)).item<double>(), 5,
      1e-6);
}

TEST(Losses, WeightsPullTowardsTheRoot) {
  // Two target points, one prediction on each side: an error at the root counts three times.
  const torch::Tensor target = torch::tensor({{{0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, -9.0F}}});
  const torch::Tensor at_crown = torch::tensor({{{1.0F, 0.0F, 0.0F}, {0.0F, 0.0F, -9.0F}}});
  const torch::Tensor at_root = torch::tensor({{{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, -9.0F}}});
  const torch::Tensor weights = torch::tensor({{1.0F, 3.0F}});
  const auto loss = [&](const torch::Tensor& p) {
    return weighted_chamfer(p, target, weights, closest_points(p, target)).item<double>();
  };
  EXPECT_NEAR(loss(at_crown), 0.25, 1e-3);
  EXPECT_NEAR(loss(at_root), 0.75, 1e-3);
}

TEST(Losses, ChamferGradientIsFiniteWherePointsCoincide) {
  torch::Tensor predicted = torch::zeros({1, 4, 3}, torch::requires_grad());
  const torch::Tensor target = torch::zeros({1, 4, 3});
  weighted_chamfer(predicted, target, torch::ones({1, 4}), closest_points(predicted, target)).backward();
  EXPECT_TRUE(torch::isfinite(predicted.grad()).all().item<bool>());
}

TEST(Losses, ChamferGradientAgreesWithDifferences) {
  torch::manual_seed(2);
  torch::Tensor predicted = torch::randn({1, 6, 3}, torch::requires_grad());
  const torch::Tensor target = torch::randn({1, 9, 3}), weights = torch::rand({1, 9}) + 0.5;
  weighted_chamfer(predicted, target, weights, closest_points(predicted, target)).backward();
  const double h = 1e-3;
  for (int i = 0; i < 18; ++i) {
    torch::Tensor up = predicted.detach().clone(), down = up.clone();
    up.view(-1)[i] += h;
    down.view(-1)[i] -= h;
    const double slope = (brute_chamfer(up, target, weights) - brute_chamfer(down, target, weights)) / (2 * h);
    EXPECT_NEAR(predicted.grad().view(-1)[i].item<double>(), slope, 2e-3);
  }
}

TEST(Losses, PatchChamferIsTheMeanOverPatches) {
  torch::manual_seed(3);
  const torch::Tensor predicted = torch::randn({2, 3, 5, 3}), target = torch::randn({2, 3, 5, 3});
  const torch::Tensor loss = patch_chamfer(predicted, target);
  for (int b = 0; b < 2; ++b) {
    double sum = 0;
    for (int p = 0; p < 3; ++p)
      sum += brute_chamfer(predicted[b][p].unsqueeze(0), target[b][p].unsqueeze(0), torch::ones({1, 5}));
    EXPECT_NEAR(loss[b].item<double>(), sum / 3, 1e-5);
  }
}

/// A batch of two: the first sample with known correspondence, the second without.
struct Truth {
  TargetBatch target;
  Prediction perfect;

  Truth() {
    torch::manual_seed(4);
    target.points = torch::randn({2, 40, 3});
    const torch::Tensor directions = torch::randn({2, 40, 3});
    target.normals = directions / directions.norm(2, -1, true);
    target.root = (torch::arange(40) < 20).to(torch::kFloat).expand({2, 40}).contiguous();
    target.is_matched = torch::tensor({1.0F, 0.0F});
    target.matched = target.points.clone();
    target.matched_normals = target.normals.clone();
    target.matched_root = target.root.clone();
    perfect.fine = target.points.clone();
    perfect.normals = target.normals.clone();
    perfect.spread = torch::full({2, 40}, -3.0);
    // queries of two points each for the first sample, points of the target for the second
    perfect.coarse = target.points.view({2, 20, 2, 3}).mean(2);
    perfect.coarse[1].copy_(target.points[1].narrow(0, 0, 20));
  }

  LossTerms loss(const Prediction& prediction) const {
    return completion_loss(prediction, target, CompletionTrainingOptions());
  }
};

TEST(Losses, PerfectPredictionCostsNothing) {
  const Truth truth;
  const LossTerms terms = truth.loss(truth.perfect);
  EXPECT_LT(terms.match.item<double>(), 2e-4);
  EXPECT_LT(terms.chamfer.item<double>(), 2e-4);
  EXPECT_LT(terms.normal.item<double>(), 1e-5);
  Prediction inside_out = truth.perfect;
  inside_out.normals = -truth.perfect.normals;
  EXPECT_NEAR(truth.loss(inside_out).normal.item<double>(), 2, 1e-5);
}

TEST(Losses, OrderMattersOnlyWhereItIsKnown) {
  const Truth truth;
  for (const int sample : {0, 1}) {
    Prediction swapped = truth.perfect;
    swapped.fine = truth.perfect.fine.clone();
    swapped.normals = truth.perfect.normals.clone();
    swapped.fine[sample].copy_(truth.perfect.fine[sample].flip(0));
    swapped.normals[sample].copy_(truth.perfect.normals[sample].flip(0));
    const LossTerms terms = truth.loss(swapped);
    EXPECT_LT(terms.chamfer.item<double>(), 2e-4);
    if (sample == 0) {
      EXPECT_GT(terms.match.item<double>(), 0.5);
      EXPECT_GT(terms.normal.item<double>(), 0.1);
    } else {
      EXPECT_LT(terms.match.item<double>(), 2e-4);
      EXPECT_LT(terms.normal.item<double>(), 1e-5);
    }
  }
}

TEST(Losses, MatchedRootPointsWeighThreefold) {
  const Truth truth;
  const auto moved = [&](int point) {
    Prediction prediction = truth.perfect;
    prediction.fine = truth.perfect.fine.clone();
    prediction.fine[0][point][0] += 1;
    return truth.loss(prediction).match.item<double>();
  };
  // 20 points of weight 3 and 20 of weight 1
  EXPECT_NEAR(moved(5), 3.0 / 80, 2e-4);
  EXPECT_NEAR(moved(30), 1.0 / 80, 2e-4);
}

TEST(Losses, ExpectedDistanceIsBestAtTheMeanDistance) {
  const Truth truth;
  // half of the first sample's points are 0.1 off, half 0.3; the second sample has no correspondence and no say
  Prediction prediction = truth.perfect;
  prediction.fine = truth.perfect.fine.clone();
  prediction.fine[0].select(1, 0) += torch::where(torch::arange(40) < 20, 0.1, 0.3);
  const auto cost = [&](double first, double second) {
    prediction.spread =
        torch::tensor({std::log(first), std::log(second)}).to(torch::kFloat).unsqueeze(1).expand({2, 40});
    return truth.loss(prediction).spread.item<double>();
  };
  EXPECT_LT(cost(0.2, 1), cost(0.19, 1));
  EXPECT_LT(cost(0.2, 1), cost(0.21, 1));
  EXPECT_NEAR(cost(0.2, 1), 1 + std::log(0.2), 1e-3);
  EXPECT_EQ(cost(0.2, 1), cost(0.2, 7));
}

TEST(Losses, DenoisingComparesInOrderWhereItIsKnown) {
  Truth truth;
  truth.target.denoise_target = torch::randn({2, 3, 4, 3});
  Prediction prediction = truth.perfect;
  prediction.denoised = truth.target.denoise_target.clone();
  EXPECT_LT(truth.loss(prediction).denoise.item<double>(), 2e-4);
  prediction.denoised[1].copy_(truth.target.denoise_target[1].flip(1));
  EXPECT_LT(truth.loss(prediction).denoise.item<double>(), 2e-4);
  prediction.denoised[0].copy_(truth.target.denoise_target[0].flip(1));
  EXPECT_GT(truth.loss(prediction).denoise.item<double>(), 0.1);
}

TEST(Losses, GatherRows) {
  const torch::Tensor points = torch::arange(2 * 3 * 2, torch::kFloat).view({2, 3, 2});
  const torch::Tensor indices = torch::tensor({{2L, 0L}, {1L, 1L}});
  const torch::Tensor expected = torch::tensor({{{4.0F, 5.0F}, {0.0F, 1.0F}}, {{8.0F, 9.0F}, {8.0F, 9.0F}}});
  EXPECT_TRUE(torch::equal(layers::gather_rows(points, indices), expected));
}

/// One parameter with the optimiser's state.
std::vector<TrainedTensor> one_tensor(const torch::Tensor& value, bool decays) {
  return {{"w", value, torch::zeros_like(value), torch::zeros_like(value), value.clone(), decays}};
}

TEST(Optimiser, FirstStepMovesEachWeightByTheRate) {
  // After bias correction the first step of Adam is rate * sign(gradient).
  auto tensors = one_tensor(torch::tensor({1.0F, 2.0F, 3.0F}), false);
  StepOptions step;
  step.learning_rate = 0.1;
  step.clip = 1e9;
  const double norm = adamw_step(tensors, {torch::tensor({3.0F, -4.0F, 0.0F})}, step);
  EXPECT_NEAR(norm, 5, 1e-6);
  EXPECT_TRUE(torch::allclose(tensors[0].value, torch::tensor({0.9F, 2.1F, 3.0F}), 0, 1e-6));
  EXPECT_TRUE(torch::allclose(tensors[0].average, torch::tensor({0.99F, 2.01F, 3.0F}), 0, 1e-6));
}

TEST(Optimiser, DecayShrinksWithoutGradient) {
  auto tensors = one_tensor(torch::tensor({2.0F}), true);
  StepOptions step;
  step.learning_rate = 0.1;
  step.weight_decay = 0.5;
  adamw_step(tensors, {torch::Tensor()}, step);
  EXPECT_NEAR(tensors[0].value.item<double>(), 2 * (1 - 0.05), 1e-6);
}

TEST(Optimiser, ClippingKeepsTheMoments) {
  auto tensors = one_tensor(torch::tensor({0.0F, 0.0F}), false);
  StepOptions step;
  step.clip = 1;
  adamw_step(tensors, {torch::tensor({30.0F, 40.0F})}, step);
  EXPECT_TRUE(torch::allclose(tensors[0].mean, torch::tensor({0.06F, 0.08F}), 0, 1e-6));
}

TEST(Optimiser, RefusesGradientsThatAreNotNumbers) {
  auto tensors = one_tensor(torch::tensor({0.0F}), false);
  EXPECT_THROW(adamw_step(tensors, {torch::tensor({std::numeric_limits<float>::quiet_NaN()})}, StepOptions()),
               NoResultError);
}

TEST(Optimiser, FindsTheMinimumOfABowl) {
  auto tensors = one_tensor(torch::tensor({4.0F, -3.0F}), false);
  const torch::Tensor goal = torch::tensor({1.0F, 2.0F});
  StepOptions step;
  step.clip = 1e9;
  for (step.step = 1; step.step <= 600; ++step.step) {
    step.learning_rate = 0.05 * (1 - static_cast<double>(step.step) / 601);
    adamw_step(tensors, {2 * (tensors[0].value - goal)}, step);
  }
  EXPECT_TRUE(torch::allclose(tensors[0].value, goal, 0, 1e-2));
}

}  // namespace
}  // namespace rhizodont
