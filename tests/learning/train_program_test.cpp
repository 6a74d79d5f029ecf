// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// rhizodont-train as it is met: what it asks for, what it never replaces.
#include "app/program.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

class TrainProgram : public test::Program {};

TEST_F(TrainProgram, SaysWhatItNeeds) {
  expect_error("completion --out run", 2, "--data");
  expect_error("skirt --data .", 2, "--out");
  expect_error("likeness --data .", 2, "--out");
  expect_error("pose --data .", 2, "--out");
  expect_error("completions", 2, "did you mean completion?");
  expect_error("completion --data . --out run", 3, "anatomy.csv");
  std::filesystem::create_directory(folder.path() / "data");
  folder.write("data/anatomy.csv", "teeth");
  for (const char* call :
       {"completion --out run", "skirt --out run", "likeness --out weights", "pose --out weights", "segment --out run"})
    expect_error(call + std::string(" --data data --json data/anatomy.csv"), 2, "which is read");
  EXPECT_EQ(test::read_all(folder.path() / "data/anatomy.csv"), "teeth");
  EXPECT_EQ(run("--version").out.rfind("rhizodont-train ", 0), 0U);
}

TEST_F(TrainProgram, NeverReplacesACardUnasked) {
  folder.write("weights.md", "my notes");
  for (const char* command : {"completion", "skirt"}) {
    expect_error(std::string(command) + " --out run --export weights.safetensors", 2, "--overwrite");
    EXPECT_EQ(test::read_all(folder.path() / "weights.md"), "my notes");
  }
  for (const char* command : {"likeness", "pose"})
    expect_error(command + std::string(" --data . --out weights.ply"), 2,
                 "a weight file must not have the name of a mesh");
}

TEST_F(TrainProgram, CalibrateAsksForWhatItNeeds) {
  for (const char* model : {"completion.safetensors", "atlas.safetensors"}) folder.write(model, "weights");
  std::filesystem::create_directory(folder.path() / "data");
  expect_error("calibrate --data .", 2, "--models");
  expect_error("calibrate --models .", 2, "--data");
  expect_error("calibrate --data data --models . --text table.ply", 2, "a text must not have the name of a mesh");
  expect_error("calibrate --data data --models .", 3, "anatomy.csv");
}

TEST_F(TrainProgram, CalibrateReplacesNothingThatItReads) {
  for (const char* model : {"completion.safetensors", "atlas.safetensors"}) folder.write(model, "weights");
  folder.write("people.json", "lengths");
  std::filesystem::create_directory(folder.path() / "registered");
  folder.write("registered/tooth_36_a.txt", "a tooth");
  std::filesystem::create_directory(folder.path() / "data");
  for (const char* option : {"--text", "--json"}) {
    const std::string call = "calibrate --data data --models . ";
    expect_error(call + "--population people.json " + option + " people.json", 2, "which is read");
    expect_error(call + "--registered registered " + option + " registered/tooth_36_a.txt", 2, "which is read");
    expect_error(call + option + " completion.safetensors", 2, "");
  }
  EXPECT_EQ(test::read_all(folder.path() / "people.json"), "lengths");
  EXPECT_EQ(test::read_all(folder.path() / "registered/tooth_36_a.txt"), "a tooth");
}

}  // namespace
}  // namespace rhizodont
