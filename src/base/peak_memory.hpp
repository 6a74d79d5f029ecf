// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// The most memory that this process has held so far, MB.
double peak_memory_mb();

}  // namespace rhizodont
