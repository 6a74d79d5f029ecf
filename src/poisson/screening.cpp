// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Screening by samples (Kazhdan and Hoppe, Screened Poisson surface reconstruction, 2013). Slabs of cells are handled
// in two rounds such that no two of one round touch the same function: sums come out the same for any number of
// threads.
#include "poisson/screening.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace rhizodont {
namespace {

constexpr int slab_cells = 4;  // more than the degree, so that slabs two apart have no function in common

std::size_t cell_number(const SplineGrid& grid, const Point& p) {
  const SplinePosition at = locate(grid, p);
  return (static_cast<std::size_t>(at.cell[2]) * static_cast<std::size_t>(grid.cells[1]) +
          static_cast<std::size_t>(at.cell[1])) *
             static_cast<std::size_t>(grid.cells[0]) +
         static_cast<std::size_t>(at.cell[0]);
}

/// Order of the samples by cell, equal cells by index, with the cells' numbers.
std::vector<std::pair<std::size_t, std::size_t>> sorted_by_cell(const SplineGrid& grid,
                                                                const std::vector<ScreeningSample>& samples) {
  std::vector<std::pair<std::size_t, std::size_t>> order(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) order[s] = {cell_number(grid, samples[s].position), s};
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<ScreeningSample> merge_samples(const SplineGrid& grid, const std::vector<ScreeningSample>& samples) {
  const auto order = sorted_by_cell(grid, samples);
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

template <class Scalar>
ScreeningOperator<Scalar>::ScreeningOperator(const SplineGrid& grid, const std::vector<ScreeningSample>& samples)
    : grid_(grid) {
  const auto order = sorted_by_cell(grid, samples);
  const auto slabs = static_cast<std::size_t>(grid.cells[2] / slab_cells + 1);
  slab_first_.assign(slabs + 1, 0);
  for (const auto& [cell, s] : order) {
    if (samples[s].weight <= 0.0) continue;
    const SplinePosition at = locate(grid, samples[s].position);
    Entry entry{};
    entry.weight = static_cast<Scalar>(samples[s].weight);
    entry.first = grid.index(at.cell[0] - grid.degree, at.cell[1] - grid.degree, at.cell[2] - grid.degree);
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k <= grid.degree; ++k) {
        const int function = at.cell[static_cast<std::size_t>(axis)] - grid.degree + k;
        const bool inside = function >= 0 && function < grid.functions(axis);
        entry.values[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)] =
            inside ? static_cast<Scalar>(at.values[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)])
                   : Scalar(0);
      }
    }
    entries_.push_back(entry);
    ++slab_first_[static_cast<std::size_t>(at.cell[2] / slab_cells) + 1];
  }
  std::partial_sum(slab_first_.begin(), slab_first_.end(), slab_first_.begin());
}

template <class Scalar>
template <class Visit>
void ScreeningOperator<Scalar>::for_each_slab(const Visit& visit) const {
  const std::size_t slabs = slab_first_.size() - 1;
  for (std::size_t round = 0; round < 2; ++round) {
    tbb::parallel_for(std::size_t{0}, (slabs + 1 - round) / 2, [&](std::size_t i) {
      const std::size_t slab = 2 * i + round;
      for (std::size_t e = slab_first_[slab]; e < slab_first_[slab + 1]; ++e) visit(entries_[e]);
    });
  }
}

template <class Scalar>
void ScreeningOperator<Scalar>::add(const std::vector<Scalar>& u, std::vector<Scalar>& out) const {
  const std::size_t row = grid_.row(), plane = grid_.plane();
  const auto count = static_cast<std::size_t>(grid_.degree + 1);
  for_each_slab([&](const Entry& entry) {
    const auto& [vx, vy, vz] = entry.values;
    Scalar value = 0;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t j = 0; j < count; ++j) {
        const Scalar* line = u.data() + entry.first + k * plane + j * row;
        Scalar sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += vx[i] * line[i];
        value += vz[k] * vy[j] * sum;
      }
    value *= entry.weight;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t j = 0; j < count; ++j) {
        Scalar* line = out.data() + entry.first + k * plane + j * row;
        const Scalar factor = value * vz[k] * vy[j];
        for (std::size_t i = 0; i < count; ++i) line[i] += factor * vx[i];
      }
  });
}

template <class Scalar>
void ScreeningOperator<Scalar>::add_load(Scalar value, std::vector<Scalar>& out) const {
  const std::size_t row = grid_.row(), plane = grid_.plane();
  const auto count = static_cast<std::size_t>(grid_.degree + 1);
  for_each_slab([&](const Entry& entry) {
    const auto& [vx, vy, vz] = entry.values;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t j = 0; j < count; ++j) {
        Scalar* line = out.data() + entry.first + k * plane + j * row;
        const Scalar factor = value * entry.weight * vz[k] * vy[j];
        for (std::size_t i = 0; i < count; ++i) line[i] += factor * vx[i];
      }
  });
}

template class ScreeningOperator<float>;
template class ScreeningOperator<double>;

}  // namespace rhizodont
