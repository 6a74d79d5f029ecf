// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// `synth` as a user meets it: its figures, and registered teeth that are none.
#include "app/program.hpp"
#include "families/one_template.hpp"

#include <nlohmann/json.hpp>

namespace rhizodont {
namespace {

using Json = nlohmann::json;
using test::Outcome;

/// The data folder of one template, outside of a test of its own.
struct Data : test::OneTemplate {
  Data() { SetUp(); }
  void TestBody() override {}
  std::string option() const { return "--data '" + folder.path().string() + "'"; }
};

class SynthProgram : public test::Program {
 protected:
  static const Data& data() {
    static const Data made;
    return made;
  }
};

TEST_F(SynthProgram, GivesItsFiguresAsJson) {
  const Outcome teeth = run("synth " + data().option() + " --type 36 --seed 7 --count 2 --crowns -o teeth --json");
  ASSERT_EQ(teeth.code, 0) << teeth.error;
  const Json figures = Json::parse(teeth.out);
  ASSERT_EQ(figures["teeth"].size(), 2U);
  EXPECT_EQ(figures["teeth"][1]["fdi"], 36);
  EXPECT_EQ(figures["teeth"][1]["seed"], 8);
  EXPECT_GT(figures["teeth"][0]["root_length_mm"], 5);
  EXPECT_EQ(figures["teeth"][0]["roots"], 2);
  for (const Json& tooth : figures["teeth"])
    for (const char* name : {"tooth", "crown"})
      EXPECT_TRUE(fs::exists(folder.path() / tooth[name].get<std::string>())) << tooth;

  const Outcome told = run("synth " + data().option() + " --type 36 --skirts -o skirts --json figures.json");
  ASSERT_EQ(told.code, 0) << told.error;
  EXPECT_NE(told.out.find(" skirt\n"), std::string::npos) << "words stay where figures go to a file: " << told.out;
  const Json skirts = Json::parse(test::read_all(folder.path() / "figures.json"));
  EXPECT_GT(skirts["crowns"][0]["vertices"], skirts["crowns"][0]["skirt"]);
}

TEST_F(SynthProgram, AFolderWithoutRegisteredTeethIsRefused) {
  fs::create_directory(folder.path() / "registered");
  expect_error("synth " + data().option() + " --type 36 -o teeth --registered registered", 3,
               "has no registered tooth");
  EXPECT_FALSE(fs::exists(folder.path() / "teeth"));
}

}  // namespace
}  // namespace rhizodont
