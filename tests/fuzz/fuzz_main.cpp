// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/targets.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// What libFuzzer calls; what leaves a target is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rhizodont::test;
  static const FuzzTarget target = fuzz_targets().at(RHIZODONT_FUZZ_TARGET);
  try {
    target({reinterpret_cast<const char*>(data), size});
  } catch (const BrokenRule& rule) {
    std::fprintf(stderr, "broken: %s\n", rule.what.c_str());
    std::abort();
  }
  return 0;
}
