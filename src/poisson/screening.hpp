// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "poisson/spline_grid.hpp"

namespace rhizodont {

/// A sample that pulls the function towards a value.
struct ScreeningSample {
  Point position;  ///< mm
  double weight;   ///< >= 0
};

/// The sum over samples of weight * B_i(p) B_j(p), applied without a matrix. Functions that stick out of the box take
/// no part. Results do not depend on the number of threads.
template <class Scalar>
class ScreeningOperator {
 public:
  ScreeningOperator(const SplineGrid& grid, const std::vector<ScreeningSample>& samples);

  /// out += S u.
  void add(const std::vector<Scalar>& u, std::vector<Scalar>& out) const;
  /// out += sum over samples of weight * value * B_i(p).
  void add_load(Scalar value, std::vector<Scalar>& out) const;
  bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    std::size_t first;                            ///< position in a field of the first function
    std::array<std::array<Scalar, 3>, 3> values;  ///< per axis, 0 for functions that stick out
    Scalar weight;
  };
  template <class Visit>
  void for_each_slab(const Visit& visit) const;

  SplineGrid grid_;
  std::vector<Entry> entries_;           // sorted by cell
  std::vector<std::size_t> slab_first_;  // entries of slab s: slab_first_[s] .. slab_first_[s + 1]
};

/// One sample per cell of `grid`, at the weighted mean of those in it and with their total weight, sorted by cell.
std::vector<ScreeningSample> merge_samples(const SplineGrid& grid, const std::vector<ScreeningSample>& samples);

}  // namespace rhizodont
