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

/// Sizes in a file's metadata.
void note_surface_shape(const SurfaceShape& shape, std::map<std::string, std::string>& metadata);
/// Throws InputError if they are missing or out of range.
SurfaceShape read_surface_shape(const std::map<std::string, std::string>& metadata);
/// Throws UsageError if a size is out of range.
void check_surface_shape(const SurfaceShape& shape);

}  // namespace rhizodont
