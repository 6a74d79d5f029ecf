// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "rhizodont/mesh.hpp"

namespace rhizodont::shapes {

/// `count` points spread evenly over a sphere (a spiral), with outward normals.
inline OrientedPoints sphere(std::size_t count, double radius, const Point& centre = Point::Zero()) {
  OrientedPoints samples;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
    const double r = std::sqrt(1.0 - z * z), angle = golden * static_cast<double>(i);
    const Eigen::Vector3d n(r * std::cos(angle), r * std::sin(angle), z);
    samples.points.push_back(centre + radius * n);
    samples.normals.push_back(n);
  }
  return samples;
}

}  // namespace rhizodont::shapes
