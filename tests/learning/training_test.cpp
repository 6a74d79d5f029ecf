// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <random>
#include <thread>

#include "common/temporary_folder.hpp"
#include "learning/capsules.hpp"
#include "learning/train_completion.hpp"
#include "networks/completion_network.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

const Eigen::Vector2f upright(0, 0);

class Training : public ::testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();

  std::string checkpoint(const std::string& run) const {
    return test::read_all(folder_ / run / "checkpoint.safetensors");
  }

  /// Weights of a short run.
  CompletionNetwork short_run(CompletionTrainingOptions options) const {
    options.loop.folder = folder_ / "short";
    std::filesystem::remove_all(options.loop.folder);
    train_completion(testing::tiny_sample, options);
    write_safetensors(folder_ / "weights.safetensors", export_completion(options.loop.folder, {{"note", "a test"}}));
    return CompletionNetwork::load(folder_ / "weights.safetensors");
  }
};

TEST_F(Training, ResumedRunEqualsOneThatNeverStopped) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 24;
  options.loop.threads = 1;
  options.loop.checkpoint_minutes = 0;
  options.loop.folder = folder_ / "whole";
  EXPECT_EQ(train_completion(testing::tiny_sample, options).steps, 6U);

  // The same schedule, stopped in the middle of a step, as by a kill.
  options.loop.folder = folder_ / "parts";
  const auto stopping = [](std::uint64_t number) {
    if (number == 12) throw NoResultError("stopped");
    return testing::tiny_sample(number);
  };
  // Anchors come from sample 12 too: the provider that stops is given once they are known.
  bool started = false;
  const auto provider = [&](std::uint64_t number) {
    if (number >= 299) started = true;
    return started ? stopping(number) : testing::tiny_sample(number);
  };
  EXPECT_THROW(train_completion(provider, options), NoResultError);
  options.loop.resume = true;
  const CompletionTrainingResult parts = train_completion(testing::tiny_sample, options);
  EXPECT_EQ(parts.steps, 6U);
  EXPECT_EQ(checkpoint("parts"), checkpoint("whole"));
}

TEST_F(Training, TwoProcessesEqualOneWithTwiceTheBatch) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 24;
  options.loop.batch = 4;
  options.loop.threads = 2;
  options.loop.hours = 1e-12;  // stops before the first step: all go on from the same weights
  options.loop.folder = folder_ / "alone";
  train_completion(testing::tiny_sample, options);
  std::filesystem::create_directories(folder_ / "together");
  std::filesystem::copy_file(folder_ / "alone" / "checkpoint.safetensors",
                             folder_ / "together" / "checkpoint.safetensors");
  options.loop.hours = 0;
  options.loop.resume = true;
  EXPECT_EQ(train_completion(testing::tiny_sample, options).samples, 24U);

  options.loop.batch = 2;
  options.loop.threads = 1;
  options.loop.processes.count = 2;
  options.loop.processes.first_address = "127.0.0.1:" + std::to_string(20000 + getpid() % 20000);
  const auto run = [&](int rank, const char* folder) {
    CompletionTrainingOptions own = options;
    own.loop.processes.rank = rank;
    own.loop.folder = folder_ / folder;
    return train_completion(testing::tiny_sample, own);
  };
  auto other = std::async(std::launch::async, [&] { return run(1, "other"); });
  EXPECT_EQ(run(0, "together").samples, 24U);
  EXPECT_EQ(other.get().steps, 6U);
  EXPECT_EQ(checkpoint("together"), checkpoint("alone"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other" / "checkpoint.safetensors"));
}

TEST_F(Training, StartsFromOtherWeightsWithItsOwnTeeth) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 40;
  short_run(options);
  options.loop.hours = 1e-12;  // nothing but the start
  options.loop.start_from = folder_ / "weights.safetensors";
  options.loop.folder = folder_ / "next";
  const auto shifted = [](std::uint64_t number) {
    CompletionTrainingSample sample = testing::tiny_sample(number);
    for (auto* points : {&sample.input, &sample.target, &sample.matched})
      for (Eigen::Vector3f& p : *points) p.x() += 0.25F;
    return sample;
  };
  train_completion(shifted, options);
  const TensorFile before = read_safetensors(options.loop.start_from),
                   after = read_safetensors(options.loop.folder / "checkpoint.safetensors");
  for (const auto& [name, tensor] : before.tensors) {
    if (name == "patches" || name == "patch_normals") continue;
    EXPECT_EQ(load_floats(tensor), load_floats(after.tensors.at("value." + name))) << name;
  }
  const auto mean_x = [](const std::vector<float>& xyz) {
    double sum = 0;
    for (std::size_t i = 0; i < xyz.size(); i += 3) sum += xyz[i];
    return 3 * sum / static_cast<double>(xyz.size());
  };
  EXPECT_NEAR(
      mean_x(load_floats(after.tensors.at("value.patches"))) - mean_x(load_floats(before.tensors.at("patches"))), 0.25,
      0.1);
  options.loop.folder = folder_ / "other";
  options.shape.width += options.shape.heads;
  EXPECT_THROW(train_completion(testing::tiny_sample, options), InputError);
}

TEST_F(Training, ProcessesThatCannotBeAreRefused) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.processes = {2, 2, "127.0.0.1:29500"};
  EXPECT_THROW(train_completion(testing::tiny_sample, options), UsageError);
  for (const char* address : {"127.0.0.1", "127.0.0.1:port", ":29500", "host:0", "host:70000"}) {
    options.loop.processes = {2, 0, address};
    EXPECT_THROW(train_completion(testing::tiny_sample, options), UsageError) << address;
  }
}

TEST_F(Training, SameSeedSameWeights) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 12;
  for (const char* run : {"a", "b"}) {
    options.loop.folder = folder_ / run;
    train_completion(testing::tiny_sample, options);
  }
  EXPECT_EQ(checkpoint("a"), checkpoint("b"));
  options.loop.folder = folder_ / "c";
  options.loop.seed = 2;
  train_completion(testing::tiny_sample, options);
  EXPECT_NE(checkpoint("a"), checkpoint("c"));
}

TEST_F(Training, LearnsATinySetByHeart) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 1600;
  options.loop.learning_rate = 4e-3;
  options.unknown_share = 0;
  options.denoise_queries = 4;
  std::vector<double> losses;
  options.loop.report_steps = 20;
  options.loop.progress = [&](const TrainingProgress& progress) { losses.push_back(progress.loss); };
  // one type in four shapes: what its own tooth brings along is not enough
  train_completion([](std::uint64_t number) { return testing::tiny_sample(16 * (number % 4)); }, options);
  ASSERT_EQ(losses.size(), 20U);
  EXPECT_LT(losses.back(), 0.5 * losses.front());
}

TEST_F(Training, ValidationKeepsTheBestWeights) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.validation_samples = 8;
  std::vector<TrainingProgress> reports;
  options.loop.progress = [&](const TrainingProgress& progress) { reports.push_back(progress); };
  options.loop.folder = folder_ / "run";
  const CompletionTrainingResult result = train_completion(testing::tiny_sample, options);
  EXPECT_GT(result.best_root_chamfer, 0);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports.front().event, TrainingEvent::validation);
  EXPECT_EQ(reports.front().samples, 40U);
  EXPECT_TRUE(reports.front().is_best);
  EXPECT_EQ(reports.front().validation.at("root_chamfer_l1_mm"), result.best_root_chamfer);
  const TensorFile weights = export_completion(options.loop.folder, {{"note", "kept"}});
  const auto& notes = weights.metadata;
  EXPECT_EQ(notes.at("note"), "kept");
  EXPECT_EQ(notes.at("training.samples"), "40");
  EXPECT_NEAR(std::stod(notes.at("validation.root_chamfer_l1_mm")), result.best_root_chamfer, 6e-4);
  for (const auto& [name, tensor] : weights.tensors) EXPECT_EQ(tensor.type, TensorType::float16) << name;
}

TEST_F(Training, ValidationSamplesAreNeverTrainedOn) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.validation_samples = 4;
  options.loop.samples = 8;
  std::uint64_t validated = 0, trained = 0;
  options.loop.threads = 1;
  options.unknown_share = 0;
  train_completion(
      [&](std::uint64_t number) {
        (number >= first_validation_sample ? validated : trained) += 1;
        return testing::tiny_sample(number % first_validation_sample);
      },
      options);
  EXPECT_EQ(validated, 4U);
  EXPECT_EQ(trained, 300U + 8U);  // the anchors' look at the types, then the steps
}

TEST_F(Training, RefusesOptionsAndFoldersThatDoNotFit) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.batch = 3;
  EXPECT_THROW(train_completion(testing::tiny_sample, options), UsageError);
  options = testing::tiny_options();
  options.shape.width = 33;
  EXPECT_THROW(train_completion(testing::tiny_sample, options), UsageError);
  EXPECT_THROW(export_completion(folder_, {}), InputError);

  options = testing::tiny_options();
  options.loop.samples = 4;
  options.loop.folder = folder_ / "run";
  train_completion(testing::tiny_sample, options);
  options.loop.resume = true;
  options.shape.decoder_depth = 3;
  EXPECT_THROW(train_completion(testing::tiny_sample, options), InputError);
  options.shape.decoder_depth = 2;
  std::filesystem::resize_file(folder_ / "run" / "checkpoint.safetensors", 1000);
  EXPECT_THROW(train_completion(testing::tiny_sample, options), InputError);
}

TEST_F(Training, NetworkIsRepeatableAndIgnoresOrder) {
  const CompletionNetwork network = short_run(testing::tiny_options());
  EXPECT_EQ(network.input_points(), 64);
  EXPECT_EQ(network.output_points(), 96);
  EXPECT_EQ(network.metadata().at("note"), "a test");
  std::vector<Eigen::Vector3f> crown = testing::capsule(77, 90, 10).input;
  const CompletedPoints first = network.complete(crown, 3, upright);
  ASSERT_EQ(first.points.size(), 96U);
  ASSERT_EQ(first.normals.size(), 96U);
  for (const Eigen::Vector3f& n : first.normals) EXPECT_NEAR(n.norm(), 1, 1e-5);
  std::shuffle(crown.begin(), crown.end(), std::mt19937(1));
  EXPECT_EQ(network.complete(crown, 3, upright).points, first.points);
  std::vector<CompletedPoints> elsewhere(3);
  std::vector<std::thread> threads;
  for (auto& result : elsewhere) threads.emplace_back([&] { result = network.complete(crown, 3, upright); });
  for (auto& thread : threads) thread.join();
  for (const auto& result : elsewhere) {
    EXPECT_EQ(result.points, first.points);
    EXPECT_EQ(result.normals, first.normals);
  }
  EXPECT_NE(network.complete(crown, unknown_type, upright).points, first.points);
}

TEST_F(Training, NetworkRefusesBadCrowns) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 4;
  const CompletionNetwork network = short_run(options);
  const std::vector<Eigen::Vector3f> crown = testing::capsule(78, 64, 10).input;
  EXPECT_NO_THROW(network.complete(crown, 0, upright));
  EXPECT_THROW(network.complete(crown, 17, upright), UsageError);
  EXPECT_THROW(network.complete(crown, -1, upright), UsageError);
  EXPECT_THROW(network.complete(crown, 0, Eigen::Vector2f(0, std::nanf(""))), InputError);
  EXPECT_THROW(network.complete(std::span(crown).first(63), 0, upright), InputError);
  auto bad = crown;
  bad[5].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(network.complete(bad, 0, upright), InputError);
  bad = crown;
  bad[5].y() = 12;
  EXPECT_THROW(network.complete(bad, 0, upright), InputError);
  EXPECT_THROW(network.complete(std::vector<Eigen::Vector3f>(64, Eigen::Vector3f(1, 1, 1)), 0, upright), InputError);
}

TEST_F(Training, NetworkRefusesOtherWeightFiles) {
  CompletionTrainingOptions options = testing::tiny_options();
  options.loop.samples = 4;
  short_run(options);
  const std::filesystem::path path = folder_ / "weights.safetensors";
  const TensorFile good = read_safetensors(path);
  const auto refused = [&](const TensorFile& file) {
    write_safetensors(path, file);
    EXPECT_THROW(CompletionNetwork::load(path), InputError);
  };
  TensorFile bad = good;
  bad.metadata.erase("format");
  refused(bad);
  bad = good;
  bad.metadata["shape.width"] = "wide";
  refused(bad);
  bad = good;
  bad.metadata["shape.width"] = "64";
  refused(bad);
  bad = good;
  bad.tensors.erase(bad.tensors.begin());
  refused(bad);
  bad = good;
  auto& values = bad.tensors.at("head_out.bias");
  values = store_floats(std::vector<float>(24, std::numeric_limits<float>::quiet_NaN()), {24}, TensorType::float16);
  refused(bad);
  write_safetensors(path, good);
  EXPECT_NO_THROW(CompletionNetwork::load(path));
}

}  // namespace
}  // namespace rhizodont
