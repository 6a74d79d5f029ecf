// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <tbb/task_arena.h>

namespace rhizodont {

/// Runs `work` in an arena of at most `threads` threads (0: the caller's own), so that calls side by side keep each
/// their own limit.
template <class Work>
auto with_threads(int threads, const Work& work) {
  if (threads == 0 || threads >= tbb::this_task_arena::max_concurrency()) return work();
  tbb::task_arena arena(threads);
  return arena.execute(work);
}

}  // namespace rhizodont
