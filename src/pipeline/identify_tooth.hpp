// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/registration.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/completion_record.hpp"
#include "teeth/prepared_crown.hpp"

#include <optional>
#include <string>

namespace rhizodont {

/// Which tooth a crown is.
struct IdentifiedTooth {
  int fdi = 0;
  bool guessed = false;                   ///< nobody said
  std::optional<CrownLikeness> likeness;  ///< not there if there is nothing to judge by
  CrownFrame frame;                       ///< canonical pose for that tooth
  std::optional<std::string> warning;     ///< a sentence for the user
};

/// The canonical pose of a crown whose tooth is known, by what the models have for it. Throws as `canonical_frame`.
CrownFrame lay_crown(const PreparedCrown& crown, int fdi, const std::optional<ToothDirections>& directions,
                     const CompletionModels::Content& models);

/// Which tooth the crown is, whether it looks like it, and its canonical pose. @param fdi unset: guessed, and so said
/// @param directions  how it stands, where that is known
/// Throws InputError for what looks like no tooth, and as `canonical_frame`.
IdentifiedTooth identify_tooth(const PreparedCrown& crown, std::optional<int> fdi,
                               const std::optional<ToothDirections>& directions,
                               const CompletionModels::Content& models);

}  // namespace rhizodont
