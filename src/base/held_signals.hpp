// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// While one of these lives, signals that would end the program are noted instead; when the last one is gone, the first
/// that was noted is raised again and does what it would have done. SIGPIPE and SIGXFSZ are ignored meanwhile: the
/// write that caused them fails and says why. Signals that the program ignores or handles itself are left alone.
class HeldSignals {
 public:
  HeldSignals();
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  ~HeldSignals();

  /// Whether one has come.
  static bool noted();
};

}  // namespace rhizodont
