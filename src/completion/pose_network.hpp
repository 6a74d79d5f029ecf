// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/crown_panorama.hpp"
#include "completion/panorama_features.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

namespace rhizodont {

/// How a crown stands about the axis from which it is looked at.
struct PanoramaPose {
  double azimuth = 0;  ///< radians: direction towards the cheek (canonical +y)
  Eigen::Vector2d form_axis =
      Eigen::Vector2d::Zero();  ///< the form's own axis (about unit) along azimuths 0 and 90 degrees
};

/// How a crown stands in the world.
struct CrownPose {
  Eigen::Vector3d buccal;     ///< unit, across its border's axis: canonical +y
  Eigen::Vector3d form_axis;  ///< unit, from root to crown: that of the type's mean crown where it lies on this crown
};

/// Convolutional network that sees in a panorama how the crown of a known tooth is turned and how its form leans. What
/// it says turns with the crown: each place around the axis says how likely the cheek is there, and how much the form
/// leans towards it and along it. Holds its weights alone; may be used from several threads.
class PoseNetwork {
 public:
  /// Takes the weights out of a file (models/pose.md). Throws InputError if one is missing or of another size.
  explicit PoseNetwork(const TensorFile& file);

  /// At which of a panorama's columns places are looked at.
  enum class Columns { every_fourth, all };

  /// Of a left tooth's panorama. The same for any number of threads. @param type 0..15
  /// Throws InputError where weights are so large that the result is no number.
  PanoramaPose operator()(const CrownPanorama& panorama, int type, Columns looked_at = Columns::all) const;

  /// Looks at an open crown (mm) from amid its base along its border's growth axis, and once more along the form's axis
  /// that it found. The cheek is across the border's axis. Throws UsageError for other numbers
  /// than those of permanent teeth, InputError for crowns without area or border.
  CrownPose pose_of(const TriangleMesh& open_crown, int fdi) const;

 private:
  CrownPose seen_along(const TriangleMesh& open_crown, const Eigen::Vector3d& axis, int fdi, Columns looked_at) const;

  PanoramaFeatures features_;
  PanoramaLayer around_, said_;
};

}  // namespace rhizodont
