// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stopwatch.hpp"
#include "base/peak_memory.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

namespace rhizodont {
namespace {

TEST(Stopwatch, CountsFromItsLastStart) {
  Stopwatch watch;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const double first = watch.restart();
  EXPECT_GE(first, 0.1);
  EXPECT_LT(watch.seconds(), first) << "from zero again";
}

TEST(PeakMemory, GrowsWithWhatIsHeldAndDoesNotFall) {
  EXPECT_GT(peak_memory_mb(), 1);
  {
    std::vector<char> much(std::size_t{200} << 20);
    for (std::size_t i = 0; i < much.size(); i += 4096) *static_cast<volatile char*>(&much[i]) = 1;
  }
  EXPECT_GT(peak_memory_mb(), 200);
}

}  // namespace
}  // namespace rhizodont
