// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Options and figures as JSON: what was read is written and read again without a change.
#include "fuzz/targets.hpp"
#include "rhizodont/json.hpp"

namespace rhizodont::test {
namespace {

template <class T>
bool read_and_write(std::string_view bytes, T (*read)(std::string_view), std::string (*write)(const T&)) {
  T value;
  if (!is_taken([&] { value = read(bytes); })) return false;
  const std::string text = write(value);
  require_rule(write(read(text)) == text, "another text when written and read");
  return true;
}

}  // namespace

bool fuzz_options(std::string_view bytes) { return read_and_write(bytes, options_from_json, options_to_json); }
bool fuzz_check_json(std::string_view bytes) { return read_and_write(bytes, check_from_json, check_to_json); }
bool fuzz_measures_json(std::string_view bytes) { return read_and_write(bytes, measures_from_json, measures_to_json); }

}  // namespace rhizodont::test
