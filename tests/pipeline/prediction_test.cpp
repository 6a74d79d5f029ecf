// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/prediction.hpp"

#include "mesh/test_meshes.hpp"
#include "pipeline/product_models.hpp"
#include "pipeline/stage_clock.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace rhizodont {
namespace {

/// A sample crown with its pose.
class Prediction : public testing::Test {
 protected:
  const CompletionModels::Content& content = *content_of(test::models());
  const TriangleMesh crown = load_mesh(test::source_folder / "samples" / "crown_34.ply").mesh;
  const CrownFrame frame =
      canonical_frame(prepare_crown(crown), 34, content.atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(34))]);
  std::vector<RootSource> tried;

  RootPrediction predict(const std::function<bool(RootSource)>& agrees) {
    return predict_tooth(crown, 34, frame, content, [&](const RootPrediction& prediction) {
      EXPECT_TRUE(is_solid(prediction.solidity));
      tried.push_back(prediction.source);
      return agrees(prediction.source);
    });
  }
};

TEST_F(Prediction, TheFirstIsTakenIfItMakesARoot) {
  const RootPrediction found = predict([](RootSource) { return true; });
  EXPECT_EQ(found.source, RootSource::network);
  EXPECT_EQ(tried, std::vector<RootSource>{RootSource::network});
  EXPECT_GT(found.solidity.below, 0.2) << "far above what counts as no root";
}

TEST_F(Prediction, ElseTheCrownIsLaidAnew) {
  const RootPrediction found = predict([](RootSource source) { return source != RootSource::network; });
  EXPECT_EQ(found.source, RootSource::network_laid_anew);
  EXPECT_EQ(tried, (std::vector<RootSource>{RootSource::network, RootSource::network_laid_anew}));
  EXPECT_FALSE(found.frame.frame.rotation.isApprox(frame.frame.rotation, 1e-3));
}

TEST_F(Prediction, AtLastTheMeanToothIsTaken) {
  const RootPrediction found = predict([](RootSource source) { return source == RootSource::mean_tooth; });
  EXPECT_EQ(found.source, RootSource::mean_tooth);
  EXPECT_EQ(tried.back(), RootSource::mean_tooth);
  EXPECT_GT(tried.size(), 2U);
  for (const double expected : found.tooth.expected_distance) EXPECT_GE(expected, 3) << "nothing is known of this root";
}

TEST_F(Prediction, WithoutAnyThereIsNoResult) {
  EXPECT_THROW(predict([](RootSource) { return false; }), NoResultError);
  EXPECT_EQ(tried.back(), RootSource::mean_tooth);
}

TEST_F(Prediction, ASurfaceWithoutARootDoesNotTaper) {
  EXPECT_FALSE(root_tapers(test::cube(), crown, frame)) << "it lies wholly above the crown's border, or beside it";
}

TEST(StageClock, AStageTakenUpAgainIsOneStage) {
  std::vector<std::string> said;
  const ProgressCallback progress = [&](std::string_view stage) { said.emplace_back(stage); };
  StageClock clock(progress);
  for (const char* stage : {"network", "surface", "network", "surface", "joining"}) {
    clock.begin(stage);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const std::vector<StageRecord> records = clock.finish();
  ASSERT_EQ(records.size(), 3U);
  EXPECT_EQ(records[0].name, "network");
  EXPECT_GE(records[0].seconds, 0.004);
  EXPECT_GE(records[1].seconds, 0.004);
  EXPECT_EQ(records[2].name, "joining");
  EXPECT_EQ(said.size(), 5U);
}

}  // namespace
}  // namespace rhizodont
