// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace rhizodont::test {

inline const std::filesystem::path shared_data = std::filesystem::path(RHIZODONT_SOURCE_DIR) / ".." / "shared" / "data";

/// On the template teeth; skipped where these are missing.
class TemplateFamilies : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared_data / "templates" / "tooth_21.ply"))
      GTEST_SKIP() << "no template teeth in " << shared_data;
  }

  // Reading takes seconds: one set for all tests.
  static const ToothFamilies& all_families() {
    static const ToothFamilies families = [] {
      FamilyLoadOptions options;
      options.vertices = 3000;
      return load_tooth_families(shared_data, options);
    }();
    return families;
  }
};

}  // namespace rhizodont::test
