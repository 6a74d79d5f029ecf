// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/completion_sample.hpp"

#include "base/random_stream.hpp"
#include "completion/registration.hpp"
#include "families/crown_crop.hpp"
#include "families/mean_teeth.hpp"
#include "families/one_template.hpp"
#include "families/template_families.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/error.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace rhizodont {
namespace {

class CompletionSamples : public test::TemplateFamilies {};

using test::OneTemplate;

TEST_F(CompletionSamples, matchedPlacesAreTheSameOnAllTeethOfAType) {
  const ToothFamilies& families = all_families();
  CompletionSampleOptions options;
  options.type = 13;
  std::size_t places = 0, with = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const CompletionSample sample = make_completion_sample(families, seed, options);
    const CompletionTrainingSample& pair = sample.pair;
    if (pair.matched.empty()) continue;
    ++with;
    if (places == 0) places = pair.matched.size();
    ASSERT_EQ(pair.matched.size(), places);
    ASSERT_EQ(pair.matched_normals.size(), places);
    ASSERT_EQ(pair.matched_root.size(), places);
    // The tips in the list of apices are among them.
    for (const Point& apex : sample.apices) {
      double nearest = 1;
      for (const Eigen::Vector3f& p : pair.matched) nearest = std::min(nearest, (p.cast<double>() - apex).norm());
      EXPECT_LT(nearest, 1e-6);
    }
    for (const Eigen::Vector3d& axis : sample.root_axes) EXPECT_NEAR(axis.norm(), 1, 1e-9);
    EXPECT_GT(sample.growth_axis.z(), 0.8);
    EXPECT_LT(sample.furcation_z, 0);
  }
  EXPECT_GE(with, 8U);
}

TEST_F(CompletionSamples, samplesAreInCanonicalPose) {
  const ToothFamilies& families = all_families();
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    CompletionSampleOptions options;
    options.type = std::array{3, 8, 13}[seed % 3];
    const CompletionSample sample = make_completion_sample(families, seed, options);
    const CompletionTrainingSample& pair = sample.pair;
    ASSERT_EQ(pair.input.size(), 1024U);
    ASSERT_EQ(pair.target.size(), 4096U);
    ASSERT_EQ(pair.normals.size(), 4096U);
    ASSERT_EQ(pair.is_root.size(), 4096U);
    ASSERT_EQ(sample.target_cement.size(), 4096U);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3f& p : pair.input) centre += p.cast<double>() / 1024;
    EXPECT_LT(centre.norm(), 0.02);
    for (const Eigen::Vector3f& n : pair.normals) EXPECT_NEAR(n.norm(), 1, 1e-5);
    double lowest = 0;
    for (const Eigen::Vector3f& p : pair.target) lowest = std::min(lowest, static_cast<double>(p.z()));
    // The apices are where the target ends, and the root's length counts from the crop's lowest point.
    double apex = 0;
    for (const Point& p : sample.apices) apex = std::min(apex, p.z());
    EXPECT_NEAR(apex, lowest, 0.06);
    EXPECT_GT(sample.root_length_mm, 5);
    EXPECT_LT(sample.root_length_mm, 27);
    EXPECT_GT(std::count(pair.is_root.begin(), pair.is_root.end(), 1), 1000);
    EXPECT_GT(std::count(pair.is_root.begin(), pair.is_root.end(), 0), 300);
  }
}

TEST_F(CompletionSamples, axisOfTheFormIsWhatLayingTheMeanCrownFinds) {
  const ToothFamilies& families = all_families();
  const Atlas atlas = make_atlas(families);
  CompletionSampleOptions options;
  options.type = 13;
  options.rotation_jitter_radians = options.lost_turn_share = options.form_axis_error_degrees = 0;
  options.scanner_noise_mm = options.gap_probability = options.skirt_probability = options.paper_crop_share = 0;
  Eigen::Vector2d product = Eigen::Vector2d::Zero(), square = product, rest = product;
  constexpr int count = 24;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    // The sample's own crown: the same draws in the same order.
    RandomStream random(seed, 100);
    random.index(tooth_type_count);
    const SyntheticTooth tooth = generate_tooth(families, options.type, random.bits());
    const TriangleMesh crown = draw_cropped_crown(tooth, 0, 0, random).mesh;
    const CrownFrame found = canonical_frame(prepare_crown(crown), 36, atlas.types[13]);
    const CompletionSample sample = make_completion_sample(families, seed, options);
    ASSERT_LT((found.frame.centre - sample.frame.centre).norm(), 1e-9);
    const Eigen::Matrix3d turn = found.frame.rotation * sample.frame.rotation.transpose();
    if (turn(0, 0) < 0.8) continue;  // laid the wrong way round
    const Eigen::Vector2d drawn = sample.pair.form_axis.cast<double>(), error = found.form_axis - drawn;
    product += found.form_axis.cwiseProduct(drawn);
    square += drawn.cwiseAbs2();
    rest += error.cwiseAbs2();
  }
  for (const int i : {0, 1}) {
    EXPECT_NEAR(product[i] / square[i], 1, 0.5) << "slope along " << i;
    EXPECT_LT(rest[i], square[i]) << "tells more than nothing along " << i;
  }
}

TEST_F(CompletionSamples, samplesRepeatAndDiffer) {
  const ToothFamilies& families = all_families();
  CompletionSampleOptions options;
  options.type = 13;
  const CompletionSample a = make_completion_sample(families, 123, options);
  const CompletionSample b = make_completion_sample(families, 123, options);
  EXPECT_EQ(a.pair.input, b.pair.input);
  EXPECT_EQ(a.pair.target, b.pair.target);
  EXPECT_EQ(a.pair.type, b.pair.type);
  EXPECT_NE(a.pair.target, make_completion_sample(families, 124, options).pair.target);
  options.type = 16;
  EXPECT_THROW(make_completion_sample(families, 1, options), UsageError);
  options.type = 13;
  options.form_axis_error_degrees = -1;
  EXPECT_THROW(make_completion_sample(families, 1, options), UsageError);
  options.form_axis_error_degrees = 4;
  options.paper_crop_share = 2;
  EXPECT_THROW(make_completion_sample(families, 1, options), UsageError);
}

TEST_F(OneTemplate, MakesSamplesToTrainWith) {
  CompletionSampleOptions options;
  options.type = test::molar;
  const ToothFamilies families = load();
  const CompletionSample sample = make_completion_sample(families, 5, options);
  EXPECT_EQ(sample.pair.input.size(), 1024U);
  EXPECT_EQ(sample.pair.target.size(), 4096U);
  EXPECT_EQ(sample.pair.type, test::molar);
  EXPECT_TRUE(std::all_of(sample.pair.target.begin(), sample.pair.target.end(),
                          [](const Eigen::Vector3f& p) { return p.allFinite(); }));
  EXPECT_EQ(make_completion_sample(families, 5, options).pair.target, sample.pair.target);
  EXPECT_NE(make_completion_sample(families, 6, options).pair.target, sample.pair.target);
}

}  // namespace
}  // namespace rhizodont
