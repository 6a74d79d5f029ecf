// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/level_fields.hpp"

#include <algorithm>
#include <numeric>

#include "poisson/bspline.hpp"

namespace rhizodont {
namespace {

constexpr int side = SplineLevel::side;

int patch_width(const SplineLevel& level) { return side + 2 * level.degree; }

std::uint64_t cell_number(const SplineLevel& level, const std::array<int, 3>& cell) {
  return (static_cast<std::uint64_t>(cell[2]) * static_cast<std::uint64_t>(level.cells[1]) +
          static_cast<std::uint64_t>(cell[1])) *
             static_cast<std::uint64_t>(level.cells[0]) +
         static_cast<std::uint64_t>(cell[0]);
}

/// Copies the part of a stored block that lies in the box from `low` on, `size` wide, to its place in the box.
template <class Scalar>
void copy_overlap(const SplineLevel::BlockNumber& number, const Scalar* source, const std::array<int, 3>& low, int size,
                  Scalar* box) {
  std::array<int, 3> from{}, count{}, to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int corner = number[axis] * side;
    from[axis] = std::max(low[axis] - corner, 0);
    to[axis] = std::max(corner - low[axis], 0);
    count[axis] = std::min(side - from[axis], size - to[axis]);
  }
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x)
        box[((to[2] + z) * size + to[1] + y) * size + to[0] + x] =
            source[((from[2] + z) * side + from[1] + y) * side + from[0] + x];
}

int block_below(int function) { return function >= 0 ? function / side : -1; }

}  // namespace

template <class Scalar>
void gather_box(const SplineLevel& level, const Scalar* field, const std::array<int, 3>& low, int size, Scalar* box) {
  std::fill_n(box, size * size * size, Scalar(0));
  for (int z = block_below(low[2]); z <= block_below(low[2] + size - 1); ++z)
    for (int y = block_below(low[1]); y <= block_below(low[1] + size - 1); ++y)
      for (int x = block_below(low[0]); x <= block_below(low[0] + size - 1); ++x) {
        const std::int32_t b = level.find(x, y, z);
        if (b >= 0) copy_overlap({x, y, z}, field + static_cast<std::size_t>(b) * SplineLevel::block, low, size, box);
      }
}

template <class Scalar>
void gather_patch(const SplineLevel& level, const Scalar* field, std::size_t block, Scalar* patch) {
  std::array<const Scalar*, 27> near{};
  for (std::size_t n = 0; n < 27; ++n) {
    const std::int32_t b = level.around[block][n];
    if (b >= 0) near[n] = field + static_cast<std::size_t>(b) * SplineLevel::block;
  }
  join_blocks(level.degree, near, patch);
}

template <class Scalar>
void restrict_block(const SplineLevel& coarse, std::size_t block, const SplineLevel& fine, const Scalar* fine_field,
                    Scalar* out) {
  const auto& [x, y, z] = coarse.blocks[block];
  std::array<const Scalar*, 27> finer{};
  bool any = false;
  for (int n = 0; n < 27; ++n) {
    const std::int32_t b = fine.find(2 * x + n % 3, 2 * y + n / 3 % 3, 2 * z + n / 9);
    if (b < 0) continue;
    finer[static_cast<std::size_t>(n)] = fine_field + static_cast<std::size_t>(b) * SplineLevel::block;
    any = true;
  }
  if (any)
    block_restriction(spline_refinement<Scalar>(coarse.degree), finer, out);
  else
    std::fill_n(out, SplineLevel::block, Scalar(0));
}

template <class Scalar>
void prolong_block(const SplineLevel& fine, std::size_t block, const SplineLevel& coarse, const Scalar* coarse_field,
                   Scalar* out) {
  constexpr int half = side / 2;
  const auto& [x, y, z] = fine.blocks[block];
  std::array<Scalar, 125> box;
  gather_box(coarse, coarse_field, {half * x - 1, half * y - 1, half * z - 1}, half + 1, box.data());
  block_prolongation(spline_refinement<Scalar>(fine.degree), box.data(), out);
}

template <class Scalar>
BlockSamples<Scalar>::BlockSamples(const SplineLevel& level, const std::vector<ScreeningSample>& samples) {
  struct Touch {
    std::int32_t block, sample;
  };
  const int wide = patch_width(level);
  std::vector<Touch> touches;
  std::vector<SplinePosition> positions(samples.size());
  begin_.assign(level.blocks.size() + 1, 0);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    if (!(samples[s].weight > 0.0)) continue;
    positions[s] = locate(level, samples[s].position);
    const auto& cell = positions[s].cell;
    for (int z = block_below(cell[2] - level.degree); z <= cell[2] / side; ++z)
      for (int y = block_below(cell[1] - level.degree); y <= cell[1] / side; ++y)
        for (int x = block_below(cell[0] - level.degree); x <= cell[0] / side; ++x) {
          const std::int32_t b = level.find(x, y, z);
          if (b < 0) continue;
          touches.push_back({b, static_cast<std::int32_t>(s)});
          ++begin_[static_cast<std::size_t>(b) + 1];
        }
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  entries_.resize(touches.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const Touch& touch : touches) {
    const auto b = static_cast<std::size_t>(touch.block), s = static_cast<std::size_t>(touch.sample);
    // Position in the patch, whose corner lies `degree` functions before the block's.
    const auto at = [&](std::size_t axis) { return positions[s].cell[axis] - side * level.blocks[b][axis]; };
    Entry& entry = entries_[next[b]++];
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t k = 0; k < 3; ++k) entry.values[axis][k] = static_cast<Scalar>(positions[s].values[axis][k]);
    entry.weight = static_cast<Scalar>(samples[s].weight);
    entry.first = (at(2) * wide + at(1)) * wide + at(0);
  }
}

namespace {

/// `add_screening` with all loops of known length.
template <int degree, class Scalar>
void add_screening_of_degree(std::span<const typename BlockSamples<Scalar>::Entry> samples, const Scalar* patch,
                             Scalar* scratch, Scalar* product) {
  constexpr int wide = side + 2 * degree, count = degree + 1;
  std::fill_n(scratch, wide * wide * wide, Scalar(0));
  for (const auto& entry : samples) {
    const std::array<Scalar, 3>&vx = entry.values[0], &vy = entry.values[1], &vz = entry.values[2];
    const Scalar* from = patch + entry.first;
    Scalar value = 0;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t j = 0; j < count; ++j) {
        const Scalar* line = from + (k * wide + j) * wide;
        Scalar sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += vx[i] * line[i];
        value += vz[k] * vy[j] * sum;
      }
    value *= entry.weight;
    Scalar* to = scratch + entry.first;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t j = 0; j < count; ++j) {
        Scalar* line = to + (k * wide + j) * wide;
        const Scalar factor = value * vz[k] * vy[j];
        for (std::size_t i = 0; i < count; ++i) line[i] += factor * vx[i];
      }
  }
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y) {
      const Scalar* line = scratch + ((z + degree) * wide + y + degree) * wide + degree;
      for (int x = 0; x < side; ++x) product[(z * side + y) * side + x] += line[x];
    }
}

}  // namespace

template <class Scalar>
void add_screening(const SplineLevel& level, std::span<const typename BlockSamples<Scalar>::Entry> samples,
                   const Scalar* patch, Scalar* scratch, Scalar* product) {
  if (samples.empty()) return;
  if (level.degree == 2)
    add_screening_of_degree<2, Scalar>(samples, patch, scratch, product);
  else
    add_screening_of_degree<1, Scalar>(samples, patch, scratch, product);
}

std::vector<ScreeningSample> merge_samples(const SplineLevel& level, const std::vector<ScreeningSample>& samples) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    order[s] = {cell_number(level, cell_of(level, samples[s].position)), s};
  std::sort(order.begin(), order.end());
  std::vector<ScreeningSample> merged;
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    ScreeningSample sum{Point::Zero(), 0.0};
    for (; end < order.size() && order[end].first == order[begin].first; ++end) {
      const ScreeningSample& sample = samples[order[end].second];
      sum.position += sample.weight * sample.position;
      sum.weight += sample.weight;
    }
    if (sum.weight > 0.0) merged.push_back({sum.position / sum.weight, sum.weight});
    begin = end;
  }
  return merged;
}

template void gather_patch(const SplineLevel&, const float*, std::size_t, float*);
template void gather_patch(const SplineLevel&, const double*, std::size_t, double*);
template void gather_box(const SplineLevel&, const float*, const std::array<int, 3>&, int, float*);
template void gather_box(const SplineLevel&, const double*, const std::array<int, 3>&, int, double*);
template void restrict_block(const SplineLevel&, std::size_t, const SplineLevel&, const float*, float*);
template void restrict_block(const SplineLevel&, std::size_t, const SplineLevel&, const double*, double*);
template void prolong_block(const SplineLevel&, std::size_t, const SplineLevel&, const float*, float*);
template void prolong_block(const SplineLevel&, std::size_t, const SplineLevel&, const double*, double*);
template class BlockSamples<float>;
template class BlockSamples<double>;
template void add_screening(const SplineLevel&, std::span<const BlockSamples<float>::Entry>, const float*, float*,
                            float*);
template void add_screening(const SplineLevel&, std::span<const BlockSamples<double>::Entry>, const double*, double*,
                            double*);

}  // namespace rhizodont
