// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "io/io_test_tools.hpp"

#include <sys/wait.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

// The program run as a user runs it, in a folder of its own.
namespace rhizodont::test {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string out, error;
};

class Program : public ::testing::Test {
 protected:
  /// `before_the_program`: shell words such as "timeout 1" or "cat FILE |".
  Outcome run(const std::string& arguments, const std::string& before_the_program = {}) const {
    const fs::path out = logs_.path() / "out", error = logs_.path() / "error";
    const std::string command = "cd '" + folder.path().string() + "' && exec < /dev/null && " + before_the_program +
                                " '" RHIZODONT_PROGRAM "' " + arguments + " > '" + out.string() + "' 2> '" +
                                error.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_all(out), read_all(error)};
  }

  // ends with this code and says one line that holds `words`
  void expect_error(const std::string& arguments, int code, const std::string& words) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.error;
    EXPECT_NE(outcome.error.find(words), std::string::npos) << outcome.error << "\nshould hold: " << words;
    EXPECT_EQ(outcome.error.rfind(fs::path(RHIZODONT_PROGRAM).filename().string() + ": ", 0), 0U) << outcome.error;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  }

  TemporaryFolder folder;

 private:
  TemporaryFolder logs_;
};

}  // namespace rhizodont::test
