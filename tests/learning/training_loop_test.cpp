// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/training_loop.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <mutex>
#include <set>
#include <thread>

#include "common/temporary_folder.hpp"
#include "learning/checkpoint.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// A line through points, y = 2 x - 1: as small as a network gets.
struct Line {
  Line() {
    torch::manual_seed(7);
    network = torch::nn::Linear(1, 1);
    task.identity = {{"format", "a line"}};
    task.share = [this](std::uint64_t first, int count) {
      const torch::Tensor x =
          (torch::arange(static_cast<double>(first), static_cast<double>(first) + count) * 0.37).sin().view({-1, 1});
      const torch::Tensor loss = (network->forward(x.to(torch::kFloat)) - (2 * x - 1)).square().mean();
      TrainingShare share;
      share.gradients = torch::autograd::grad({loss}, network->parameters());
      share.loss = loss.item<double>();
      share.terms = {{"slope", network->weight.item<double>()}};
      const std::lock_guard<std::mutex> lock(mutex);
      for (int i = 0; i < count; ++i) seen.insert(first + static_cast<std::uint64_t>(i));
      return share;
    };
    task.validate = [this] {
      const double error = std::abs(network->weight.item<double>() - 2) + std::abs(network->bias.item<double>() + 1);
      return Validation{error, {{"error", error}}, {{"validation.error", std::to_string(error)}}};
    };
  }

  TrainingLoopResult train(const TrainingLoopOptions& options) { return run_training_loop(*network, task, options); }

  torch::nn::Linear network{nullptr};
  TrainingTask task;
  std::mutex mutex;
  std::multiset<std::uint64_t> seen;
};

class Loop : public ::testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path();

  TrainingLoopOptions options(const std::string& run) const {
    TrainingLoopOptions o;
    o.batch = 4;
    o.samples = 80;
    o.learning_rate = 0.05;
    o.warm_up = 3;
    o.threads = 2;
    o.validation_samples = 0;
    o.folder = folder_ / run;
    return o;
  }

  std::string bytes(const std::string& run, const char* name = checkpoint_name) const {
    return test::read_all(folder_ / run / name);
  }
};

TEST_F(Loop, RateRisesToItsLargestAndFallsInACosine) {
  TrainingLoopOptions o;
  o.batch = 10;
  o.samples = 4400;  // 440 steps, or 110 with four processes
  o.warm_up = 40;
  o.learning_rate = 0.8;
  o.lowest_rate = 0.25;
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 0), 0.8 / 40);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 19), 0.4);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 39), 0.8);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 40), 0.8);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 240), 0.5);  // halfway: the mean of 0.8 and 0.2
  EXPECT_NEAR(learning_rate_at(o, 140), 0.2 + 0.6 * (1 + std::sqrt(0.5)) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 440), 0.2);
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 100'000), 0.2);
  o.processes.count = 4;
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 75), 0.5);
  o.warm_up = 0;
  EXPECT_DOUBLE_EQ(learning_rate_at(o, 0), 0.8);
}

TEST_F(Loop, LearnsALineAndSaysHowFarItIs) {
  TrainingLoopOptions o = options("line");
  o.samples = 4000;
  o.validation_samples = 1;
  o.report_steps = 250;
  std::vector<TrainingProgress> reports;
  o.progress = [&](const TrainingProgress& progress) { reports.push_back(progress); };
  Line line;
  const TrainingLoopResult result = line.train(o);
  EXPECT_EQ(result.steps, 1000U);
  EXPECT_EQ(result.samples, 4000U);
  EXPECT_LT(result.best, 0.02);
  EXPECT_LT(result.last_loss, 1e-3);
  ASSERT_EQ(reports.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(reports[i].event, TrainingEvent::steps);
    EXPECT_EQ(reports[i].steps, 250 * (i + 1));
    EXPECT_EQ(reports[i].samples, 1000 * (i + 1));
    EXPECT_EQ(reports[i].learning_rate, learning_rate_at(o, reports[i].steps - 1));
    EXPECT_GT(reports[i].samples_per_second, 0);
  }
  EXPECT_LT(reports[3].loss, 0.1 * reports[0].loss);
  EXPECT_NEAR(reports[3].terms.at("slope"), 2, 0.02);
  EXPECT_EQ(reports[4].event, TrainingEvent::validation);
  EXPECT_TRUE(reports[4].is_best);
  EXPECT_EQ(reports[4].validation.at("error"), result.best);
  // Each sample once.
  EXPECT_EQ(line.seen.size(), 4000U);
  EXPECT_EQ(std::set<std::uint64_t>(line.seen.begin(), line.seen.end()).size(), 4000U);
  const TensorFile best = read_safetensors(o.folder / best_name);
  EXPECT_EQ(best.metadata.at("format"), "a line");
  EXPECT_EQ(best.metadata.at("training.steps"), "1000");
  EXPECT_EQ(best.metadata.at("validation.error"), std::to_string(result.best));
  EXPECT_EQ(best.tensors.at("weight").type, TensorType::float16);
}

TEST_F(Loop, ResumedRunEqualsOneThatNeverStopped) {
  Line whole;
  whole.train(options("whole"));
  TrainingLoopOptions o = options("parts");
  o.report_steps = 1;
  o.progress = [](const TrainingProgress& progress) {
    if (progress.steps == 8) throw NoResultError("stopped");
  };
  o.checkpoint_minutes = 0;
  Line first;
  EXPECT_THROW(first.train(o), NoResultError);
  o.resume = true;
  std::vector<TrainingProgress> reports;
  o.progress = [&](const TrainingProgress& progress) { reports.push_back(progress); };
  Line second;
  second.network->weight.data().fill_(100);  // whatever it began with
  EXPECT_EQ(second.train(o).steps, 20U);
  EXPECT_EQ(reports.front().event, TrainingEvent::resumed);
  EXPECT_EQ(reports.front().steps, 7U);
  EXPECT_FALSE(bytes("whole").empty());
  EXPECT_EQ(bytes("parts"), bytes("whole"));
  EXPECT_FLOAT_EQ(second.network->weight.item<float>(), whole.network->weight.item<float>());
}

TEST_F(Loop, TwoProcessesSumTheirGradientsAsOne) {
  Line alone;
  TrainingLoopOptions o = options("alone");
  alone.train(o);
  o.batch = 2;
  o.threads = 1;
  o.processes.count = 2;
  o.processes.first_address = "127.0.0.1:" + std::to_string(20000 + getpid() % 20000);
  Line lines[2];
  const auto run = [&](int rank) {
    TrainingLoopOptions own = o;
    own.processes.rank = rank;
    own.folder = folder_ / (rank == 0 ? "first" : "second");
    return lines[rank].train(own);
  };
  auto second = std::async(std::launch::async, [&] { return run(1); });
  const TrainingLoopResult result = run(0);
  EXPECT_EQ(result.samples, 80U);
  EXPECT_EQ(second.get().last_loss, result.last_loss);
  EXPECT_EQ(bytes("first"), bytes("alone"));
  EXPECT_EQ(lines[1].network->weight.item<float>(), alone.network->weight.item<float>());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "second" / checkpoint_name));
}

TEST_F(Loop, StopsByHours) {
  TrainingLoopOptions o = options("hours");
  o.samples = 1'000'000;
  o.hours = 1e-12;
  EXPECT_EQ(Line().train(o).steps, 0U);
  EXPECT_TRUE(std::filesystem::exists(o.folder / checkpoint_name));
  o.resume = true;
  o.hours = 0.2 / 3600;
  Line slow;
  slow.task.prepare = [](std::uint64_t, int) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  const TrainingLoopResult result = slow.train(o);
  EXPECT_GE(result.steps, 1U);
  EXPECT_LE(result.steps, 10U);
}

TEST_F(Loop, ALossThatIsNoNumberEndsIt) {
  Line line;
  line.task.share = [share = line.task.share](std::uint64_t first, int count) {
    TrainingShare result = share(first, count);
    if (first == 40) result.loss = std::numeric_limits<double>::quiet_NaN();
    return result;
  };
  EXPECT_THROW(line.train(options("loss")), NoResultError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "loss" / checkpoint_name));
  Line other;
  other.task.share = [share = other.task.share](std::uint64_t first, int count) {
    TrainingShare result = share(first, count);
    result.gradients.front().fill_(std::numeric_limits<float>::infinity());
    return result;
  };
  EXPECT_THROW(other.train(options("gradient")), NoResultError);
}

TEST_F(Loop, KeepsTheBestWeightsWhicheverWayIsBetter) {
  for (const bool lower : {true, false}) {
    TrainingLoopOptions o = options(lower ? "lower" : "higher");
    o.samples = 16;
    o.validation_samples = 1;
    o.validation_minutes = 0;  // after each of four steps, and at the end
    std::vector<double> selections{0.5, 0.7, 0.3, 0.4, 0.4};
    std::size_t at = 0;
    Line line;
    line.task.lower_is_better = lower;
    line.task.weight_type = TensorType::float32;
    line.task.notes = {{"training.pool", "5"}};
    line.task.validate = [&] { return Validation{selections.at(at++), {}, {}}; };
    std::vector<bool> best;
    o.progress = [&](const TrainingProgress& progress) { best.push_back(progress.is_best); };
    EXPECT_EQ(line.train(o).best, lower ? 0.3 : 0.7);
    EXPECT_EQ(best, lower ? (std::vector<bool>{true, false, true, false, false})
                          : (std::vector<bool>{true, true, false, false, false}));
    const TensorFile kept = weights_of_run(o.folder, TensorType::float32, {{"note", "a test"}});
    EXPECT_EQ(kept.metadata.at("training.steps"), lower ? "3" : "2");
    EXPECT_EQ(kept.metadata.at("training.pool"), "5");
    EXPECT_EQ(kept.metadata.at("note"), "a test");
    EXPECT_EQ(kept.tensors.at("weight").type, TensorType::float32);
  }
}

TEST_F(Loop, ARunThatWasNeverValidatedIsExportedFromItsCheckpoint) {
  Line line;
  line.train(options("run"));
  const TensorFile file = weights_of_run(folder_ / "run", TensorType::float32, {});
  EXPECT_EQ(file.tensors.size(), 2U);
  EXPECT_EQ(load_floats(file.tensors.at("weight")),
            load_floats(read_safetensors(folder_ / "run" / checkpoint_name).tensors.at("average.weight")));
  EXPECT_THROW(weights_of_run(folder_ / "nowhere", TensorType::float32, {}), InputError);
}

TEST_F(Loop, StartsFromWeightsOfTheSameNetworkAlone) {
  TrainingLoopOptions o = options("first");
  o.validation_samples = 1;
  Line line;
  line.task.weight_type = TensorType::float32;
  line.train(o);
  TrainingLoopOptions next = options("next");
  next.start_from = o.folder / best_name;
  next.hours = 1e-12;
  Line other;
  other.train(next);
  EXPECT_EQ(load_floats(read_safetensors(next.folder / checkpoint_name).tensors.at("value.weight")),
            load_floats(read_safetensors(o.folder / best_name).tensors.at("weight")));
  Line stranger;
  stranger.task.identity["format"] = "a curve";
  next.folder = folder_ / "stranger";
  EXPECT_THROW(stranger.train(next), InputError);
  o.resume = true;
  EXPECT_THROW(stranger.train(o), InputError);
}

TEST_F(Loop, RefusesOptionsOutOfRangeByName) {
  const auto refused = [&](const std::string& name, const std::function<void(TrainingLoopOptions&)>& spoil) {
    TrainingLoopOptions o = options("bad");
    spoil(o);
    try {
      Line().train(o);
      ADD_FAILURE() << name << " is not refused";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused("batch", [](auto& o) { o.batch = 0; });
  refused("threads", [](auto& o) { o.threads = 0; });
  refused("threads", [](auto& o) { o.threads = 3; });
  refused("samples", [](auto& o) { o.samples = 0; });
  refused("hours", [](auto& o) { o.hours = std::nan(""); });
  refused("learning_rate", [](auto& o) { o.learning_rate = 0; });
  refused("lowest_rate", [](auto& o) { o.lowest_rate = 2; });
  refused("warm_up", [](auto& o) { o.warm_up = -1; });
  refused("average_decay", [](auto& o) { o.average_decay = 1.1; });
  refused("report_steps", [](auto& o) { o.report_steps = 0; });
  refused("rank", [](auto& o) { o.processes.rank = 1; });
  EXPECT_FALSE(std::filesystem::exists(folder_ / "bad" / checkpoint_name));
}

}  // namespace
}  // namespace rhizodont
