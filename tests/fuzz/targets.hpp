// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

// What reads bytes that others made: libFuzzer calls these functions with bytes of its own (scripts/fuzz.sh), the tests
// with those that are committed.
namespace rhizodont::test {

/// Gives the bytes to a reader; whether it took them. What the reader refuses, it refuses with a typed error in one
/// line. Throws BrokenRule if it does not, or if what it has read is not what its declaration promises; other
/// exceptions are faults too.
using FuzzTarget = bool (*)(std::string_view bytes);

/// All targets by name: the names of the folders in tests/fuzz/corpus.
const std::map<std::string, FuzzTarget>& fuzz_targets();

/// A reader did not keep what it promises. No error of ours, so that no target takes it for a refusal.
struct BrokenRule {
  std::string what;
};

/// Throws BrokenRule unless it holds.
void require_rule(bool holds, const std::string& what);

/// Runs a reader, and looks at its refusal: InputError or UsageError, one printable line that says something. Returns
/// whether the reader took the bytes.
bool is_taken(const std::function<void()>& reader);

// The targets; their files say what is demanded of each.
bool fuzz_any_mesh(std::string_view bytes);
bool fuzz_ply(std::string_view bytes);
bool fuzz_stl(std::string_view bytes);
bool fuzz_obj(std::string_view bytes);
bool fuzz_off(std::string_view bytes);
bool fuzz_vtp(std::string_view bytes);
bool fuzz_vtk(std::string_view bytes);
bool fuzz_gzip(std::string_view bytes);
bool fuzz_labels(std::string_view bytes);
bool fuzz_palette(std::string_view bytes);
bool fuzz_root_lengths(std::string_view bytes);
bool fuzz_options(std::string_view bytes);
bool fuzz_check_json(std::string_view bytes);
bool fuzz_measures_json(std::string_view bytes);
bool fuzz_report(std::string_view bytes);
bool fuzz_job(std::string_view bytes);
bool fuzz_steering(std::string_view bytes);

}  // namespace rhizodont::test
