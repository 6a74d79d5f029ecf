// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// People, and what a population's table changes, on the one template beside this file.
#include "families/person.hpp"

#include "families/one_template.hpp"
#include "families/statistics.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::correlation, test::deviation_of, test::mean_of, test::molar;

class People : public test::OneTemplate {
 protected:
  static constexpr int upper_molar = 5;

  ToothFamilies grown(const std::string& teeth = "", std::vector<int> types = {molar}) const {
    FamilyLoadOptions options;
    options.types = std::move(types);
    options.vertices = 600;
    if (!teeth.empty()) {
      options.population = folder.path() / "people.json";
      std::ofstream(options.population) << R"({"format": "rhizodont population 1", "teeth": )" << teeth << "}";
    }
    return load_tooth_families(folder.path(), options);
  }

  /// `figure` of `count` teeth 36 of different seeds.
  static std::vector<double> of_molars(const ToothFamilies& families, const ToothVariation& variation,
                                       const std::function<double(const SyntheticTooth&)>& figure,
                                       std::size_t count = 60) {
    std::vector<double> values(count);
    tbb::parallel_for(std::size_t{0}, count,
                      [&](std::size_t i) { values[i] = figure(generate_tooth(families, molar, i, variation)); });
    return values;
  }
};

double root_length_of(const SyntheticTooth& tooth) { return tooth.root_length; }

TEST_F(People, RootsAreLongerByWhatATableSays) {
  ToothVariation variation;  // all, but what shortens some roots by a share of their length
  variation.open_apex_share = variation.resorption_share = variation.deciduous_share = variation.blunt_share = 0;
  variation.short_roots = variation.warp_mm = 0;
  const auto lengths = [&](const std::string& table) { return of_molars(grown(table), variation, root_length_of); };
  const std::vector<double> shorter = lengths(R"({"36": {"root_length_mm": 12}})"),
                            longer = lengths(R"({"36": {"root_length_mm": 14.5}})");
  EXPECT_NEAR(mean_of(longer) - mean_of(shorter), 2.5, 0.15);
}

TEST_F(People, LengthsDeviateByWhatATableSays) {
  ToothVariation variation = no_variation();
  variation.root_length = 1;
  for (const double wanted : {0.6, 1.8}) {
    const std::string table =
        R"({"36": {"root_follows_crown": 0, "root_length_deviation_mm": )" + std::to_string(wanted) + "}}";
    const std::vector<double> lengths = of_molars(grown(table), variation, root_length_of, 300);
    EXPECT_NEAR(deviation_of(lengths), wanted, 0.12 * wanted) << "three times what 300 teeth leave open";
  }
}

TEST_F(People, RootsPartWhereATableSays) {
  const auto trunk = [&](const std::string& table) {
    ToothVariation variation = no_variation();
    variation.fusion = 1;
    return mean_of(of_molars(grown(table), variation, [](const SyntheticTooth& t) { return -t.furcation_z; }));
  };
  const double early = trunk(R"({"36": {"trunk_mm": 3, "fused_share": 0}})"),
               late = trunk(R"({"36": {"trunk_mm": 4.5, "fused_share": 0}})"),
               fused = trunk(R"({"36": {"trunk_mm": 3, "fused_share": 1}})");
  // The height map rounds its changes of slope off, so that no neck becomes a ledge: 0.7 of the table's difference.
  EXPECT_NEAR(late - early, 0.7 * 1.5, 0.15);
  EXPECT_GT(fused, early + 4) << "fused roots part in the second half of their length";
}

TEST_F(People, LengthsOfOnePersonGoTogetherAsStated) {
  const ToothFamilies families = grown("", {upper_molar, molar});
  ASSERT_TRUE(families.loans.empty());
  ToothVariation variation = no_variation();
  variation.root_length = 1;
  constexpr std::size_t people = 300;
  std::vector<double> left(people), right(people), other(people);
  tbb::parallel_for(std::size_t{0}, people, [&](std::size_t i) {
    const PersonDraw person = draw_person(i);
    left[i] = generate_tooth_of_person(families, 36, person, variation).root_length;
    right[i] = generate_tooth_of_person(families, 46, person, variation).root_length;
    other[i] = generate_tooth_of_person(families, 26, person, variation).root_length;
  });
  // Three times what 300 people leave open.
  const PersonVariation stated;
  EXPECT_NEAR(correlation(left, right), stated.root_length.of_person + stated.root_length.of_pair, 0.07);
  EXPECT_NEAR(correlation(left, other), stated.root_length.of_person, 0.14);
  std::vector<double> strangers = right;
  std::rotate(strangers.begin(), strangers.begin() + 1, strangers.end());
  EXPECT_NEAR(correlation(left, strangers), 0, 0.18);
}

TEST_F(People, LeftAndRightDifferByWhatIsTheirOwnAlone) {
  const ToothFamilies families = grown();
  PersonVariation all_shared;
  all_shared.size = all_shared.root_length = all_shared.root_thickness = all_shared.wear = {0.5, 0.5};
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const PersonDraw person = draw_person(seed);
    const auto tooth = [&](int fdi, const PersonVariation& persons) {
      return generate_tooth_of_person(families, fdi, person, {}, persons);
    };
    EXPECT_EQ(tooth(36, all_shared).mesh.vertices, tooth(46, all_shared).mesh.vertices);
    const SyntheticTooth left = tooth(36, {}), right = tooth(46, {}), stranger = generate_tooth(families, molar, 99);
    EXPECT_NE(left.mesh.vertices, right.mesh.vertices);
    EXPECT_EQ(left.mesh.vertices, tooth(36, {}).mesh.vertices) << "the same again";
    const auto apart = [&](const SyntheticTooth& tooth) {
      double sum = 0;
      for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
        sum += (tooth.mesh.vertices[v] - left.mesh.vertices[v]).norm();
      return sum / static_cast<double>(tooth.mesh.vertices.size());
    };
    EXPECT_LT(apart(right), 0.7 * apart(stranger));
  }
}

TEST_F(People, OnlyTheYoungHaveImmatureRootsThirdMolarsLongest) {
  constexpr int third_molar = 15;
  const ToothFamilies families = grown("", {molar, third_molar});
  ToothVariation open = no_variation(), closed = no_variation();
  open.open_apex_share = 1;
  const auto is_immature = [&](int fdi, double years) {
    PersonDraw person = draw_person(3);
    const PersonVariation persons;
    person.age_rank = (years - persons.youngest) / (persons.oldest - persons.youngest);
    EXPECT_NEAR(person.age_years(), years, 1e-9);
    return generate_tooth_of_person(families, fdi, person, open).root_length <
           0.95 * generate_tooth_of_person(families, fdi, person, closed).root_length;
  };
  EXPECT_TRUE(is_immature(36, 13));
  EXPECT_FALSE(is_immature(36, 17));
  EXPECT_TRUE(is_immature(38, 17));
  EXPECT_FALSE(is_immature(38, 30));
}

TEST_F(People, TheOldAreMoreWorn) {
  const ToothFamilies families = grown();
  ToothVariation variation = no_variation();
  variation.wear_mm = 3, variation.wear_share = 0.5;
  const auto height = [&](double age_rank) {
    std::vector<double> heights;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      PersonDraw person = draw_person(seed);
      person.age_rank = age_rank;
      heights.push_back(generate_tooth_of_person(families, 36, person, variation).crown_height);
    }
    return mean_of(heights);
  };
  EXPECT_LT(height(0.95) + 0.5, height(0.05));
}

TEST_F(People, SharesMustAddUp) {
  PersonVariation persons;
  persons.size = {0.7, 0.4};
  EXPECT_THROW(generate_tooth_of_person(grown(), 36, draw_person(1), {}, persons), UsageError);
  EXPECT_THROW(generate_tooth_of_person(grown(), 66, draw_person(1)), UsageError);
}

TEST(PersonDraw, DependsOnItsSeedAlone) {
  const PersonDraw a = draw_person(7), again = draw_person(7), b = draw_person(8);
  EXPECT_EQ(a.root_length, again.root_length);
  EXPECT_EQ(a.pair_wear, again.pair_wear);
  EXPECT_NE(a.root_length, b.root_length);
  std::vector<double> ages;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) ages.push_back(draw_person(seed).age_years());
  EXPECT_NEAR(mean_of(ages), 46, 2.5);
}

}  // namespace
}  // namespace rhizodont
