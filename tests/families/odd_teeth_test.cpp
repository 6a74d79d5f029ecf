// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Teeth at the ends of what is drawn, and gum lines that lean, on the one template beside this file.
#include "base/random_stream.hpp"
#include "families/crown_crop.hpp"
#include "families/one_template.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/self_intersection.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::molar;

constexpr double degree = std::numbers::pi / 180;

class OddTeeth : public test::OneTemplate {
 protected:
  ToothFamilies grown(const std::string& of_36 = "{}") const {
    const std::filesystem::path table = folder.path() / "people.json";
    std::ofstream(table) << R"({"format": "rhizodont population 1", "teeth": {"36": )" << of_36 << "}}";
    return load(table);
  }

  static void expect_sound(const ToothFamilies& families, const ToothVariation& variation, const char* what,
                           const SharedDraws& shared = {}) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      const SyntheticTooth tooth = generate_tooth(families, molar, seed, variation, shared);
      EXPECT_TRUE(diagnose(tooth.mesh).is_closed_solid()) << what << " seed " << seed;
      EXPECT_EQ(diagnose(tooth.mesh).euler_number, 2) << what << " seed " << seed;
      EXPECT_TRUE(self_intersecting_triangles(tooth.mesh).empty()) << what << " seed " << seed;
    }
  }
};

TEST_F(OddTeeth, StayClosedSolids) {
  const ToothFamilies families = grown();
  using Share = double ToothVariation::*;
  const std::vector<std::pair<const char*, Share>> odd{{"immature", &ToothVariation::open_apex_share},
                                                       {"resorbed", &ToothVariation::resorption_share},
                                                       {"bulbous", &ToothVariation::bulbous_share},
                                                       {"milk-like", &ToothVariation::deciduous_share},
                                                       {"blunt", &ToothVariation::blunt_share}};
  for (const auto& [what, share] : odd) {
    ToothVariation variation;
    variation.*share = 1;
    expect_sound(families, variation, what);
  }
  ToothVariation all_worn;
  all_worn.wear_share = 1;
  SharedDraws most_worn;
  most_worn.wear = 3;
  expect_sound(families, all_worn, "worn", most_worn);
  expect_sound(grown(R"({"short_root_share": 1})"), {}, "short");
  expect_sound(grown(R"({"fused_share": 1})"), {}, "fused");
  expect_sound(grown(R"({"curved_share": 1, "curve_degrees": 30, "dilaceration_share": 1})"), {}, "curved");
}

TEST_F(OddTeeth, ShortRootsAreShortAndBulbousOnesSwell) {
  ToothVariation calm;
  calm.root_length = calm.warp_mm = calm.taper = calm.root_thickness = 0;
  calm.open_apex_share = calm.resorption_share = calm.bulbous_share = calm.deciduous_share = 0;
  const ToothFamilies usual = grown(R"({"short_root_share": 0})"), shortened = grown(R"({"short_root_share": 1})");
  ToothVariation bulbous = calm;
  bulbous.bulbous_share = 1;
  // Mean distance of the surface of the roots' last 4 mm from the line through their middles.
  const auto thickness = [](const SyntheticTooth& tooth) {
    double sum = 0, count = 0;
    for (std::size_t r = 0; r < tooth.apices.size(); ++r) {
      std::vector<Eigen::Vector2d> places;
      for (std::size_t v = 0; v < tooth.root.size(); ++v) {
        const Point& p = tooth.mesh.vertices[v];
        const double above = p.z() - tooth.apices[r].z();
        if (tooth.root[v] == static_cast<int>(r) && above > 1 && above < 4) places.emplace_back(p.head<2>());
      }
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();
      for (const Eigen::Vector2d& p : places) middle += p / static_cast<double>(places.size());
      for (const Eigen::Vector2d& p : places) sum += (p - middle).norm(), count += 1;
    }
    return sum / count;
  };
  double thicker = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const SyntheticTooth tooth = generate_tooth(usual, molar, seed, calm);
    const double share = generate_tooth(shortened, molar, seed, calm).root_length / tooth.root_length;
    EXPECT_GT(share, 0.45) << seed;
    EXPECT_LT(share, 0.8) << seed;
    thicker += thickness(generate_tooth(usual, molar, seed, bulbous)) / thickness(tooth) / 10;
  }
  EXPECT_GT(thicker, 1.1);
}

TEST_F(OddTeeth, TheMostWornHaveLostHalfOfTheirCrowns) {
  const ToothFamilies families = grown();
  ToothVariation worn = {}, whole = {};
  worn.decay_share = whole.decay_share = worn.bracket_share = whole.bracket_share = worn.deciduous_share =
      whole.deciduous_share = whole.wear_share = 0;
  // The highest within 2 mm of the axis: one side of a worn crown may stand higher.
  const auto middle = [](const SyntheticTooth& tooth) {
    double height = 0;
    for (const Point& p : tooth.mesh.vertices)
      if (p.head<2>().norm() < 2) height = std::max(height, p.z());
    return height;
  };
  const auto left = [&](double rank) {
    SharedDraws shared;
    shared.wear = rank;
    return middle(generate_tooth(families, molar, 5, worn, shared)) /
           middle(generate_tooth(families, molar, 5, whole, shared));
  };
  EXPECT_EQ(left(-0.1), 1) << "half of all teeth are worn";
  EXPECT_GT(left(0.5), 0.85);
  EXPECT_LT(left(4), 0.65);
  EXPECT_GT(left(4), 0.4);
}

TEST_F(OddTeeth, GumLinesLeanWithAHeavyTail) {
  const SyntheticTooth tooth = mean_tooth(load(), molar);
  constexpr int draws = 20'000;
  double steep = 0, steeper = 0, steepest = 0, one_sided = 0, no_contact = 0;
  for (std::uint64_t seed = 0; seed < draws; ++seed) {
    RandomStream random(seed);
    const GumLine line = draw_gum_line(tooth, 0, 0, random);
    const double lean = std::atan(line.slope.norm()) / degree;
    steep += lean > 15 ? 1.0 / draws : 0.0, steeper += lean > 25 ? 1.0 / draws : 0.0;
    steepest = std::max(steepest, lean);
    one_sided += line.side_mm > 0 ? 1.0 / draws : 0.0;
    no_contact += line.gap_mm[0] > 0 || line.gap_mm[1] > 0 ? 1.0 / draws : 0.0;
    EXPECT_LE(line.side_mm, 3);
    EXPECT_LE(std::max(line.gap_mm[0], line.gap_mm[1]), 0.8 * tooth.crown_height);
  }
  constexpr double gum_lines = 0.65;  // the others are trimmed across the long axis
  EXPECT_GT(steep, gum_lines * 0.08);
  EXPECT_LT(steep, gum_lines * 0.08 + 0.015) << "and the usual lean's own tail";
  EXPECT_NEAR(steeper, gum_lines * 0.08 / 2, 0.005);
  EXPECT_GT(steepest, 34);
  EXPECT_LE(steepest, 35 + 1e-9);
  EXPECT_NEAR(one_sided, gum_lines * 0.3, 0.01);
  EXPECT_NEAR(no_contact, gum_lines * 0.5 * (1 - 0.15 * 0.15), 0.012);
}

TEST(GumLine, MayStandHigherOnOneSide) {
  GumLine line;
  line.side_mm = 2, line.side_angle = std::numbers::pi / 2, line.side_width = 0.8;
  const JunctionHeight flat;
  EXPECT_NEAR(line.height(flat, 0, 3), 2, 1e-9);
  EXPECT_NEAR(line.height(flat, 3, 0), 2 * std::exp(-0.5 * std::pow(std::numbers::pi / 2 / 0.8, 2)), 1e-9);
  EXPECT_LT(line.height(flat, 0, -3), 0.01);
}

TEST_F(OddTeeth, CropsAreDiscsHoweverTheGumLies) {
  const ToothFamilies families = grown();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const SyntheticTooth tooth = generate_tooth(families, molar, seed);
    RandomStream random(seed);
    const CroppedCrown crown = draw_cropped_crown(tooth, 0.15, 0.35, random);
    const Diagnosis diagnosis = diagnose(crown.mesh);
    EXPECT_TRUE(diagnosis.is_oriented_manifold());
    EXPECT_EQ(diagnosis.components, 1);
    EXPECT_EQ(diagnosis.border_loop_count, 1);
    EXPECT_EQ(diagnosis.euler_number, 1);
    EXPECT_TRUE(diagnosis.unreferenced_vertices.empty());
    // Steepest of all, with a side that stands high: one border still.
    GumLine steep;
    const double angle = 0.1 * static_cast<double>(seed);
    steep.slope = std::tan(35 * degree) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    steep.side_mm = 3, steep.side_angle = angle + 2, steep.side_width = 0.5;
    const auto cut = crop_crown(tooth, steep);
    EXPECT_TRUE(!cut || diagnose(*cut).border_loop_count == 1);
  }
}

}  // namespace
}  // namespace rhizodont
