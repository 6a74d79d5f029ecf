// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rhizodont {

// Point sets of a few thousand points as the networks have them: `xyz` holds x, y, z of point 0, then of point 1 and so
// on, finite values. At that size a wide brute-force scan is faster than a tree and its answer is exact. All functions
// are deterministic; ties go to the smaller index.

/// For each query the index of the closest key. Throws UsageError if there are queries but no keys.
std::vector<std::int32_t> closest_keys(std::span<const float> queries_xyz, std::span<const float> keys_xyz);

/// For each query the indices of its `k` closest keys, nearest first: queries x k. A query that is itself among the
/// keys finds itself. Throws UsageError if there are fewer than `k` keys.
std::vector<std::int32_t> nearest_keys(std::span<const float> queries_xyz, std::span<const float> keys_xyz, int k);

/// The first `count` indices in farthest-point order: the point farthest from the centroid, then each time the one
/// farthest from those chosen. Ties go to the lexicographically smallest point, so that which points are chosen, and in
/// which order, does not depend on the order in which they are given. Throws UsageError if count > points.
std::vector<std::int32_t> farthest_point_order(std::span<const float> xyz, int count);

}  // namespace rhizodont
