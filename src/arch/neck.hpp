// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"

namespace rhizodont {

/// Length-weighted middle of the line between a tooth's scanned triangles and its new ones, in the tooth's unit.
Point middle_of_border(const CompletedTooth& tooth);

/// Of its scanned vertices, along the growth axis: where its root begins, as far as lengths go.
double lowest_of_crown(const CompletedTooth& tooth);

}  // namespace rhizodont
