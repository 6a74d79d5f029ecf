// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

namespace rhizodont {

/// A similarity between the scan's millimetres and the pose in which the completion network works:
/// canonical = M * rotation * (world - centre) / scale, with M = diag(-1, 1, 1) for teeth of the right side.
/// Canonical +z is the growth axis from root to crown; x and y are those of the type's mean crown (+y towards the
/// cheek).
struct CanonicalFrame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< proper rotation, world to canonical directions
  Point centre = Point::Zero();                            ///< millimetres; area-weighted centroid of the crown surface
  bool mirrored = false;                                   ///< true for right-side teeth (quadrants 1 and 4)
  double scale = 12.0;                                     ///< millimetres per canonical unit, > 0

  /// World millimetres to canonical coordinates.
  Point to_canonical(const Point& world) const;
  /// Canonical coordinates to world millimetres; inverse of to_canonical to rounding.
  Point to_world(const Point& canonical) const;
  /// A direction (unit normal, axis) to the canonical pose; keeps its length.
  Eigen::Vector3d direction_to_canonical(const Eigen::Vector3d& world) const;
  /// A direction back to the world; keeps its length.
  Eigen::Vector3d direction_to_world(const Eigen::Vector3d& canonical) const;
};

/// Number of tooth types: upper 1..8 are 0..7, lower 1..8 are 8..15; left and right share a type.
inline constexpr int tooth_type_count = 16;
/// Type 0..15 of an FDI number (11-18, 21-28, 31-38, 41-48). Throws UsageError for other numbers.
int tooth_type_of_fdi(int fdi);
/// True if the FDI number names a tooth of the right side (quadrants 1 and 4). Throws UsageError for other numbers.
bool is_right_side(int fdi);
/// FDI number of a type on the left (quadrants 2 and 3) or right (1 and 4) side.
int fdi_of_type(int type, bool right_side);

/// The mean crown of a tooth type and points of its mean whole tooth, both in canonical coordinates (unit 12 mm).
struct MeanCrown {
  OrientedPoints crown;        ///< about 512 points on the crown down to the cemento-enamel junction, normals outward
  std::vector<Point> anchors;  ///< about 512 points spread evenly over the whole mean tooth, crown and root
};

/// Mean crowns of all types, as read from models/atlas.safetensors.
struct Atlas {
  std::array<MeanCrown, tooth_type_count> types;
};

/// Reads mean crowns and anchors. Throws InputError if the file is missing, damaged or lacks a type.
Atlas load_atlas(const std::filesystem::path& file);
/// Writes them as float32 tensors crown_T (n x 3), crown_normals_T (n x 3), anchors_T (m x 3), T = 0..15.
void save_atlas(const Atlas& atlas, const std::filesystem::path& file);

/// Unit growth axis of an open crown, from root to crown: the normalised sum of its area vectors, which depends on its
/// border alone. Throws InputError if the sum vanishes (closed surface, or nothing to go by).
Eigen::Vector3d growth_axis(const TriangleMesh& open_crown);

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
  CanonicalFrame frame;    ///< z = growth_axis, centre = area_centroid; rotation about z from the registration
  double residual_mm = 0;  ///< as in RigidFit
  /// x and y, canonical, of the mean crown's growth axis where it lies on this crown: how far the crown's form leans
  /// against its border. A gum line leans with the gum, a cut across the tooth's long axis with the root. At most 0.5
  /// long: what seems to lean by more than 30 degrees was laid badly.
  Eigen::Vector2d form_axis = Eigen::Vector2d::Zero();

  /// That axis as a unit vector, canonical.
  Eigen::Vector3d form_direction() const;
};

/// Canonical pose of an open crown with a known FDI number: axis and centre from the crown itself, rotation about the
/// axis by registering the crown to the mean crown of its type. Deterministic. Throws InputError for crowns without
/// area or axis, UsageError for an unknown FDI number.
CrownFrame canonical_frame(const TriangleMesh& open_crown, int fdi, const MeanCrown& mean,
                           const RegistrationOptions& options = {});

/// What tooth a crown seems to be.
struct TypeGuess {
  int fdi = 0;       ///< best of the 32 permanent numbers (residuals of left and right included)
  CrownFrame frame;  ///< canonical frame for that number
  std::array<double, 2 * tooth_type_count> residuals_mm{};  ///< [2 * type + (right side ? 1 : 0)]
};

/// Tries all 16 types on both sides and returns the best. Throws as canonical_frame.
TypeGuess guess_fdi_type(const TriangleMesh& open_crown, const Atlas& atlas, const RegistrationOptions& options = {});

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
