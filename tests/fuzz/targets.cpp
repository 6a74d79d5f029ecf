// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/targets.hpp"

#include "rhizodont/error.hpp"

#include <algorithm>

namespace rhizodont::test {

const std::map<std::string, FuzzTarget>& fuzz_targets() {
  static const std::map<std::string, FuzzTarget> targets{{"any", fuzz_any_mesh},
                                                         {"check_json", fuzz_check_json},
                                                         {"gzip", fuzz_gzip},
                                                         {"job", fuzz_job},
                                                         {"labels", fuzz_labels},
                                                         {"measures_json", fuzz_measures_json},
                                                         {"obj", fuzz_obj},
                                                         {"off", fuzz_off},
                                                         {"options", fuzz_options},
                                                         {"palette", fuzz_palette},
                                                         {"ply", fuzz_ply},
                                                         {"report", fuzz_report},
                                                         {"root_lengths", fuzz_root_lengths},
                                                         {"steering", fuzz_steering},
                                                         {"stl", fuzz_stl},
                                                         {"vtk", fuzz_vtk},
                                                         {"vtp", fuzz_vtp}};
  return targets;
}

void require_rule(bool holds, const std::string& what) {
  if (!holds) throw BrokenRule{what};
}

bool is_taken(const std::function<void()>& reader) {
  try {
    reader();
    return true;
  } catch (const Error& error) {
    require_rule(error.code() == ErrorCode::unusable_input || error.code() == ErrorCode::wrong_usage,
                 "a refusal of another kind");
    const std::string sentence = error.what();
    require_rule(sentence.size() > 5, "a refusal without a reason");
    require_rule(
        std::none_of(sentence.begin(), sentence.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }),
        "a refusal with letters that are not for showing: " + sentence);
    return false;
  }
}

}  // namespace rhizodont::test
