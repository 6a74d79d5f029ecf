// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/crown_panorama.hpp"
#include "completion/panorama_features.hpp"
#include "networks/safetensors.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace rhizodont {

/// Number of permanent teeth; tooth t is type t / 2 on the left (even) or right (odd) side.
inline constexpr std::size_t tooth_count = 2 * static_cast<std::size_t>(tooth_type_count);
/// Tooth of an FDI number. Throws UsageError for other numbers than those of permanent teeth.
std::size_t tooth_of_fdi(int fdi);

/// What a panorama looks like: natural logarithms of probabilities that sum to 1 with `unlike`'s.
struct ToothProbabilities {
  std::array<double, tooth_count> log_tooth{};
  double log_unlike = 0;  ///< little of a crown, or no crown
};

/// Convolutional network that tells teeth apart by their panorama. Convolutions wrap around the axis, so that turning
/// the crown about it changes nothing but rounding and where strides fall. Holds its weights alone; may be used from
/// several threads.
class ToothClassifier {
 public:
  /// Takes the weights out of a file (models/likeness.md). Throws InputError if one is missing or of another size.
  explicit ToothClassifier(const TensorFile& file);

  /// Mean of what it says of the crown and of its mirror image. Deterministic.
  ToothProbabilities operator()(const CrownPanorama& panorama) const;

 private:
  Eigen::VectorXd scores(const CrownPanorama& panorama) const;

  PanoramaFeatures features_;
  std::array<PanoramaLayer, 2> dense_;
};

}  // namespace rhizodont
