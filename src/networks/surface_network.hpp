// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "networks/surface_sample.hpp"
#include "networks/surface_shape.hpp"

namespace rhizodont {

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
