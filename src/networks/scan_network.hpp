// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/scan_sample.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rhizodont {

/// What the network says of a scan.
struct ScanReading {
  std::vector<float> kinds;                  ///< scan_kind_count per point of the finest level: probabilities
  std::vector<float> offsets;                ///< 3 per point: way to the middle of its tooth, mm
  std::vector<float> borders;                ///< per point: probability that another tooth or gum is near
  float upper = 0;                           ///< probability that this is an upper jaw
  std::array<float, 3> front{}, occlusal{};  ///< directions in the cloud's frame, of any length
};

/// A network that finds the teeth of a scan, with its weights: edge convolutions (Wang et al., Dynamic Graph CNN, 2019)
/// on points that get sparser level by level and denser again (Qi et al., PointNet++, 2017), attention between the
/// sparsest. Holds no state besides its weights: may be used from several threads at once.
class ScanNetwork {
 public:
  /// Reads weights written by the trainer. Throws InputError if the file is unreadable, damaged or of another network.
  static ScanNetwork load(const std::filesystem::path& path);

  ScanNetwork(ScanNetwork&&) noexcept;
  ScanNetwork& operator=(ScanNetwork&&) noexcept;
  ~ScanNetwork();

  /// `scan`: by scan_pyramid with this network's shape. Throws NoResultError if the network came to no number.
  ScanReading read(const ScanPyramid& scan) const;

  const ScanShape& shape() const;
  /// What the weight file says of itself.
  const std::map<std::string, std::string>& metadata() const;

 private:
  struct Impl;
  explicit ScanNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rhizodont
