// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/threads.hpp"

#include <ATen/Parallel.h>
#include <omp.h>

namespace rhizodont {

TensorThreads::TensorThreads(int count) {
  at::get_num_threads();  // torch sets each thread's number at its first use: that must not come after ours
  before_ = omp_get_max_threads();
  omp_set_num_threads(count);  // unlike at::set_num_threads, this counts for the calling thread alone
}

TensorThreads::~TensorThreads() { omp_set_num_threads(before_); }

}  // namespace rhizodont
