// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/crown_panorama.hpp"
#include "networks/safetensors.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace rhizodont {

/// A layer of a network that looks at panoramas.
struct PanoramaLayer {
  Eigen::MatrixXf weight;  ///< outputs x (inputs x kernel rows x kernel columns)
  Eigen::VectorXf bias;
  Eigen::Index inputs = 0, kernel_rows = 1, kernel_columns = 1;
};

/// Takes a layer out of a file: `dimensions` 4 for convolutions of maps, 3 for those around the axis, 2 for others.
/// Throws InputError if it is missing or damaged; `network` names it in the sentence.
PanoramaLayer panorama_layer(const TensorFile& file, const std::string& name, std::size_t dimensions,
                             const std::string& network);

/// A convolution over columns that wrap around, then what is above zero. @param around channels x columns
Eigen::MatrixXf convolved_around(const Eigen::MatrixXf& around, const PanoramaLayer& layer);

/// The panorama of the crown's mirror image.
CrownPanorama mirrored(const CrownPanorama& panorama);

/// What several networks see in a panorama, each with weights of its own: convolutions that wrap around the axis, so
/// that turning the crown about it turns the features, but for where strides fall.
class PanoramaFeatures {
 public:
  static constexpr Eigen::Index columns_per_place = 4;  ///< columns of the panorama from one place to the next

  /// Takes the weights out of a file. Throws InputError if one is missing or of another size.
  PanoramaFeatures(const TensorFile& file, const std::string& network);

  /// Channels x places around the axis. Place p is where the panorama's column 4 p is.
  Eigen::MatrixXf operator()(const CrownPanorama& panorama) const;

  /// Number of channels.
  Eigen::Index channels() const { return around_.back().weight.rows(); }

 private:
  std::vector<PanoramaLayer> maps_, around_;
};

}  // namespace rhizodont
