// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// Whether a number can be a label: whole, and of a size that a label has.
bool is_whole_label(double value);

}  // namespace rhizodont
