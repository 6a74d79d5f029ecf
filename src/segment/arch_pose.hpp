// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "segment/arch_model.hpp"

#include <Eigen/Core>

#include <map>
#include <optional>

namespace rhizodont {

/// Where a crown is and which way it faces, as its surface alone tells.
struct CrownPlace {
  Point middle = Point::Zero();  ///< area-weighted, mm
  Eigen::Vector3d area_vector =
      Eigen::Vector3d::Zero();  ///< mm^2: of an open crown along its growth axis, roughly; of a closed one nothing
  double area = 0;              ///< mm^2
};

CrownPlace place_of_crown(const TriangleMesh& open_crown);

/// How the mean arch lies on the crowns of one jaw: arch = scale * rotation * model + shift.
struct ArchPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< proper
  double scale = 1;                                        ///< within [0.8, 1.25]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// Lays the mean arch on the middles and area vectors of a jaw's crowns, crowns far off (shifted or badly cut ones)
/// weighing less. Keys: FDI numbers of permanent teeth
/// of one jaw. Nothing where the crowns leave the turn open: one alone, or closed ones in a straight row. Throws
/// UsageError for no teeth, for others, and for both jaws at once. Least squares: S. Umeyama, "Least-squares estimation
/// of transformation parameters between two point patterns", 1991.
std::optional<ArchPose> fit_arch(const ArchModel& model, const std::map<int, CrownPlace>& crowns);

/// How each of these teeth stands: as in the mean arch, turned about the occlusal direction as the line between its
/// neighbours is turned against the mean arch's. Unit, at right angles, in the crowns' frame.
std::map<int, ToothDirections> directions_in_arch(const ArchModel& model, const ArchPose& pose,
                                                  const std::map<int, CrownPlace>& crowns);

}  // namespace rhizodont
