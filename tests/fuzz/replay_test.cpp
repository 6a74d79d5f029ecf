// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Every fuzz target over its committed inputs: the corpus it starts from, and what once was a finding.
#include "common/temporary_folder.hpp"
#include "fuzz/targets.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace rhizodont::test {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(RHIZODONT_SOURCE_DIR) / "tests/fuzz";

class Fuzz : public testing::TestWithParam<std::string> {
 protected:
  /// How many of a folder's inputs were taken.
  static int run_all(const fs::path& inputs) {
    int taken = 0;
    if (!fs::exists(inputs)) return 0;
    for (const auto& entry : fs::directory_iterator(inputs)) {
      SCOPED_TRACE(entry.path());
      const std::string bytes = read_all(entry.path());
      try {
        taken += static_cast<int>(fuzz_targets().at(GetParam())(bytes));
        // cut off anywhere, and with a byte more
        for (std::size_t k = 1; k < 8; ++k) fuzz_targets().at(GetParam())(bytes.substr(0, bytes.size() * k / 8));
        fuzz_targets().at(GetParam())(bytes + '\xff');
      } catch (const BrokenRule& rule) {
        ADD_FAILURE() << rule.what;
      }
    }
    return taken;
  }
};

TEST_P(Fuzz, CommittedInputsBreakNoRule) {
  EXPECT_GE(run_all(folder / "corpus" / GetParam()), 2) << "a corpus is to lead behind the first refusal";
  run_all(folder / "regressions" / GetParam());
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, target] : fuzz_targets()) all.push_back(name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Fuzz, testing::ValuesIn(names()), [](const auto& name) { return name.param; });

TEST(FuzzInputs, EveryFolderHasATarget) {
  for (const char* kind : {"corpus", "regressions"})
    for (const auto& entry : fs::directory_iterator(folder / kind))
      EXPECT_TRUE(fuzz_targets().contains(entry.path().filename().string())) << entry.path();
}

}  // namespace
}  // namespace rhizodont::test
