// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/surface_shares.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "poisson/neighbours.hpp"

namespace rhizodont {

std::vector<double> surface_shares(const OrientedPoints& samples, int neighbours) {
  assert(neighbours >= 3 && samples.points.size() >= static_cast<std::size_t>(neighbours) + 2);
  assert(std::all_of(samples.normals.begin(), samples.normals.end(),
                     [](const Eigen::Vector3d& n) { return std::abs(n.squaredNorm() - 1) < 1e-6; }));
  // On a thin sheet every second neighbour lies on the other side: where the nearest do not suffice, twice as many are
  // looked up.
  const auto few = static_cast<std::size_t>(neighbours) + 1;
  std::vector<double> shares(samples.points.size());
  visit_neighbours(samples.points, few, 2 * few, [&](std::size_t i, auto indices, auto distances) {
    // A disc with a radius midway between the k-th neighbour and the next holds the sample and k others, whether the
    // samples lie on a lattice or at random; the mean over the outer half of the neighbours takes out the lattice's
    // shells.
    int counted = 0, averaged = 0;
    double last = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < indices.size() && counted <= neighbours; ++k) {
      if (samples.normals[i].dot(samples.normals[static_cast<std::size_t>(indices[k])]) <= 0.0) continue;
      if (counted >= neighbours / 2) {
        const double radius = 0.5 * (last + distances[k]);
        sum += std::numbers::pi * radius * radius / (counted + 1);
        ++averaged;
      }
      last = distances[k];
      ++counted;
    }
    // So few of its own sheet nearby: an isolated sample with a disc of its own.
    shares[i] = averaged > 0 ? sum / averaged : std::numbers::pi * last * last / (counted + 1);
    return counted > neighbours;
  });
  return shares;
}

}  // namespace rhizodont
