// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/surface_network.hpp"

#include "common/temporary_folder.hpp"
#include "networks/diffusion_net.hpp"
#include "networks/sample_inputs.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace rhizodont {
namespace {

/// Two vertices; the eigenvectors are the two values themselves.
SurfaceSample two_vertices() {
  SurfaceSample s;
  s.vertices = 2;
  s.eigenvectors = 2;
  s.features.assign(2 * surface_feature_count, 0.5F);
  s.mass = {1, 1};
  s.eigenvalues = {0, std::log(2.0F)};
  s.basis = {1, 0, 0, 1};
  s.first = {0, 2, 3};
  s.neighbours = {0, 1, 1};
  s.gradient_x = {-1, 1, 3};
  s.gradient_y = {2, 0, -1};
  return s;
}

TEST(DiffusionLayers, HeatOfAnEigenvectorHalves) {
  networks::Matrix values(2, 2);
  values << 3, 5, 8, 16;
  const networks::Matrix after = networks::diffuse(two_vertices(), values, Eigen::RowVector2f(1, 2));
  networks::Matrix expected(2, 2);
  expected << 3, 5, 4, 4;
  EXPECT_TRUE(after.isApprox(expected, 1e-6F)) << after;
}

TEST(DiffusionLayers, GradientIsTheSumOfItsEntries) {
  networks::Matrix values(2, 2), expected(4, 2);
  values << 1, 10, 4, 20;
  expected << 3, 10, 2, 20, 12, 60, -4, -20;
  EXPECT_EQ(networks::surface_gradient(two_vertices(), values), expected);
}

const SurfaceNetwork& shipped_surface_network() {
  static const SurfaceNetwork network = SurfaceNetwork::load(testing::model_file("skirt.safetensors"));
  return network;
}

TEST(SurfaceNetwork, SameBitsForAnyNumberOfThreads) {
  const SurfaceSample surface = testing::made_surface(1700, 48);
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, count);
    return shipped_surface_network().confidence(surface);
  };
  const std::vector<float> one = with_threads(1);
  ASSERT_EQ(one.size(), 1700U);
  for (const std::size_t count : {2U, 3U, 5U}) EXPECT_EQ(with_threads(count), one);
}

TEST(SurfaceNetwork, RefusesSurfacesThatDoNotFit) {
  SurfaceSample bad = testing::made_surface(40, 8);
  EXPECT_NO_THROW(shipped_surface_network().confidence(bad));
  bad.mass.pop_back();
  EXPECT_THROW(shipped_surface_network().confidence(bad), InputError);
}

TEST(SurfaceNetwork, RefusesOtherWeights) {
  const test::TemporaryFolder folder;
  const TensorFile good = read_safetensors(testing::model_file("skirt.safetensors"));
  const auto refused = [&](const TensorFile& file) {
    write_safetensors(folder.path() / "weights.safetensors", file);
    EXPECT_THROW(SurfaceNetwork::load(folder.path() / "weights.safetensors"), InputError);
  };
  refused(read_safetensors(testing::model_file("completion.safetensors")));
  TensorFile bad = good;
  bad.tensors.erase("block_2.time");
  refused(bad);
  bad = good;
  bad.tensors.at("block_0.mlp_0.weight").shape = {192, 64};
  refused(bad);
  bad = good;
  bad.tensors.at("last.bias") = store_floats(std::vector<float>{std::nanf("")}, {1});
  refused(bad);
  bad = good;
  bad.metadata["input.signature"] = "no";  // the first layer has more columns then
  refused(bad);
  for (const char* count : {"features", "outputs"}) {
    bad = good;
    bad.metadata[count] = "17";
    refused(bad);
  }
}

TEST(SurfaceNetwork, ReadsWeightsThatStateTheirCountsAndSuchThatDoNot) {
  const test::TemporaryFolder folder;
  TensorFile file = read_safetensors(testing::model_file("skirt.safetensors"));
  SurfaceShape shape = read_surface_shape(file.metadata);
  EXPECT_EQ(feature_count(shape), surface_feature_count);
  note_surface_counts(shape, file.metadata);
  EXPECT_EQ(file.metadata.at("features"), "26");
  EXPECT_EQ(file.metadata.at("outputs"), "1");
  write_safetensors(folder.path() / "weights.safetensors", file);
  EXPECT_NO_THROW(SurfaceNetwork::load(folder.path() / "weights.safetensors"));
  shape.signature = false;
  EXPECT_EQ(feature_count(shape), 10);
}

}  // namespace
}  // namespace rhizodont
