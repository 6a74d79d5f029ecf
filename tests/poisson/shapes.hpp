// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
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

/// Random points on a torus around z; `large`: radius of the ring's middle line, `small`: of its section.
inline OrientedPoints torus(std::size_t count, double large, double small, std::mt19937& random) {
  OrientedPoints samples;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  while (samples.points.size() < count) {
    const double u = 2.0 * std::numbers::pi * uniform(random), v = 2.0 * std::numbers::pi * uniform(random);
    if (uniform(random) > (large + small * std::cos(v)) / (large + small)) continue;  // to be even over the area
    const Eigen::Vector3d around(std::cos(u), std::sin(u), 0.0);
    const Eigen::Vector3d n = std::cos(v) * around + std::sin(v) * Eigen::Vector3d::UnitZ();
    samples.points.push_back(large * around + small * n);
    samples.normals.push_back(n);
  }
  return samples;
}

/// A segment with all that is nearer to it than the radius.
struct Capsule {
  Point a, b;
  double radius;

  Point on_axis(const Point& p) const {
    const Eigen::Vector3d along = b - a;
    return a + std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
  }
};

/// Random points on the union of capsules: those on one that lie in no other.
inline OrientedPoints capsules(std::size_t count, const std::vector<Capsule>& parts, std::mt19937& random) {
  OrientedPoints samples;
  Eigen::AlignedBox3d box;
  for (const Capsule& part : parts)
    for (const Point& end : {part.a, part.b}) {
      box.extend(end - Eigen::Vector3d::Constant(part.radius));
      box.extend(end + Eigen::Vector3d::Constant(part.radius));
    }
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  while (samples.points.size() < count) {
    // A thin shell around one surface, drawn to it, is even enough.
    const Point p =
        box.min() + Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).cwiseProduct(box.sizes());
    for (std::size_t c = 0; c < parts.size() && samples.points.size() < count; ++c) {
      const Point axis = parts[c].on_axis(p);
      const double distance = (p - axis).norm();
      if (std::abs(distance - parts[c].radius) > 0.1 * parts[c].radius) continue;
      const Eigen::Vector3d n = (p - axis) / distance;
      const Point on_surface = axis + parts[c].radius * n;
      const bool hidden = std::ranges::any_of(parts, [&](const Capsule& other) {
        return (on_surface - other.on_axis(on_surface)).norm() < other.radius - 1e-9;
      });
      if (hidden) continue;
      samples.points.push_back(on_surface);
      samples.normals.push_back(n);
    }
  }
  return samples;
}

/// A crown-like ball on two roots with a narrow gap between them.
inline std::vector<Capsule> two_rooted() {
  return {{Point(0.0, 0.0, 0.0), Point(0.0, 0.0, 1.0), 4.0},
          {Point(-2.2, 0.0, 0.0), Point(-2.6, 0.0, -12.0), 1.5},
          {Point(2.2, 0.0, 0.0), Point(2.6, 0.0, -12.0), 1.5}};
}

/// Random points on the faces of a box around the origin.
inline OrientedPoints box(std::size_t count, const Eigen::Vector3d& size, std::mt19937& random) {
  OrientedPoints samples;
  const Eigen::Vector3d areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  std::discrete_distribution<int> face{areas[0], areas[0], areas[1], areas[1], areas[2], areas[2]};
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (std::size_t i = 0; i < count; ++i) {
    const int f = face(random);
    Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    p[f / 2] = f % 2 == 0 ? -0.5 : 0.5;
    samples.points.push_back(p.cwiseProduct(size));
    samples.normals.push_back((f % 2 == 0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(f / 2));
  }
  return samples;
}

}  // namespace rhizodont::shapes
