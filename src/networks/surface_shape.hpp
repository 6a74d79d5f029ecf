// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

namespace rhizodont {

/// Sizes of a surface network, and what it looks at. The defaults are those of the shipped weights.
struct SurfaceShape {
  int width = 64;            ///< channels, 1..1024
  int blocks = 4;            ///< 1..64
  int eigenvectors = 48;     ///< of the surface's operators, that diffusion takes place in, 1..1024
  bool position = true;      ///< features: positions
  bool signature = true;     ///< heat kernel signatures
  bool surroundings = true;  ///< normals, distances to the border, curvature
};

/// Numbers that a vertex gives the network with these inputs, 1..surface_feature_count.
int feature_count(const SurfaceShape& shape);
/// Numbers that the network says of a vertex.
inline constexpr int surface_output_count = 1;

/// States both counts in the weights' metadata (features, outputs). They are no part of what a checkpoint must agree
/// in: those that do not state them stay valid.
void note_surface_counts(const SurfaceShape& shape, std::map<std::string, std::string>& metadata);

/// Sizes in a file's metadata.
void note_surface_shape(const SurfaceShape& shape, std::map<std::string, std::string>& metadata);
/// Throws InputError if they are missing or out of range, or the counts are stated and are others.
SurfaceShape read_surface_shape(const std::map<std::string, std::string>& metadata);
/// Throws UsageError if a size is out of range.
void check_surface_shape(const SurfaceShape& shape);

}  // namespace rhizodont
