// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <vector>

namespace rhizodont {

/// A smooth function of the direction around a tooth: a mean and four waves.
struct AroundTooth {
  double mean = 0;
  std::array<double, 4> height{}, phase{};

  AroundTooth() = default;
  AroundTooth(RandomStream& random, double mean_value, double deviation);
  double operator()(double angle) const;
};

/// Surface that goes on below a crown's border.
struct Flange {
  TriangleMesh mesh;                ///< the crown's vertices and triangles first, unchanged
  std::size_t crown_triangles = 0;  ///< number of these
  std::vector<double>
      outwards;  ///< per vertex: 0 on the crown, on the flange how far it is towards its outer edge, to 1
};

/// What a flange looks like.
enum class FlangeKind {
  band,   ///< gum all around, bulging outwards first
  webs,   ///< between the teeth, towards the neighbours, hardly anything elsewhere
  parts,  ///< some stretches of either
  lip,    ///< a narrow rim that turns inwards, as cap removal leaves it
};

/// Adds a flange to a crown with one border, in the tooth's frame (z up, neighbours at -x and +x).
Flange add_flange(const TriangleMesh& crown, FlangeKind kind, RandomStream& random);

}  // namespace rhizodont
