// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/pose_samples.hpp"

#include "families/template_families.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace rhizodont {
namespace {

class PoseSamples : public test::TemplateFamilies {};

TEST_F(PoseSamples, DependOnTypeAndSeedAlone) {
  const ToothFamilies& families = all_families();
  const std::vector<PoseSample> one = make_pose_samples(families, 13, 4), again = make_pose_samples(families, 13, 4);
  ASSERT_GE(one.size(), 4U);
  ASSERT_EQ(one.size(), again.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].panorama.values, again[i].panorama.values);
    EXPECT_EQ(one[i].pose.azimuth, again[i].pose.azimuth);
    EXPECT_LT(one[i].pose.form_axis.norm(), 0.8);
  }
  EXPECT_NE(one[0].panorama.values, make_pose_samples(families, 13, 5)[0].panorama.values);
  const PosedPanoramas all = make_posed_panoramas(families, 1);
  EXPECT_GE(all.azimuths.size(), 16U * 4);
  EXPECT_EQ(all.panoramas.labels.size(), all.azimuths.size());
  EXPECT_EQ(all.leans.size(), 2 * all.azimuths.size());
}

// The weights learnt from the samples' azimuths and leans; here what they say is compared in the world.
TEST_F(PoseSamples, ShippedWeightsFindHowOtherCrownsStand) {
  const auto file = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / "pose.safetensors";
  const PoseErrors errors = pose_errors(all_families(), PoseNetwork(read_safetensors(file)), 4);
  EXPECT_GE(errors.crowns, 60U);
  EXPECT_LE(errors.lost, 0.02);
  EXPECT_LT(errors.turn, 2.8) << "degrees";
  EXPECT_LT(errors.lean, 4.7) << "degrees; borders lean by 11 against the form";
}

}  // namespace
}  // namespace rhizodont
