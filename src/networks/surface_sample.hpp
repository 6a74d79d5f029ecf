// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace rhizodont {

/// What a surface network looks at: functions on the vertices of a mesh, and the operators by which they spread.
struct SurfaceSample {
  int vertices = 0;                      ///< n
  int eigenvectors = 0;                  ///< k
  std::vector<float> features;           ///< n x surface_feature_count, see SurfaceFeature
  std::vector<float> mass;               ///< n, area of each vertex, > 0
  std::vector<float> eigenvalues;        ///< k, >= 0
  std::vector<float> basis;              ///< n x k, orthonormal under the mass
  std::vector<std::int32_t> first;       ///< n + 1: the gradient's entries of vertex v are first[v] .. first[v + 1]
  std::vector<std::int32_t> neighbours;  ///< per entry: the vertex whose value counts
  std::vector<float> gradient_x;         ///< per entry: its factor along the first axis of v's tangent plane
  std::vector<float> gradient_y;         ///< and along the second one
  std::vector<std::uint8_t> labels;      ///< n, 1 or 0; for training only, else empty
};

/// Where the features of a vertex begin. Positions and normals are vectors: training turns them.
struct SurfaceFeature {
  static constexpr int position = 0;    ///< 3
  static constexpr int normal = 3;      ///< 3
  static constexpr int border = 6;      ///< 2, of the distance to the border
  static constexpr int curvature = 8;   ///< 2
  static constexpr int signature = 10;  ///< 16, heat kernel signatures
};
inline constexpr int surface_feature_count = 26;

/// The sample number `index`: the same number always gives the same one. Called from several threads at once.
using SurfaceProvider = std::function<SurfaceSample(std::uint64_t index)>;

/// Throws InputError if arrays have lengths that do not fit, or values that are not finite or out of range.
/// `labelled`: labels must be there.
void check_surface_sample(const SurfaceSample& sample, bool labelled);

}  // namespace rhizodont
