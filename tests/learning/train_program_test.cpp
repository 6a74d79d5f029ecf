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
  expect_error("completions", 2, "did you mean completion?");
  expect_error("completion --data . --out run", 3, "anatomy.csv");
  EXPECT_EQ(run("--version").out.rfind("rhizodont-train ", 0), 0U);
}

TEST_F(TrainProgram, NeverReplacesACardUnasked) {
  folder.write("weights.md", "my notes");
  for (const char* command : {"completion", "skirt"}) {
    expect_error(std::string(command) + " --out run --export weights.safetensors", 2, "--overwrite");
    EXPECT_EQ(test::read_all(folder.path() / "weights.md"), "my notes");
  }
  expect_error("likeness --data . --out weights.ply", 2, "a weight file must not have the name of a mesh");
}

}  // namespace
}  // namespace rhizodont
