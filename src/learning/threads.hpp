// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// Lets torch, BLAS and oneDNN use `count` threads when called from this thread, until the guard is gone. Other threads
/// are not affected.
class TensorThreads {
 public:
  explicit TensorThreads(int count);
  ~TensorThreads();
  TensorThreads(const TensorThreads&) = delete;
  TensorThreads& operator=(const TensorThreads&) = delete;

 private:
  int before_;
};

}  // namespace rhizodont
