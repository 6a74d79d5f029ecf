// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/loaded_blas.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace rhizodont {
namespace {

TEST(Blas, TheFastOneIsLoaded) {
  const LoadedBlas blas = loaded_blas();
  EXPECT_NE(blas.path.find("blas"), std::string::npos);
  EXPECT_EQ(blas.fast, blas_warning().empty());
  if (std::filesystem::exists("/usr/lib/x86_64-linux-gnu/openblas-openmp/libblas.so.3")) {
    EXPECT_TRUE(blas.fast);
  }
}

}  // namespace
}  // namespace rhizodont
