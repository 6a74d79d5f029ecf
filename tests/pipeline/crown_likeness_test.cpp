// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/crown_likeness.hpp"

#include "families/unlike_crowns.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/models.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/error.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::for_tooth;
using test::models;
using test::sample;
using test::source_folder;

const std::vector<std::pair<const char*, int>> samples{
    {"crown_11.stl", 11}, {"crown_23.ply", 23}, {"crown_34.ply", 34}, {"crown_36.stl", 36}, {"crown_16.ply", 16}};

/// Stood on its base: growth axis +z.
TriangleMesh upright(TriangleMesh crown) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(area_vector(crown), Eigen::Vector3d::UnitZ().eval()).toRotationMatrix();
  for (Point& p : crown.vertices) p = turn * p;
  return crown;
}

/// What is made of a crown; nothing where it is refused.
std::optional<CrownLikeness> judged(const TriangleMesh& crown, std::optional<int> fdi) {
  try {
    return judge_crown(prepare_crown(crown), fdi, content_of(models())->atlas, *content_of(models())->likeness);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("look like"), std::string::npos) << error.what();
    return std::nullopt;
  }
}

TEST(CrownLikeness, TheSamplesAreWhatTheyAreSaidToBe) {
  for (const auto& [file, fdi] : samples) {
    const auto likeness = judged(sample(file), fdi);
    ASSERT_TRUE(likeness) << fdi;
    EXPECT_EQ(likeness->verdict, LikenessVerdict::fits) << fdi << " like " << likeness->next[0].fdi;
    EXPECT_EQ(likeness->said.fdi, fdi);
    EXPECT_FALSE(likeness_warning(*likeness, false));
    EXPECT_GT(likeness->seen, 0.7);
    EXPECT_LT(likeness->said.distance_mm, 1);
  }
}

TEST(CrownLikeness, AnotherClassIsWarnedOf) {
  for (const auto& [file, fdi] : samples) {
    const int wrong = 10 * (fdi / 10) + (fdi % 10 <= 3 ? 6 : 1);
    const auto likeness = judged(sample(file), wrong);
    ASSERT_TRUE(likeness) << fdi;
    EXPECT_NE(likeness->verdict, LikenessVerdict::fits) << fdi << " said to be " << wrong;
    const auto warning = likeness_warning(*likeness, false);
    ASSERT_TRUE(warning);
    EXPECT_NE(warning->find("like a " + std::to_string(wrong)), std::string::npos) << *warning;
    if (likeness->verdict == LikenessVerdict::other_tooth) {
      EXPECT_NE(warning->find("more like a " + std::to_string(likeness->next[0].fdi)), std::string::npos) << *warning;
    }
  }
}

TEST(CrownLikeness, WhatIsNoWholeCrownIsSaidToBeNone) {
  RandomStream random(3);
  int caught = 0, tried = 0;
  for (int kind = 0; kind < unlike_kind_count; ++kind)
    for (const auto& [file, fdi] : samples) {
      const TriangleMesh mesh = unlike_crown(upright(sample(file)), static_cast<UnlikeKind>(kind), random);
      const auto likeness = judged(mesh, fdi);
      const bool found = !likeness || likeness->verdict != LikenessVerdict::fits;
      caught += found ? 1 : 0;
      ++tried;
      if (!found) std::printf("%s of %d passes\n", name_of(static_cast<UnlikeKind>(kind)).c_str(), fdi);
    }
  EXPECT_GE(caught, 0.95 * tried);
}

TEST(CrownLikeness, AFewTrianglesAreNoMolar) {
  TriangleMesh pyramid;
  pyramid.vertices = {{-4, -3, 0}, {4, -3, 0}, {0, 4, 0}, {0, 0, 6}};
  pyramid.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const auto likeness = judged(pyramid, 36);
  EXPECT_TRUE(!likeness || likeness->verdict != LikenessVerdict::fits);
}

TEST(CrownLikeness, AGuessSaysHowSureItIs) {
  const auto likeness = judged(sample("crown_36.stl"), std::nullopt);
  ASSERT_TRUE(likeness);
  EXPECT_GE(likeness->said.probability, likeness->next[0].probability);
  EXPECT_GE(likeness->next[0].probability, likeness->next[1].probability);
  const auto warning = likeness_warning(*likeness, true);
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("No FDI number"), std::string::npos);
  EXPECT_NE(warning->find(std::to_string(likeness->next[1].fdi)), std::string::npos);
}

TEST(CrownLikeness, StandsInTheRecordOfATooth) {
  const CompletedTooth tooth = complete_tooth(sample("crown_34.ply"), models(), for_tooth(34));
  ASSERT_TRUE(tooth.record.likeness);
  EXPECT_EQ(tooth.record.likeness->said.fdi, 34);
  EXPECT_EQ(tooth.record.root.source, RootSource::network);
}

}  // namespace
}  // namespace rhizodont
