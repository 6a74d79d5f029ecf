// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <torch/torch.h>

#include <memory>
#include <vector>

#include "learning/training_options.hpp"

namespace rhizodont {

/// Processes that train one network together, on one machine or several, connected by torch's distributed backend Gloo
/// over TCP. With one process nothing is connected and every call does nothing. All processes make the same calls in
/// the same order; sums are taken in an order that depends on the number of processes alone.
class ProcessGroup {
 public:
  /// Waits until all processes have come, at most five minutes. Throws UsageError for a rank or number of processes out
  /// of range or an address that is not HOST:PORT, InputError if the others cannot be reached.
  explicit ProcessGroup(const ProcessOptions& options);
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  int size() const { return size_; }
  int rank() const { return rank_; }
  bool is_first() const { return rank_ == 0; }

  /// Replaces the tensors (contiguous) by those of the first process.
  void share(std::vector<torch::Tensor> tensors) const;
  /// Replaces the tensors (float, contiguous) by their sums over all processes.
  void sum(std::vector<torch::Tensor> tensors) const;
  /// The first process's value, on all.
  std::int64_t share(std::int64_t value) const;

 private:
  struct Connection;
  int size_ = 1, rank_ = 0;
  std::unique_ptr<Connection> connection_;
};

}  // namespace rhizodont
