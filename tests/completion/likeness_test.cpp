// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/likeness.hpp"

#include "completion/mean_crown_agreement.hpp"
#include "completion/product_atlas.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace rhizodont {
namespace {

using test::atlas;
using test::source_folder;

const LikenessModel& shipped() {
  static const LikenessModel model = load_likeness(source_folder / "models" / "likeness.safetensors");
  return model;
}

TriangleMesh sample(const std::string& name) { return load_mesh(source_folder / "samples" / name).mesh; }

Likeness likeness_of(const TriangleMesh& crown) { return likeness(crown, growth_axis(crown), shipped().classifier); }

TEST(Likeness, ProbabilitiesSumToOneAndLeadsStartAtNone) {
  const Likeness judged = likeness_of(sample("crown_34.ply"));
  double sum = 0, least = 1e9;
  for (std::size_t tooth = 0; tooth < tooth_count; ++tooth) {
    sum += std::exp(judged.log_probability[tooth]);
    least = std::min(least, judged.lead_over(tooth));
  }
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_EQ(least, 0);
  EXPECT_LE(judged.lead_over(tooth_of_fdi(34)), shipped().bounds.other_tooth);
}

TEST(Likeness, AThirdMolarMayBeLikeItsNeighboursButLikeNoOtherTooth) {
  Likeness judged;
  judged.log_probability.fill(-9);
  judged.log_probability[tooth_of_fdi(27)] = -0.1;
  judged.log_probability[tooth_of_fdi(25)] = -3;
  EXPECT_DOUBLE_EQ(judged.lead_over(tooth_of_fdi(28)), 6) << "over 25; 27 does not count";
  EXPECT_DOUBLE_EQ(judged.lead_over(tooth_of_fdi(26)), 8.9) << "a first molar is known well enough";
  EXPECT_DOUBLE_EQ(judged.lead_over(tooth_of_fdi(18)), 8.9) << "27 is of the other side";
  EXPECT_DOUBLE_EQ(judged.lead_over(tooth_of_fdi(38)), 8.9) << "and of the other jaw";
  EXPECT_DOUBLE_EQ(judged.lead_over(tooth_of_fdi(27)), 0);
}

TEST(Likeness, DoesNotDependOnWhereTheCrownIs) {
  TriangleMesh crown = sample("crown_36.stl");
  const Likeness before = likeness_of(crown);
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, 2, -1).normalized());
  for (Point& p : crown.vertices) p = turn * p + Point(30, -8, 5);
  const Likeness after = likeness_of(crown);
  // Another direction to begin with: columns fall elsewhere.
  EXPECT_EQ(
      std::max_element(before.log_probability.begin(), before.log_probability.end()) - before.log_probability.begin(),
      std::max_element(after.log_probability.begin(), after.log_probability.end()) - after.log_probability.begin());
  EXPECT_NEAR(after.log_unlike, before.log_unlike, 2);
}

std::ptrdiff_t above(double bound, const std::vector<Likeness>& of) {
  return std::count_if(of.begin(), of.end(), [&](const Likeness& l) { return l.log_unlike > bound; });
}

/// Crowns of tooth 3 whose leads over it, and what speaks against their being crowns, rise evenly.
std::vector<Likeness> rising(std::size_t count, double unlike_from, double wrong_side) {
  std::vector<Likeness> crowns(count);
  for (std::size_t i = 0; i < count; ++i) {
    crowns[i].log_probability.fill(-1e4);
    crowns[i].log_probability[3] = -static_cast<double>(i);
    crowns[i].log_probability[2] = wrong_side - static_cast<double>(i);
    crowns[i].log_probability[8] = 0;
    crowns[i].log_unlike = unlike_from + static_cast<double>(i);
  }
  return crowns;
}

TEST(Likeness, BoundsLieAsFarFromCrownsAsStrangersAndSidesAllow) {
  const std::vector<std::size_t> teeth(2000, 3);
  const std::vector<Likeness> strangers = rising(1000, 0, 0);
  // Easily told: the bounds are those of what they are there for.
  const std::vector<Likeness> easy = rising(2000, -1e5, -1e4);
  const LikenessBounds bounds = likeness_bounds(easy, teeth, strangers);
  EXPECT_EQ(above(bounds.unlike, strangers), 959);
  EXPECT_EQ(above(bounds.refused, strangers), 499);
  EXPECT_EQ(
      std::count_if(easy.begin(), easy.end(), [&](const Likeness& l) { return l.lead_over(2) > bounds.other_tooth; }),
      1619);
  // Hardly told: the crowns come first.
  const std::vector<Likeness> hard = rising(2000, 0, 0);
  const LikenessBounds late = likeness_bounds(hard, teeth, strangers);
  EXPECT_EQ(above(late.unlike, hard), 9);
  EXPECT_GE(late.refused, late.unlike);
  EXPECT_EQ(
      std::count_if(hard.begin(), hard.end(), [&](const Likeness& l) { return l.lead_over(3) > late.other_tooth; }), 9);
}

TEST(Likeness, FewCrownsGiveNoBounds) {
  const std::vector<Likeness> crowns = rising(500, 0, 0), strangers = rising(100, 0, 0);
  const std::vector<std::size_t> teeth(500, 3);
  EXPECT_NO_THROW(likeness_bounds(crowns, teeth, strangers));
  EXPECT_THROW(likeness_bounds(rising(499, 0, 0), std::vector<std::size_t>(499, 3), strangers), UsageError);
  EXPECT_THROW(likeness_bounds(crowns, std::vector<std::size_t>(499, 3), strangers), UsageError);
  EXPECT_THROW(likeness_bounds(crowns, teeth, rising(99, 0, 0)), UsageError);
}

TEST(Likeness, BoundsGoThroughAFile) {
  const auto file = std::filesystem::path(testing::TempDir()) / "likeness.safetensors";
  TensorFile weights = read_safetensors(source_folder / "models" / "likeness.safetensors");
  note_bounds({1.5, -0.25, 3}, weights);
  write_safetensors(file, weights);
  const LikenessBounds bounds = load_likeness(file).bounds;
  EXPECT_EQ(bounds.other_tooth, 1.5);
  EXPECT_EQ(bounds.unlike, -0.25);
  EXPECT_EQ(bounds.refused, 3);
  note_bounds({1.5, 3, -0.25}, weights);
  write_safetensors(file, weights);
  EXPECT_THROW(load_likeness(file), InputError) << "what is refused is unlike first";
  weights.tensors.erase("bounds");
  write_safetensors(file, weights);
  EXPECT_THROW(load_likeness(file), InputError);
  std::ofstream(file) << "nothing of the kind";
  EXPECT_THROW(load_likeness(file), InputError);
  std::filesystem::remove(file);
  EXPECT_THROW(load_likeness(file), InputError);
}

TEST(MeanCrownAgreement, TheToothThatItIsAgreesBest) {
  const TriangleMesh crown = sample("crown_36.stl");
  const auto agreement =
      mean_crown_agreement(prepare_crown(crown), atlas(), {tooth_of_fdi(36), tooth_of_fdi(11), tooth_of_fdi(36)});
  ASSERT_EQ(agreement.size(), 3U);
  EXPECT_LT(agreement[0].distance_mm, 1);
  EXPECT_GT(agreement[0].seen, 0.8);
  EXPECT_GT(agreement[0].explained, 0.8);
  EXPECT_GT(agreement[1].distance_mm, agreement[0].distance_mm);
  EXPECT_EQ(agreement[2].distance_mm, agreement[0].distance_mm);
}

TEST(MeanCrownAgreement, IsTheSameForAnyNumberOfThreadsAndAnyPlace) {
  TriangleMesh crown = sample("crown_34.ply");
  const std::vector<std::size_t> teeth{tooth_of_fdi(34), tooth_of_fdi(45), tooth_of_fdi(21)};
  const auto many = mean_crown_agreement(prepare_crown(crown), atlas(), teeth);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto single = mean_crown_agreement(prepare_crown(crown), atlas(), teeth);
    for (std::size_t i = 0; i < many.size(); ++i) {
      EXPECT_EQ(many[i].distance_mm, single[i].distance_mm);
      EXPECT_EQ(many[i].seen, single[i].seen);
    }
  }
  for (Point& p : crown.vertices) p = Point(p.y(), p.z(), p.x()) + Point(30, -8, 5);
  EXPECT_NEAR(mean_crown_agreement(prepare_crown(crown), atlas(), teeth).front().distance_mm, many.front().distance_mm,
              0.05);
}

}  // namespace
}  // namespace rhizodont
