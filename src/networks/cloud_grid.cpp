// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/cloud_grid.hpp"

#include "rhizodont/error.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace rhizodont {

CloudGrid::CloudGrid(std::span<const float> xyz, float cell) : xyz_(xyz), cell_(cell) {
  const std::size_t n = xyz.size() / 3;
  std::array<float, 3> high{};
  for (std::size_t a = 0; a < 3; ++a) {
    low_[a] = high[a] = n > 0 ? xyz[a] : 0;
    for (std::size_t i = 0; i < n; ++i) {
      low_[a] = std::min(low_[a], xyz[3 * i + a]);
      high[a] = std::max(high[a], xyz[3 * i + a]);
    }
  }
  constexpr double most_cells = 4e6;
  for (;;) {
    double cells = 1;
    for (std::size_t a = 0; a < 3; ++a) cells *= std::floor(static_cast<double>((high[a] - low_[a]) / cell_)) + 1;
    if (cells <= most_cells) break;
    cell_ *= 1.5F;
  }
  for (std::size_t a = 0; a < 3; ++a) size_[a] = static_cast<int>((high[a] - low_[a]) / cell_) + 1;
  first_.assign(number_of(size_[0] - 1, size_[1] - 1, size_[2] - 1) + 2, 0);
  std::vector<std::size_t> cell_of_point(n);
  for (std::size_t i = 0; i < n; ++i) {
    cell_of_point[i] = number_of(cell_of(xyz[3 * i], 0), cell_of(xyz[3 * i + 1], 1), cell_of(xyz[3 * i + 2], 2));
    ++first_[cell_of_point[i] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  order_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    order_[static_cast<std::size_t>(next[cell_of_point[i]]++)] = static_cast<std::int32_t>(i);
}

int CloudGrid::cell_of(float value, std::size_t axis) const {
  const float at = (value - low_[axis]) / cell_;
  return std::clamp(static_cast<int>(std::clamp(at, -1.0F, 1e7F)), 0, size_[axis] - 1);
}

void CloudGrid::nearest_of(const float* query, int k, std::int32_t* result) const {
  const std::size_t wanted = static_cast<std::size_t>(k);
  std::array<std::pair<float, std::int32_t>, 64> found;
  std::size_t count = 0;
  const auto consider = [&](std::int32_t i) {
    const float* p = xyz_.data() + 3 * static_cast<std::size_t>(i);
    const float x = p[0] - query[0], y = p[1] - query[1], z = p[2] - query[2];
    const std::pair<float, std::int32_t> entry{x * x + y * y + z * z, i};
    if (count == wanted && !(entry < found[count - 1])) return;
    std::size_t at = count < wanted ? count++ : count - 1;
    for (; at > 0 && entry < found[at - 1]; --at) found[at] = found[at - 1];
    found[at] = entry;
  };
  std::array<int, 3> home{}, far{};
  int farthest = 0;
  float outside = 0;  // a query may lie outside of the grid: cells around it begin farther away
  for (std::size_t a = 0; a < 3; ++a) {
    home[a] = cell_of(query[a], a);
    far[a] = std::max(home[a], size_[a] - 1 - home[a]);
    farthest = std::max(farthest, far[a]);
    const float begin = low_[a] + cell_ * static_cast<float>(home[a]);
    outside = std::max({outside, begin - query[a], query[a] - begin - cell_});
  }
  for (int ring = 0; ring <= farthest; ++ring) {
    for (int z = std::max(home[2] - ring, 0); z <= std::min(home[2] + ring, size_[2] - 1); ++z)
      for (int y = std::max(home[1] - ring, 0); y <= std::min(home[1] + ring, size_[1] - 1); ++y) {
        const bool shell = std::abs(z - home[2]) == ring || std::abs(y - home[1]) == ring;
        const int step = shell || ring == 0 ? 1 : 2 * ring;
        for (int x = home[0] - ring; x <= home[0] + ring; x += step) {
          if (x < 0 || x >= size_[0]) continue;
          const std::size_t c = number_of(x, y, z);
          for (std::int32_t i = first_[c]; i < first_[c + 1]; ++i) consider(order_[static_cast<std::size_t>(i)]);
        }
      }
    const float sure = std::max(static_cast<float>(ring) * cell_ - outside, 0.0F);
    if (count == wanted && found[count - 1].first <= sure * sure) break;
  }
  for (std::size_t i = 0; i < wanted; ++i) result[i] = i < count ? found[i].second : found[0].second;
}

std::vector<std::int32_t> CloudGrid::nearest(std::span<const float> queries_xyz, int k) const {
  const std::size_t queries = queries_xyz.size() / 3;
  if (queries > 0 && order_.empty()) throw UsageError("There is no point to look for.");
  if (k < 1 || k > 64) throw UsageError("From 1 to 64 neighbours can be looked for.");
  std::vector<std::int32_t> result(queries * static_cast<std::size_t>(k));
  tbb::parallel_for(std::size_t{0}, (queries + 255) / 256, [&](std::size_t block) {
    for (std::size_t q = 256 * block; q < std::min(queries, 256 * (block + 1)); ++q)
      nearest_of(queries_xyz.data() + 3 * q, k, result.data() + q * static_cast<std::size_t>(k));
  });
  return result;
}

std::vector<std::int32_t> thinned(std::span<const float> xyz, float spacing) {
  struct Place {
    std::array<std::int32_t, 3> cell;
    std::int32_t point;
  };
  const std::size_t n = xyz.size() / 3;
  std::vector<Place> places(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      places[i].cell[2 - a] = static_cast<std::int32_t>(std::floor(xyz[3 * i + a] / spacing));
    places[i].point = static_cast<std::int32_t>(i);
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return std::tie(a.cell, a.point) < std::tie(b.cell, b.point); });
  std::vector<std::int32_t> chosen;
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    std::array<float, 3> mean{};
    for (end = begin; end < n && places[end].cell == places[begin].cell; ++end)
      for (std::size_t a = 0; a < 3; ++a) mean[a] += xyz[3 * static_cast<std::size_t>(places[end].point) + a];
    // Two points are equally far from their mean: rounding must not choose between them.
    const float alike = 1e-3F * spacing * spacing;
    const auto distance = [&](const Place& place) {
      float sum = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const float d = xyz[3 * static_cast<std::size_t>(place.point) + a] - mean[a] / static_cast<float>(end - begin);
        sum += d * d;
      }
      return sum;
    };
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = begin; i < end; ++i) least = std::min(least, distance(places[i]));
    std::size_t first = begin;
    while (first + 1 < end && !(distance(places[first]) <= least + alike)) ++first;
    chosen.push_back(places[first].point);
  }
  return chosen;
}

}  // namespace rhizodont
