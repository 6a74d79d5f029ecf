// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/neighbours.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

// Eight floats fill one AVX register; compilers split wider vectors badly for processors without AVX-512. This file is
// compiled without fused multiply-add, so that all processors find the same neighbours.
constexpr std::size_t lanes = 8;
using Floats = float __attribute__((vector_size(lanes * sizeof(float))));
using Integers = std::int32_t __attribute__((vector_size(lanes * sizeof(std::int32_t))));
// The same floats where they lie in a plain array.
using FloatsInMemory = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));

const FloatsInMemory& at(const std::vector<float>& values, std::size_t block) {
  return *reinterpret_cast<const FloatsInMemory*>(values.data() + block * lanes);
}

const FloatsInMemory& at(const float* values, std::size_t block) {
  return *reinterpret_cast<const FloatsInMemory*>(values + block * lanes);
}

FloatsInMemory& at(float* values, std::size_t block) {
  return *reinterpret_cast<FloatsInMemory*>(values + block * lanes);
}

/// Coordinates apart and padded with far points to whole registers.
struct Columns {
  std::vector<float> x, y, z;
  std::size_t size = 0;
  std::size_t blocks = 0;

  explicit Columns(std::span<const float> xyz) : size(xyz.size() / 3), blocks((size + lanes - 1) / lanes) {
    constexpr float far = 1e18F;
    x.assign(blocks * lanes, far);
    y.assign(blocks * lanes, far);
    z.assign(blocks * lanes, far);
    for (std::size_t i = 0; i < size; ++i) {
      x[i] = xyz[3 * i];
      y[i] = xyz[3 * i + 1];
      z[i] = xyz[3 * i + 2];
    }
  }
};

constexpr std::size_t queries_at_once = 4;  // keeps the keys' registers busy while distances and minima stay in others

/// Closest keys of `queries_at_once` queries, each lane for itself.
[[gnu::target_clones("avx2", "default")]] void scan_keys(const Columns& keys, const float* queries, Floats* best,
                                                         Integers* best_block) {
  Floats qx[queries_at_once], qy[queries_at_once], qz[queries_at_once], minimum[queries_at_once];
  Integers where[queries_at_once];
  for (std::size_t q = 0; q < queries_at_once; ++q) {
    qx[q] = Floats{} + queries[3 * q];
    qy[q] = Floats{} + queries[3 * q + 1];
    qz[q] = Floats{} + queries[3 * q + 2];
    minimum[q] = Floats{} + std::numeric_limits<float>::max();
    where[q] = Integers{};
  }
  Integers block_index{};
  for (std::size_t block = 0; block < keys.blocks; ++block) {
    const Floats kx = at(keys.x, block), ky = at(keys.y, block), kz = at(keys.z, block);
    for (std::size_t q = 0; q < queries_at_once; ++q) {
      const Floats dx = kx - qx[q], dy = ky - qy[q], dz = kz - qz[q];
      const Floats distance = dx * dx + dy * dy + dz * dz;
      const Integers closer = distance < minimum[q];
      minimum[q] = closer ? distance : minimum[q];
      where[q] = closer ? block_index : where[q];
    }
    block_index += 1;
  }
  for (std::size_t q = 0; q < queries_at_once; ++q) {
    best[q] = minimum[q];
    best_block[q] = where[q];
  }
}

/// Squared distances of one point to all keys.
[[gnu::target_clones("avx2", "default")]] void measure(const Columns& keys, const float* point, float* distances) {
  const Floats px = Floats{} + point[0], py = Floats{} + point[1], pz = Floats{} + point[2];
  for (std::size_t block = 0; block < keys.blocks; ++block) {
    const Floats dx = at(keys.x, block) - px, dy = at(keys.y, block) - py, dz = at(keys.z, block) - pz;
    at(distances, block) = dx * dx + dy * dy + dz * dz;
  }
}

/// The first block from `block` on that holds a distance below `limit`; `blocks` if there is none.
[[gnu::target_clones("avx2", "default")]] std::size_t block_below(const float* distances, std::size_t block,
                                                                  std::size_t blocks, float limit) {
  using Halves = std::int64_t __attribute__((vector_size(lanes * sizeof(std::int32_t))));
  for (; block < blocks; ++block) {
    const Integers below = at(distances, block) < limit;
    const auto halves = reinterpret_cast<Halves>(below);
    if ((halves[0] | halves[1] | halves[2] | halves[3]) != 0) break;
  }
  return block;
}

/// Lowers each key's distance to the chosen set by its distance to one more point; per lane, returns the largest.
[[gnu::target_clones("avx2", "default")]] void lower_distances(const Columns& keys, const float* point,
                                                               float* distances, Floats* largest,
                                                               Integers* largest_block) {
  const Floats px = Floats{} + point[0], py = Floats{} + point[1], pz = Floats{} + point[2];
  Floats maximum = Floats{} - 2.0F;
  Integers where{}, block_index{};
  for (std::size_t block = 0; block < keys.blocks; ++block) {
    const Floats dx = at(keys.x, block) - px, dy = at(keys.y, block) - py, dz = at(keys.z, block) - pz;
    const Floats fresh = dx * dx + dy * dy + dz * dz;
    const Floats old = at(distances, block);
    const Floats lowered = fresh < old ? fresh : old;
    at(distances, block) = lowered;
    const Integers farther = lowered > maximum;
    maximum = farther ? lowered : maximum;
    where = farther ? block_index : where;
    block_index += 1;
  }
  *largest = maximum;
  *largest_block = where;
}

std::int32_t lane_index(const Integers& blocks, std::size_t lane) {
  return blocks[lane] * static_cast<std::int32_t>(lanes) + static_cast<std::int32_t>(lane);
}

}  // namespace

std::vector<std::int32_t> closest_keys(std::span<const float> queries_xyz, std::span<const float> keys_xyz) {
  const std::size_t count = queries_xyz.size() / 3;
  if (count > 0 && keys_xyz.empty()) throw UsageError("There are no points to search among.");
  const Columns keys(keys_xyz);
  std::vector<std::int32_t> closest(count);
  Floats best[queries_at_once];
  Integers block[queries_at_once];
  float queries[3 * queries_at_once] = {};
  for (std::size_t first = 0; first < count; first += queries_at_once) {
    const std::size_t used = std::min(queries_at_once, count - first);
    std::copy_n(queries_xyz.begin() + static_cast<std::ptrdiff_t>(3 * first), 3 * used, queries);
    scan_keys(keys, queries, best, block);
    for (std::size_t q = 0; q < used; ++q) {
      std::int32_t index = lane_index(block[q], 0);
      float distance = best[q][0];
      for (std::size_t lane = 1; lane < lanes; ++lane) {
        const std::int32_t other = lane_index(block[q], lane);
        if (best[q][lane] < distance || (best[q][lane] == distance && other < index)) {
          index = other;
          distance = best[q][lane];
        }
      }
      closest[first + q] = index;
    }
  }
  return closest;
}

std::vector<std::int32_t> nearest_keys(std::span<const float> queries_xyz, std::span<const float> keys_xyz, int k) {
  const std::size_t count = queries_xyz.size() / 3;
  const auto wanted = static_cast<std::size_t>(k);
  const Columns keys(keys_xyz);
  if (k < 1 || keys.size < wanted) throw UsageError("There are fewer points than neighbours asked for.");
  std::vector<std::int32_t> result(count * wanted);
  std::vector<float> distances(keys.blocks * lanes);
  std::vector<float> nearest(wanted);
  for (std::size_t q = 0; q < count; ++q) {
    measure(keys, queries_xyz.data() + 3 * q, distances.data());
    std::int32_t* indices = result.data() + q * wanted;
    std::size_t held = 0;
    const auto offer = [&](std::size_t key) {
      const float distance = distances[key];
      if (held == wanted && !(distance < nearest[wanted - 1])) return;
      std::size_t place = held < wanted ? held++ : wanted - 1;
      for (; place > 0 && distance < nearest[place - 1]; --place) {
        nearest[place] = nearest[place - 1];
        indices[place] = indices[place - 1];
      }
      nearest[place] = distance;
      indices[place] = static_cast<std::int32_t>(key);
    };
    std::size_t block = std::min(keys.blocks, (wanted + lanes - 1) / lanes);
    for (std::size_t key = 0; key < std::min(block * lanes, keys.size); ++key) offer(key);
    // Most blocks hold nothing that is nearer than what was found before.
    while ((block = block_below(distances.data(), block, keys.blocks, nearest[wanted - 1])) < keys.blocks) {
      for (std::size_t key = block * lanes; key < std::min((block + 1) * lanes, keys.size); ++key) offer(key);
      ++block;
    }
  }
  return result;
}

std::vector<std::int32_t> farthest_point_order(std::span<const float> xyz, int count) {
  const std::size_t size = xyz.size() / 3;
  if (count < 0 || static_cast<std::size_t>(count) > size)
    throw UsageError("More points were asked for than there are.");
  if (count == 0) return {};
  // In lexicographic order the smallest index is the smallest point, and sums do not depend on the given order.
  std::vector<std::int32_t> sorted(size);
  std::iota(sorted.begin(), sorted.end(), 0);
  const auto before = [&](std::int32_t a, std::int32_t b) {
    const float* p = xyz.data() + 3 * static_cast<std::size_t>(a);
    const float* q = xyz.data() + 3 * static_cast<std::size_t>(b);
    return std::lexicographical_compare(p, p + 3, q, q + 3);
  };
  std::sort(sorted.begin(), sorted.end(), before);
  std::vector<float> points(3 * size);
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[3 * i + axis] = xyz[3 * static_cast<std::size_t>(sorted[i]) + axis];
      sum[axis] += static_cast<double>(points[3 * i + axis]);
    }
  }
  const auto total = static_cast<double>(size);
  std::array<float, 3> centroid{static_cast<float>(sum[0] / total), static_cast<float>(sum[1] / total),
                                static_cast<float>(sum[2] / total)};
  const Columns keys(points);
  std::vector<float> distances(keys.blocks * lanes);
  measure(keys, centroid.data(), distances.data());
  const auto given = static_cast<std::ptrdiff_t>(size);
  auto next =
      static_cast<std::size_t>(std::max_element(distances.begin(), distances.begin() + given) - distances.begin());
  std::fill_n(distances.begin(), given, std::numeric_limits<float>::max());
  std::fill(distances.begin() + given, distances.end(), -1.0F);  // padding is never the farthest
  std::vector<std::int32_t> order{sorted[next]};
  Floats largest;
  Integers block;
  while (order.size() < static_cast<std::size_t>(count)) {
    distances[next] = -1.0F;  // a chosen point is not chosen again, even where all others coincide with chosen ones
    lower_distances(keys, points.data() + 3 * next, distances.data(), &largest, &block);
    next = static_cast<std::size_t>(lane_index(block, 0));
    for (std::size_t lane = 1; lane < lanes; ++lane) {
      const auto other = static_cast<std::size_t>(lane_index(block, lane));
      if (largest[lane] > distances[next] || (largest[lane] == distances[next] && other < next)) next = other;
    }
    order.push_back(sorted[next]);
  }
  return order;
}

}  // namespace rhizodont
