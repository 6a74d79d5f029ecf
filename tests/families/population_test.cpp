// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/population.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace rhizodont {
namespace {

std::string refusal(const std::string& text) {
  try {
    read_population(text, "people.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

std::string with_teeth(const std::string& teeth) {
  return R"({"format": "rhizodont population 1", "teeth": )" + teeth + "}";
}

TEST(Population, TheDefaultHasAllValuesOfAllTeeth) {
  const Population& population = default_population();
  EXPECT_EQ(population.name, "middle of published populations");
  for (const ToothPopulation& tooth : population.teeth) {
    EXPECT_GT(tooth.root_length_mm, 9);
    EXPECT_LT(tooth.root_length_mm, 17);
    EXPECT_GT(tooth.root_length_deviation_mm, 1);
    EXPECT_GT(tooth.crown_size_deviation, 0);
    EXPECT_GT(tooth.root_thickness_deviation, 0);
  }
  EXPECT_EQ(population.teeth[2].root_length_mm, 15.6);
  EXPECT_EQ(population.teeth[13].trunk_mm, 3.4);
  EXPECT_EQ(population.teeth[7].fused_share, 0.56);
}

TEST(Population, ATableChangesWhatItNamesAlone) {
  const Population population =
      read_population(with_teeth(R"({"24": {"neighbour_share": 0.5, "root_length_mm": 12}})"), "people.json");
  EXPECT_EQ(population.teeth[3].neighbour_share, 0.5);
  EXPECT_EQ(population.teeth[3].root_length_mm, 12);
  EXPECT_EQ(population.teeth[3].curve_degrees, default_population().teeth[3].curve_degrees);
  EXPECT_EQ(population.teeth[4].neighbour_share, default_population().teeth[4].neighbour_share);
}

TEST(Population, WhatCannotBeUsedIsNamed) {
  const auto names = [](const std::string& text, const std::string& what) {
    EXPECT_NE(refusal(text).find(what), std::string::npos) << refusal(text);
    EXPECT_NE(refusal(text).find("people.json"), std::string::npos) << refusal(text);
  };
  names("{", "no JSON");
  names("[]", "rhizodont population 1");
  names(R"({"format": "another"})", "rhizodont population 1");
  names(R"({"format": "rhizodont population 1", "tooth": {}})", "\"tooth\"");
  names(with_teeth("3"), "\"teeth\"");
  names(with_teeth(R"({"14": {}})"), "\"14\" is no tooth of the left side");
  names(with_teeth(R"({"39": {}})"), "\"39\" is no tooth of the left side");
  names(with_teeth(R"({"36": 14})"), "tooth 36");
  names(with_teeth(R"({"36": {"root_mm": 14}})"), "\"root_mm\"");
  names(with_teeth(R"({"36": {"root_length_mm": "14"}})"), "root_length_mm of tooth 36 is no number");
  names(with_teeth(R"({"36": {"root_length_mm": 140}})"),
        "root_length_mm of tooth 36 is 140, and must be from 4 to 30");
  names(with_teeth(R"({"36": {"fused_share": -0.1}})"), "fused_share of tooth 36 is -0.1");
  names(with_teeth(R"({"23": {"neighbour_share": 0.2}})"), "neighbour_share of tooth 23 must be 0");
  EXPECT_THROW(load_population("/no/such/table.json"), InputError);
  EXPECT_THROW(load_population("/tmp"), InputError);
}

}  // namespace
}  // namespace rhizodont
