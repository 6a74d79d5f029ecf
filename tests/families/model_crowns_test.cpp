// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/model_crowns.hpp"

#include "families/crown_crop.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/frame.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <vector>

namespace rhizodont {
namespace {

const std::filesystem::path folder =
    std::filesystem::path(RHIZODONT_SOURCE_DIR) / ".." / "shared" / "data" / "crowns" / "ssm";

class ModelCrowns : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no crown models in " << folder;
  }
};

const std::vector<ModelCrown>& all_models() {
  static const std::vector<ModelCrown> models = load_model_crowns(folder);
  return models;
}

TEST_F(ModelCrowns, AreSolidsUprightInTheirFrame) {
  std::array<int, tooth_type_count> of_type{};
  for (const ModelCrown& crown : all_models()) {
    SCOPED_TRACE(crown.mean.type);
    ++of_type.at(static_cast<std::size_t>(crown.mean.type));
    const Diagnosis diagnosis = diagnose(crown.mean.mesh);
    EXPECT_TRUE(diagnosis.is_closed_solid());
    EXPECT_GT(volume(crown.mean.mesh), 50);
    EXPECT_LT(volume(crown.mean.mesh), 800);
    EXPECT_EQ(crown.modes.size(), crown.deviations.size());
  }
  for (std::size_t type = 0; type < of_type.size(); ++type)
    EXPECT_EQ(of_type[type], type % 8 == 7 ? 0 : 2) << "left and right, no third molars";
}

TEST_F(ModelCrowns, AreCutJustAboveTheirEndToAnOpenCrown) {
  for (std::size_t i = 0; i < all_models().size(); i += 5) {
    SCOPED_TRACE(i);
    RandomStream random(7, i);
    const SyntheticTooth tooth = draw_model_crown(all_models()[i], 0, random);
    const auto crown = crop_crown(tooth, {.junction_share = 1, .offset_mm = 0.5});
    ASSERT_TRUE(crown);
    EXPECT_GT(growth_axis(*crown).z(), 0.95);
    EXPECT_GT(surface_area(*crown), 0.5 * surface_area(tooth.mesh)) << "it is most of the crown";
    EXPECT_NEAR(bounding_box(tooth.mesh.vertices).max().z(), tooth.crown_height, 1e-12);
  }
}

TEST_F(ModelCrowns, AreAsTheStreamAndTheFactorSay) {
  const ModelCrown& model = all_models().front();
  RandomStream first(3, 1), again(3, 1), other(4, 1), unvaried(5, 1);
  const auto spread = [&](const SyntheticTooth& tooth) {
    const SyntheticTooth mean = draw_model_crown(model, 0, unvaried);
    double sum = 0;
    for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
      sum += (tooth.mesh.vertices[v] - mean.mesh.vertices[v]).norm();
    return sum / static_cast<double>(tooth.mesh.vertices.size());
  };
  const SyntheticTooth tooth = draw_model_crown(model, 1, first);
  EXPECT_EQ(tooth.mesh.vertices, draw_model_crown(model, 1, again).mesh.vertices);
  EXPECT_NE(tooth.mesh.vertices, draw_model_crown(model, 1, other).mesh.vertices);
  EXPECT_GT(spread(tooth), 0.1);
  EXPECT_LT(spread(tooth), 2);
}

TEST(ModelCrownFiles, ThatAreMissingAreNamed) {
  EXPECT_THROW(load_model_crowns(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "nowhere"), InputError);
}

}  // namespace
}  // namespace rhizodont
