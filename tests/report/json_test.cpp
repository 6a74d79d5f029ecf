// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/json.hpp"

#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace rhizodont {
namespace {

std::string refusal_of_options(const std::string& text) {
  try {
    options_from_json(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Json, OptionsComeBackAsTheyWere) {
  CompleteOptions options;
  EXPECT_EQ(options_to_json(options_from_json("{}")), options_to_json(options));
  options.fdi = 47;
  options.e = 0.1 + 0.2;
  options.cap = CapHandling::keep;
  options.skirt = 0.7;
  options.repair = true;
  options.millimetres_per_unit = 25.4;
  options.transition = 1.0 / 3;
  options.steering = {14.2, -3, 4.5, 1e-7};
  options.threads = 2;
  const CompleteOptions back = options_from_json(options_to_json(options));
  EXPECT_EQ(back.fdi, options.fdi);
  EXPECT_EQ(back.e, options.e);
  EXPECT_EQ(back.cap, options.cap);
  EXPECT_EQ(back.skirt, options.skirt);
  EXPECT_EQ(back.repair, options.repair);
  EXPECT_EQ(back.millimetres_per_unit, options.millimetres_per_unit);
  EXPECT_EQ(back.transition, options.transition);
  EXPECT_EQ(back.steering.length_mm, options.steering.length_mm);
  EXPECT_EQ(back.steering.tip_degrees, options.steering.tip_degrees);
  EXPECT_EQ(back.steering.torque_degrees, options.steering.torque_degrees);
  EXPECT_EQ(back.steering.bend_degrees, options.steering.bend_degrees);
  EXPECT_EQ(back.threads, options.threads);
}

TEST(Json, OptionsMayBeFewAndInWords) {
  const CompleteOptions options =
      options_from_json(R"({"skirt": "auto", "fdi": null, "steering": {"bend_degrees": 5}})");
  EXPECT_EQ(options.skirt, 0.5);
  EXPECT_FALSE(options.fdi);
  EXPECT_EQ(options.steering.bend_degrees, 5);
  EXPECT_EQ(options.e, CompleteOptions().e);
  EXPECT_FALSE(options_from_json(R"({"skirt": "keep"})").skirt);
}

TEST(Json, BadOptionsAreRefusedByName) {
  EXPECT_EQ(refusal_of_options("{"), "The options are no JSON.");
  EXPECT_EQ(refusal_of_options("[]"), "The options must be a JSON object.");
  EXPECT_EQ(refusal_of_options(R"({"e": 1})"), "The options have no \"e\".");
  EXPECT_EQ(refusal_of_options(R"({"fdi": 36.5})"), "The options: the value of \"fdi\" cannot be 36.5.");
  EXPECT_EQ(refusal_of_options(R"({"threads": "two"})"), "The options: the value of \"threads\" cannot be \"two\".");
  EXPECT_EQ(refusal_of_options(R"({"cap": "off"})"), "The options: the value of \"cap\" cannot be \"off\".");
  EXPECT_EQ(refusal_of_options(R"({"skirt": "off"})"), "The options: the value of \"skirt\" cannot be \"off\".");
  EXPECT_EQ(refusal_of_options(R"({"repair": 1})"), "The options: the value of \"repair\" cannot be 1.");
  EXPECT_EQ(refusal_of_options(R"({"steering": {"tip": 1}})"), "The options of steering have no \"tip\".");
}

TEST(Json, ChecksComeBackAsTheyWere) {
  const TriangleMesh tooth = test::sphere(3);
  TriangleMesh crown = tooth;
  crown.triangles.resize(tooth.triangles.size() / 2);
  TriangleMesh open = tooth;
  open.triangles.pop_back();
  for (const TriangleMesh& solid : {tooth, open, crown}) {
    const CheckReport report = check(crown, solid);
    const std::string text = check_to_json(report);
    const CheckReport back = check_from_json(text);
    EXPECT_EQ(check_to_json(back), text);
    EXPECT_EQ(back.holds(), report.holds());
    EXPECT_EQ(back.failures, report.failures);
    EXPECT_EQ(back.solid.volume, report.solid.volume);
    EXPECT_EQ(back.crown.kept_triangles, report.crown.kept_triangles);
  }
}

TEST(Json, MeasuresComeBackAsTheyWere) {
  for (const TriangleMesh& mesh : {test::sphere(3), test::dome(3, 4)}) {
    const std::string text = measures_to_json(measure(mesh));
    EXPECT_EQ(measures_to_json(measures_from_json(text)), text);
    EXPECT_EQ(measures_from_json(text).area, measure(mesh).area);
  }
}

TEST(Json, OtherTextIsNoFigures) {
  EXPECT_THROW(check_from_json("{}"), InputError);
  EXPECT_THROW(check_from_json(measures_to_json(measure(test::sphere(2)))), InputError);
  EXPECT_THROW(measures_from_json(""), InputError);
  auto without = nlohmann::json::parse(measures_to_json(measure(test::sphere(2))));
  without["topology"].erase("edges");
  try {
    measures_from_json(without.dump());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("edges"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace rhizodont
