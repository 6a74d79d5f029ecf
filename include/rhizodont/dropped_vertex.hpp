// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <string_view>

namespace rhizodont {

/// Why a tooth has not a vertex of its crown.
enum class DropReason {
  unreferenced,    ///< no triangle has it
  cap,             ///< of what closed the crown's base
  skirt,           ///< gum, not tooth
  spike,           ///< sticks out along the border that was cut
  ragged_border,   ///< the surface is none there: torn, crowded, or cutting itself
  pinched_border,  ///< the border would pass it twice, or it hangs on the rest by such a vertex only
  repair,          ///< the repair that lists it among its vertices
};

/// A vertex of the input that the tooth does not have, and why.
struct DroppedCrownVertex {
  int vertex = 0;  ///< index in the input
  DropReason reason = DropReason::unreferenced;
};

/// The reason as reports say it: "pinched border". They name the action in the place of `repair`.
RHIZODONT_EXPORT std::string_view reason_text(DropReason reason);

}  // namespace rhizodont
