// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/temporary_folder.hpp"
#include "learning/surfaces.hpp"
#include "learning/train_surface.hpp"
#include "networks/safetensors.hpp"
#include "networks/surface_network.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// Bowls of different sizes; which side a vertex is on is easily learned from its position.
SurfaceSample bowl_sample(std::uint64_t index) {
  SurfaceSample sample = testing::surface_sample(test::bowl(7 + static_cast<int>(index % 5)), 12);
  return sample;
}

class SurfaceTraining : public ::testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();

  SurfaceTrainingOptions options(const std::string& run) const {
    SurfaceTrainingOptions o;
    o.shape.width = 8;
    o.shape.blocks = 1;
    o.shape.eigenvectors = 12;
    o.loop.batch = 2;
    o.loop.samples = 24;
    o.pool = 5;
    o.loop.warm_up = 2;
    o.loop.validation_samples = 2;
    o.loop.folder = folder_ / run;
    return o;
  }

  std::string checkpoint(const std::string& run) const {
    return test::read_all(folder_ / run / "checkpoint.safetensors");
  }
};

TEST_F(SurfaceTraining, LearnsWhatIsEasy) {
  SurfaceTrainingOptions o = options("easy");
  o.loop.samples = 800;
  o.loop.learning_rate = 1e-2;
  o.loop.average_decay = 0.9;
  o.tilt_radians = o.scale_deviation = 0;
  // Positions are turned about z: labels must not depend on the direction.
  const auto provider = [](std::uint64_t index) {
    SurfaceSample sample = bowl_sample(index);
    for (int v = 0; v < sample.vertices; ++v) {
      const float* p = &sample.features[static_cast<std::size_t>(v) * surface_feature_count];
      sample.labels[static_cast<std::size_t>(v)] = p[0] * p[0] + p[1] * p[1] > 2.25F ? 1 : 0;
    }
    return sample;
  };
  const SurfaceTrainingResult result = train_surface(provider, o);
  EXPECT_GT(result.best.accuracy, 0.9);
  EXPECT_GT(result.best.intersection, 0.8);
  write_safetensors(folder_ / "weights.safetensors", export_surface(o.loop.folder, {{"note", "a test"}}));
  const SurfaceNetwork network = SurfaceNetwork::load(folder_ / "weights.safetensors");
  EXPECT_EQ(network.metadata().at("note"), "a test");
  const SurfaceFigures again = measure_surface(network, provider, std::uint64_t{1} << 40, 2);
  EXPECT_NEAR(again.accuracy, result.best.accuracy, 1e-6);
  for (const float c : network.confidence(provider(3))) {
    EXPECT_GE(c, 0);
    EXPECT_LE(c, 1);
  }
}

TEST_F(SurfaceTraining, ResumedRunEqualsOneThatNeverStopped) {
  train_surface(bowl_sample, options("whole"));
  SurfaceTrainingOptions o = options("parts");
  o.loop.checkpoint_minutes = 0;
  const auto stopping = [](std::uint64_t index) {
    if (index == 4) throw NoResultError("stopped");
    return bowl_sample(index);
  };
  EXPECT_THROW(train_surface(stopping, o), NoResultError);
  o.loop.resume = true;
  EXPECT_EQ(train_surface(bowl_sample, o).samples, 24U);
  const TensorFile whole = read_safetensors(folder_ / "whole" / "checkpoint.safetensors");
  const TensorFile parts = read_safetensors(folder_ / "parts" / "checkpoint.safetensors");
  ASSERT_EQ(whole.tensors.size(), parts.tensors.size());
  for (const auto& [name, tensor] : whole.tensors) EXPECT_EQ(tensor.bytes, parts.tensors.at(name).bytes) << name;
}

TEST_F(SurfaceTraining, RefusesWhatDoesNotFit) {
  SurfaceTrainingOptions o = options("bad");
  o.loop.batch = 3;
  o.loop.threads = 2;
  EXPECT_THROW(train_surface(bowl_sample, o), UsageError);
  EXPECT_THROW(export_surface(folder_, {}), InputError);
  o = options("other");
  o.loop.samples = 2;
  train_surface(bowl_sample, o);
  o.loop.resume = true;
  o.shape.width = 9;
  EXPECT_THROW(train_surface(bowl_sample, o), InputError);
  TensorFile file;
  file.metadata["format"] = "something else";
  write_safetensors(folder_ / "else.safetensors", file);
  EXPECT_THROW(SurfaceNetwork::load(folder_ / "else.safetensors"), InputError);
}

}  // namespace
}  // namespace rhizodont
