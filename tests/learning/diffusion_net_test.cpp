// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "learning/diffusion_net.hpp"
#include "learning/surfaces.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using testing::surface_sample;

double largest(const torch::Tensor& tensor) { return tensor.abs().max().item<double>(); }

SurfaceShape small_shape() {
  SurfaceShape shape;
  shape.width = 12;
  shape.blocks = 2;
  return shape;
}

TEST(Diffusion, OfAWaveOnARectangleIsThatOfTheHeatEquation) {
  const TriangleMesh mesh = test::rectangle(48, 24, 2, 1);
  const SurfaceTensors surface = to_tensors(surface_sample(mesh, 40), false);
  // Positions are in units of length in which the area is 4 pi.
  const double side = 2 * std::sqrt(4 * std::numbers::pi / 2), wave = std::numbers::pi / side;
  const torch::Tensor x = surface.features.select(1, 0);
  const torch::Tensor values = torch::stack({1 + torch::cos(wave * x), torch::cos(2 * wave * x)}, 1);
  const double short_time = 0.3, long_time = 1.1;
  const torch::Tensor after = diffuse(surface, values, torch::tensor({short_time, long_time}, torch::kFloat));
  const torch::Tensor expected = torch::stack({1 + std::exp(-wave * wave * short_time) * torch::cos(wave * x),
                                               std::exp(-4 * wave * wave * long_time) * torch::cos(2 * wave * x)},
                                              1);
  EXPECT_LT(largest(after - expected), 4e-3);
  EXPECT_GT(largest(after - values), 0.05);
}

TEST(Diffusion, KeepsHeat) {
  const SurfaceTensors surface = to_tensors(surface_sample(test::bowl(12), 20), false);
  const torch::Tensor values = torch::rand({surface.mass.size(0), 3});
  const torch::Tensor after = diffuse(surface, values, torch::tensor({0.01F, 0.2F, 5.0F}));
  EXPECT_LT(largest((surface.mass * (after - values)).sum(0)), 1e-3);
}

TEST(SurfaceGradient, OfALinearFunctionHasItsLength) {
  const SurfaceTensors surface = to_tensors(surface_sample(test::rectangle(10, 8, 2, 1), 8), false);
  const torch::Tensor values = 2 * surface.features.select(1, 0) - 3 * surface.features.select(1, 1);
  const torch::Tensor gradient = surface_gradient(surface, values.unsqueeze(1));
  EXPECT_LT(largest(gradient.square().sum(1) - 13), 1e-2);
}

TEST(SurfaceGradient, BackwardIsTheTransposed) {
  const SurfaceTensors surface = to_tensors(surface_sample(test::bowl(9), 8), false);
  const std::int64_t n = surface.mass.size(0);
  torch::Tensor x = torch::randn({n, 5}).requires_grad_();
  const torch::Tensor weights = torch::randn({n, 10}), y = torch::randn({n, 5});
  const torch::Tensor gradient = torch::autograd::grad({(surface_gradient(surface, x) * weights).sum()}, {x})[0];
  // <G y, w> = <y, G^T w>
  const double left = (surface_gradient(surface, y) * weights).sum().item<double>();
  EXPECT_NEAR((gradient * y).sum().item<double>(), left, 1e-3 * std::max(1.0, std::abs(left)));
}

TEST(DiffusionBlock, GradientFeaturesDoNotDependOnTheTangentPlanesAxes) {
  torch::manual_seed(3);
  DiffusionBlock block(6);
  SurfaceTensors surface = to_tensors(surface_sample(test::bowl(10), 16), false);
  const torch::Tensor values = torch::randn({surface.mass.size(0), 6});
  const torch::Tensor before = block->gradient_features(surface, values);
  // Another axis at each vertex: the rows of both gradients turn together.
  const auto n = surface.mass.size(0);
  const std::int32_t* first = surface.first.data_ptr<std::int32_t>();
  torch::Tensor x = surface.gradient_x.clone(), y = surface.gradient_y.clone();
  for (std::int64_t v = 0; v < n; ++v) {
    const auto angle = static_cast<float>(2.3 * static_cast<double>(v));
    for (std::int32_t e = first[v]; e < first[v + 1]; ++e) {
      const float gx = surface.gradient_x.data_ptr<float>()[e], gy = surface.gradient_y.data_ptr<float>()[e];
      x.data_ptr<float>()[e] = std::cos(angle) * gx + std::sin(angle) * gy;
      y.data_ptr<float>()[e] = std::cos(angle) * gy - std::sin(angle) * gx;
    }
  }
  surface.gradient_x = x;
  surface.gradient_y = y;
  EXPECT_LT(largest(block->gradient_features(surface, values) - before), 1e-4);
  EXPECT_GT(largest(before), 0.1);
}

TEST(DiffusionNet, OutputFollowsTheOrderOfVertices) {
  torch::manual_seed(4);
  DiffusionNet network(small_shape());
  const TriangleMesh mesh = test::bowl(8);  // 81 vertices
  const auto moved = [](int v) { return (v * 7 + 5) % 81; };
  TriangleMesh shuffled = mesh;
  for (int v = 0; v < 81; ++v)
    shuffled.vertices[static_cast<std::size_t>(moved(v))] = mesh.vertices[static_cast<std::size_t>(v)];
  for (Triangle& t : shuffled.triangles) t = {moved(t[0]), moved(t[1]), moved(t[2])};
  torch::NoGradGuard no_gradient;
  const torch::Tensor a = network->forward(to_tensors(surface_sample(mesh, 24), false));
  const torch::Tensor b = network->forward(to_tensors(surface_sample(shuffled, 24), false));
  for (int v = 0; v < 81; ++v) EXPECT_NEAR(a[v].item<double>(), b[moved(v)].item<double>(), 1e-3);
  EXPECT_GT(a.std().item<double>(), 1e-3);
}

TEST(DiffusionNet, OutputStaysWithRemeshing) {
  torch::manual_seed(5);
  DiffusionNet network(small_shape());
  torch::NoGradGuard no_gradient;
  const torch::Tensor coarse = network->forward(to_tensors(surface_sample(test::bowl(20), 24), false));
  const torch::Tensor fine = network->forward(to_tensors(surface_sample(test::bowl(40), 24), false));
  double sum = 0;
  for (int j = 0; j <= 20; ++j)
    for (int i = 0; i <= 20; ++i)
      sum += std::abs(coarse[j * 21 + i].item<double>() - fine[2 * j * 41 + 2 * i].item<double>());
  EXPECT_LT(sum / 441, 0.1 * coarse.std().item<double>());
}

TEST(DiffusionNet, LooksAtItsInputsOnly) {
  torch::manual_seed(6);
  SurfaceShape shape = small_shape();
  shape.position = shape.surroundings = false;
  DiffusionNet network(shape);
  SurfaceTensors surface = to_tensors(surface_sample(test::bowl(8), 16), false);
  torch::NoGradGuard no_gradient;
  const torch::Tensor before = network->forward(surface);
  surface.features = surface.features.clone();
  surface.features.slice(1, 0, SurfaceFeature::signature).add_(1);
  EXPECT_EQ(largest(network->forward(surface) - before), 0);
  surface.features.slice(1, SurfaceFeature::signature, surface_feature_count).add_(1);
  EXPECT_GT(largest(network->forward(surface) - before), 0);
  shape.signature = false;
  EXPECT_THROW(DiffusionNet{shape}, UsageError);
}

TEST(SurfaceSample, ThatDoesNotFitIsRefused) {
  const SurfaceSample good = surface_sample(test::bowl(6), 8);
  EXPECT_NO_THROW(check_surface_sample(good, true));
  SurfaceSample bad = good;
  bad.features.pop_back();
  EXPECT_THROW(check_surface_sample(bad, false), InputError);
  bad = good;
  bad.neighbours[3] = bad.vertices;
  EXPECT_THROW(check_surface_sample(bad, false), InputError);
  bad = good;
  bad.basis[0] = std::nanf("");
  EXPECT_THROW(check_surface_sample(bad, false), InputError);
  bad = good;
  bad.labels.clear();
  EXPECT_THROW(check_surface_sample(bad, true), InputError);
  EXPECT_NO_THROW(check_surface_sample(bad, false));
}

}  // namespace
}  // namespace rhizodont
