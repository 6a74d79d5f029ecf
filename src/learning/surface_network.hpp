// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "learning/surface_sample.hpp"

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

/// A network that gives each vertex of a surface a probability (DiffusionNet: N. Sharp et al., 2022), with its weights.
/// Holds no state besides these: may be used from several threads at once.
class SurfaceNetwork {
 public:
  /// Reads weights written by the trainer. Throws InputError if the file is unreadable, damaged or of another network.
  static SurfaceNetwork load(const std::filesystem::path& path);

  SurfaceNetwork(SurfaceNetwork&&) noexcept;
  SurfaceNetwork& operator=(SurfaceNetwork&&) noexcept;
  ~SurfaceNetwork();

  /// Per vertex, 0..1. Throws InputError for a sample whose arrays do not fit, NoResultError if the network came to no
  /// number.
  std::vector<float> confidence(const SurfaceSample& sample) const;

  const SurfaceShape& shape() const;
  /// What the weight file says of itself.
  const std::map<std::string, std::string>& metadata() const;

 private:
  struct Impl;
  explicit SurfaceNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rhizodont
