// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "poisson/block_kernels.hpp"
#include "poisson/spline_level.hpp"

namespace rhizodont {

// Access to fields of a level: pointers go to the level's first entry. What is not stored counts as zero.

/// The coefficients of a block and `halo` = degree around it.
template <class Scalar>
void gather_patch(const SplineLevel& level, const Scalar* field, std::size_t block, Scalar* patch);

/// The coefficients `low` .. `low` + `size` - 1 along each axis, x fastest.
template <class Scalar>
void gather_box(const SplineLevel& level, const Scalar* field, const std::array<int, 3>& low, int size, Scalar* box);

/// out[512] = transposed refinement of the finer field, for one block of the coarser level.
template <class Scalar>
void restrict_block(const SplineLevel& coarse, std::size_t block, const SplineLevel& fine, const Scalar* fine_field,
                    Scalar* out);

/// out[512] = refinement of the coarser field, for one block of the finer level.
template <class Scalar>
void prolong_block(const SplineLevel& fine, std::size_t block, const SplineLevel& coarse, const Scalar* coarse_field,
                   Scalar* out);

/// A sample that pulls the function towards a value.
struct ScreeningSample {
  Point position;  ///< mm
  double weight;   ///< >= 0
};

/// Samples by the blocks whose functions they touch: a sample near a block's side is listed with the next one too, so
/// that each block can be computed on its own.
template <class Scalar>
class BlockSamples {
 public:
  BlockSamples() = default;
  BlockSamples(const SplineLevel& level, const std::vector<ScreeningSample>& samples);

  struct Entry {
    std::array<std::array<Scalar, 3>, 3> values;  ///< of the functions along each axis, earliest first
    Scalar weight;
    std::int32_t first;  ///< position of the first function in the block's patch
  };
  std::span<const Entry> of(std::size_t block) const {
    return std::span(entries_).subspan(begin_[block], begin_[block + 1] - begin_[block]);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> begin_;
};

/// product[512] += sum over the block's samples of weight B_i(p) u(p), u given by its patch. `scratch`: a patch.
template <class Scalar>
void add_screening(const SplineLevel& level, std::span<const typename BlockSamples<Scalar>::Entry> samples,
                   const Scalar* patch, Scalar* scratch, Scalar* product);

/// One sample per cell of the level, at the weighted mean of those in it and with their total weight, sorted by cell.
std::vector<ScreeningSample> merge_samples(const SplineLevel& level, const std::vector<ScreeningSample>& samples);

}  // namespace rhizodont
