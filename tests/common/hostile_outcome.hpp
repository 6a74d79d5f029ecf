// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"

#include <string>
#include <vector>

// What became of a bad crown, told by the product's own check.
namespace rhizodont::test {

/// What is wrong with a tooth, a sentence each; empty where all promises hold: `check` against the crown as it was
/// given, exactly and as a user checks it, and but for vertices that the report names, none of the crown's is missing;
/// all numbers finite.
std::vector<std::string> broken_promises(const TriangleMesh& crown, const CompletedTooth& tooth);

struct HostileOutcome {
  enum class Kind {
    made,         ///< a tooth, and all promises hold
    warned,       ///< the same, with warnings
    unusable,     ///< refused (InputError)
    no_result,    ///< refused (NoResultError)
    broken,       ///< a tooth that breaks a promise
    other_error,  ///< an exception that is no refusal, or one without a reason
  };
  Kind kind = Kind::made;
  std::string sentence;  ///< why; of a tooth that is warned of, the first warning
};

/// Completes a crown and proves the tooth.
HostileOutcome outcome_of(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options);

/// One word.
const char* name_of(HostileOutcome::Kind kind);

}  // namespace rhizodont::test
