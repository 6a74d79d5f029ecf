// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

enum class Jaw { lower, upper };

/// "lower" or "upper".
inline const char* jaw_name(Jaw jaw) { return jaw == Jaw::upper ? "upper" : "lower"; }

}  // namespace rhizodont
