// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// Triangles around each vertex, in compressed rows, ascending.
class VertexIncidence {
 public:
  VertexIncidence(std::size_t vertices, const std::vector<Triangle>& triangles)
      : first_(vertices + 1, 0), triangles_(3 * triangles.size()) {
    for (const Triangle& triangle : triangles)
      for (const std::int32_t v : triangle) ++first_[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 0; v < vertices; ++v) first_[v + 1] += first_[v];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const std::int32_t v : triangles[t]) triangles_[next[static_cast<std::size_t>(v)]++] = t;
  }

  std::span<const std::size_t> of(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return std::span(triangles_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::size_t valence(std::int32_t v) const { return of(v).size(); }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::size_t> triangles_;
};

}  // namespace rhizodont
