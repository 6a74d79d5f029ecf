// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/crown_panorama.hpp"
#include "completion/pose_network.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/mesh.hpp"
#include "training/labelled_panoramas.hpp"

#include <cstdint>
#include <vector>

namespace rhizodont {

/// A generated crown seen from amid its base, and how it stands.
struct PoseSample {
  CrownPanorama panorama;
  PanoramaPose pose;
};

/// Crowns of tooth number `seed` of a type (0..15, left): three cut where those are that the completion network learns
/// from, one of a crowded arch, and a low one, each seen from a little beside where it should be, along its border's
/// axis and along its form's. Fewer where a cut leaves nothing. Depends on type and seed alone. Throws as
/// generate_tooth.
std::vector<PoseSample> make_pose_samples(const ToothFamilies& families, int type, std::uint64_t seed);

/// `make_pose_samples` of the first `per_type` teeth of every type, >= 1.
PosedPanoramas make_posed_panoramas(const ToothFamilies& families, int per_type);

/// Errors of a network on generated teeth that had no part in the training, one crown each.
struct PoseErrors {
  std::size_t crowns = 0;
  double lost = 0;  ///< share whose turn is off by over 30 degrees
  double turn = 0;  ///< degrees, mean of the others
  double lean = 0;  ///< degrees, mean angle between the form's axis and what is said of it
};

/// Of `per_type` teeth of each type. Throws as generate_tooth.
PoseErrors pose_errors(const ToothFamilies& families, const PoseNetwork& network, int per_type);

}  // namespace rhizodont
