// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/train_scan.hpp"

#include "learning/scan_net.hpp"
#include "learning/vary_cloud.hpp"
#include "learning/weights.hpp"
#include "networks/scan_network.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace rhizodont {
namespace {

ScanShape small_scan_shape() {
  ScanShape shape;
  shape.widths = {16, 16, 24, 32};
  shape.blocks = {1, 1, 1, 1};
  return shape;
}

/// A ridge along a half circle whose quarters are teeth; of an upper jaw for even numbers.
LabelledCloud half_circle(std::uint64_t index) {
  RandomStream random(index);
  LabelledCloud scan;
  scan.upper = index % 2 == 0;
  for (int i = 0; i < 2500; ++i) {
    const double angle = random.uniform(-1.4, 1.4), radius = random.uniform(14, 26);
    const double off = radius - 20, height = 5 * std::exp(-off * off / 6);
    for (const double x : {radius * std::sin(angle), radius * std::cos(angle), height})
      scan.cloud.positions.push_back(static_cast<float>(x));
    const double slope = off / 3 * height;
    const double length = std::sqrt(1 + slope * slope);
    for (const double x : {slope * std::sin(angle) / length, slope * std::cos(angle) / length, 1 / length})
      scan.cloud.normals.push_back(static_cast<float>(x));
    scan.cloud.curvatures.insert(scan.cloud.curvatures.end(), {static_cast<float>(height > 2 ? -1 : 0.5), 0});
    const int quarter = angle < 0 ? (angle < -0.7 ? 2 : 1) : (angle < 0.7 ? 1 : 2);
    const int quadrant = scan.upper ? (angle < 0 ? 1 : 2) : (angle < 0 ? 3 : 4);
    scan.teeth.push_back(static_cast<std::uint8_t>(height > 1.5 ? 10 * quadrant + quarter : 0));
  }
  return scan;
}

class ScanTraining : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("rhizodont_scan_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  ScanTrainingOptions options(const std::string& run) const {
    ScanTrainingOptions o;
    o.shape = small_scan_shape();
    o.pool = 3;
    o.loop.batch = 2;
    o.loop.threads = 1;
    o.loop.samples = 120;
    o.loop.warm_up = 5;
    o.loop.validation_samples = 2;
    o.loop.folder = folder_ / run;
    std::filesystem::create_directories(o.loop.folder);
    return o;
  }
  std::filesystem::path folder_;
};

TEST_F(ScanTraining, LearnsWhatIsEasyAndRunsWithoutTorch) {
  ScanTrainingOptions o = options("easy");
  o.loop.learning_rate = 5e-3;
  o.loop.average_decay = 0.9;
  const ScanTrainingResult result = train_scan(half_circle, o);
  EXPECT_GT(result.best.tooth_gum, 0.9);
  const TensorFile file = export_scan(o.loop.folder, {{"note", "a test"}});
  write_safetensors(folder_ / "weights.safetensors", file);
  const ScanNetwork network = ScanNetwork::load(folder_ / "weights.safetensors");

  ScanNet trained(o.shape);
  for (auto& item : trained->named_parameters()) {
    torch::NoGradGuard no_gradient;
    load_tensor(file, item.key(), item.value());
  }
  RandomStream random(9);
  const ShownScan shown = varied(half_circle(8), o.shape, {}, random);
  torch::NoGradGuard no_gradient;
  const ScanLogits said = trained->forward(to_tensors(shown.pyramid, o.shape));
  const ScanReading read = network.read(shown.pyramid);
  const torch::Tensor kinds = torch::softmax(said.each.slice(1, 0, scan_kind_count), 1).contiguous();
  for (std::int64_t i = 0; i < kinds.numel(); ++i)
    ASSERT_NEAR(kinds.data_ptr<float>()[i], read.kinds[static_cast<std::size_t>(i)], 2e-4);
  const torch::Tensor offsets =
      (scan_offset_mm * said.each.slice(1, scan_kind_count, scan_kind_count + 3)).contiguous();
  for (std::int64_t i = 0; i < offsets.numel(); ++i)
    ASSERT_NEAR(offsets.data_ptr<float>()[i], read.offsets[static_cast<std::size_t>(i)], 2e-3);
  EXPECT_NEAR(torch::sigmoid(said.whole[0]).item<float>(), read.upper, 1e-4);
  EXPECT_NEAR(said.whole[2].item<float>(), read.front[1], 1e-4);
}

TEST_F(ScanTraining, AMirroredScanHasMirroredKinds) {
  ScanVariation still{.any_turn_share = 0,
                      .turn = 0,
                      .tilt = 0,
                      .strong_tilt_share = 0,
                      .size = 0,
                      .bend = 0,
                      .crop_share = 0,
                      .trim_share = 0,
                      .noise_mm = 0};
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    RandomStream random(seed);
    const ShownScan shown = varied(half_circle(2), small_scan_shape(), still, random);
    for (std::size_t i = 0; i < shown.kinds.size(); ++i) {
      const float x = shown.pyramid.levels[0].positions[3 * i];
      if (shown.kinds[i] != 0 && std::abs(x) > 1) {
        EXPECT_EQ(shown.kinds[i] > 8, x > 0);
      }
    }
    EXPECT_NEAR(shown.front[1], 1, 1e-6);
    EXPECT_NEAR(shown.occlusal[2], 1, 1e-6);
  }
}

TEST_F(ScanTraining, ResumedRunEqualsOneThatNeverStopped) {
  ScanTrainingOptions o = options("whole");
  o.loop.samples = 8;
  train_scan(half_circle, o);
  const TensorFile whole = read_safetensors(o.loop.folder / "checkpoint.safetensors");
  o.loop.folder = options("parts").loop.folder;
  o.loop.checkpoint_minutes = 0;
  int steps = 0;
  o.loop.report_steps = 1;
  o.loop.progress = [&](const TrainingProgress& p) {
    if (p.event == TrainingEvent::steps && ++steps == 3) throw NoResultError("stopped");
  };
  EXPECT_THROW(train_scan(half_circle, o), NoResultError);
  o.loop.progress = {};
  o.loop.resume = true;
  EXPECT_EQ(train_scan(half_circle, o).samples, 8U);
  const TensorFile parts = read_safetensors(o.loop.folder / "checkpoint.safetensors");
  for (const auto& [name, tensor] : whole.tensors) EXPECT_EQ(tensor.bytes, parts.tensors.at(name).bytes) << name;
}

TEST_F(ScanTraining, RefusesWhatDoesNotFit) {
  ScanTrainingOptions o = options("bad");
  o.pool = 0;
  EXPECT_THROW(train_scan(half_circle, o), UsageError);
  EXPECT_THROW(export_scan(folder_, {}), InputError);
}

}  // namespace
}  // namespace rhizodont
