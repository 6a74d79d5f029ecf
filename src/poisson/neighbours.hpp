// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// The nearest points of each point of a cloud, itself left out.
struct Neighbours {
  std::size_t count = 0;          ///< per point
  std::vector<int> indices;       ///< of point i: indices[i * count ..], nearest first, equally near ones by index
  std::vector<double> distances;  ///< mm, likewise

  std::span<const int> of(std::size_t i) const { return std::span(indices).subspan(i * count, count); }
  std::span<const double> distances_of(std::size_t i) const { return std::span(distances).subspan(i * count, count); }
};

/// `count` neighbours of each point, or all others where there are fewer. Precondition: finite points, at least two.
Neighbours nearest_neighbours(std::span<const Point> points, std::size_t count);

/// Calls visit(i, neighbours of point i, their distances) for each point, from several threads: first with the `few`
/// nearest, and again with the `many` nearest if it returned false. Orders and precondition as above.
void visit_neighbours(std::span<const Point> points, std::size_t few, std::size_t many,
                      const std::function<bool(std::size_t, std::span<const int>, std::span<const double>)>& visit);

}  // namespace rhizodont
