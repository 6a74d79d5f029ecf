// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "completion/pose_network.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/tooth_directions.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "teeth/prepared_crown.hpp"

#include <array>
#include <optional>

namespace rhizodont {

/// How a mean crown lies on a crown.
struct RigidFit {
  CanonicalFrame frame;    ///< canonical pose given by the fit; centre and axis are those of the registered mean crown
  double residual_mm = 0;  ///< trimmed mean of the two-way distances, normals included, millimetres
  double scale_ratio = 1;  ///< size of this crown over that of the mean crown
};

/// Options of the registrations below.
struct RegistrationOptions {
  int start_angles = 36;          ///< starting rotations about the axis, >= 4
  int refined_starts = 4;         ///< how many of the best starts are refined, 1..start_angles
  int iterations = 20;            ///< refinements per start at most, >= 1; fewer where nothing moves any more
  double trim = 0.95;             ///< share of the closest pairs that count, 0.3..1
  double normal_weight_mm = 2.5;  ///< millimetres that a difference of 1 between unit normals counts for, >= 0
};

/// The canonical frame of an open crown and how well its type's mean crown agrees with it.
struct CrownFrame {
  static constexpr double longest_form_axis = 0.5;  ///< sine of 30 degrees

  CanonicalFrame frame;    ///< z = growth_axis, centre = area_centroid; rotation about z as laid or seen
  double residual_mm = 0;  ///< as in RigidFit
  /// x and y, canonical, of the mean crown's growth axis where it lies on this crown, or as that was seen: how far the
  /// crown's form leans against its border. A gum line leans with the gum, a cut across the tooth's long axis with the
  /// root. At most `longest_form_axis` long: what seems to lean by more was laid badly. Half of it where an arch's
  /// directions are given.
  Eigen::Vector2d form_axis = Eigen::Vector2d::Zero();

  /// That axis as a unit vector, canonical.
  Eigen::Vector3d form_direction() const;
};

/// Canonical pose of an open crown with a known FDI number: axis and centre from the crown itself, rotation about the
/// axis by registering the crown to the mean crown of its type, within 60 degrees of `directions`' where they are
/// known, else as the crown was seen to stand (`seen`); the registration then tells the residual alone. The lean of the
/// form is that of `seen`, if there is one; half of it with `directions`. Deterministic. Throws UsageError for an
/// unknown FDI number.
CrownFrame canonical_frame(const PreparedCrown& crown, int fdi, const MeanCrown& mean,
                           const RegistrationOptions& options = {},
                           const std::optional<ToothDirections>& directions = {},
                           const std::optional<CrownPose>& seen = {});

/// What tooth a crown seems to be.
struct TypeGuess {
  int fdi = 0;       ///< best of the 32 permanent numbers (residuals of left and right included)
  CrownFrame frame;  ///< canonical frame for that number
  std::array<double, std::size_t{2} * tooth_type_count> residuals_mm{};  ///< [2 * type + (right side ? 1 : 0)]
};

/// Tries all 16 types on both sides and returns the best. Throws as canonical_frame.
TypeGuess guess_fdi_type(const PreparedCrown& crown, const Atlas& atlas, const RegistrationOptions& options = {});

/// Registers the mean crown of a type to crown points whose axis is not known, such as a crown closed by a cap.
/// @param points   oriented points of the surface, millimetres, normals outward; the cap may be among them
/// @param mean     mean crown of the type
/// @param right_side  mirror the crown to the left first
/// @param any_orientation  true: the axis may point anywhere; false: it is within 30 degrees of `axis_hint`
/// @param axis_hint  unit vector from root to crown; read only if any_orientation is false
/// One-way where the crown has surface that the mean crown lacks: points (the cap) beyond the trimmed share do not
/// count.
RigidFit fit_mean_crown(const OrientedPoints& points, const MeanCrown& mean, bool right_side, bool any_orientation,
                        const Eigen::Vector3d& axis_hint = Eigen::Vector3d::UnitZ(),
                        const RegistrationOptions& options = {});

}  // namespace rhizodont
