// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace rhizodont {

struct FamilyTemplate;

/// A statistical model of a tooth type's crowns as its file gives it: points on a crown closed by a cap at the gum,
/// shape = mean + sum of c_k modes_k with independent c_k of mean 0.
struct CrownShapeModel {
  std::vector<Point> mean;               ///< millimetres, in the arch's frame: y up, z to the front, x to the left
  std::vector<Eigen::Vector3d> normals;  ///< unit; their sign is not to be trusted
  std::vector<Eigen::MatrixX3d> modes;   ///< per mode a displacement of each point, unit norm over all points
  std::vector<double> deviations;        ///< of c_k, millimetres
};

/// Reads tensors mean (n x 3), mean_normals (n x 3), modes (m x n x 3), variances (m); the first `mode_count` modes.
/// `right_side` mirrors a model of the right side to the left (x -> -x).
/// Throws InputError if the file is missing, damaged or of other shapes.
CrownShapeModel load_crown_shape_model(const std::filesystem::path& file, std::size_t mode_count, bool right_side);

/// The cap that closes a model's crown at the gum: points near one plane, which faces away from the cusps. The gum's
/// line is scalloped and the cap a membrane over it, so that whatever looks down is taken for it too.
struct CrownCap {
  std::vector<bool> is_cap;                             ///< per point of the model
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< unit, out of the crown
};

/// Finds the cap of the model's mean crown. @param upper  true for teeth of the upper jaw
/// Throws NoResultError if there is none.
CrownCap find_cap(const CrownShapeModel& model, bool upper);

/// A crown model carried onto a template's vertices, in the template's frame and millimetres.
/// Rows 3 v .. 3 v + 2 belong to vertex v. Below the neck the displacements fade out within the root's upper half.
struct CrownModes {
  Eigen::VectorXf mean_shift;      ///< brings the template's crown to the form of the model's mean, size aside
  Eigen::MatrixXf modes;           ///< a column per mode
  std::vector<double> deviations;  ///< of the modes' coefficients
  double residual_mm = 0;          ///< mean distance of the model's mean crown from the template brought to it
};

/// Registers the model's mean crown to the template's crown (similarity with a scale for each axis, then a smooth
/// displacement) and carries its modes over.
/// @param buccal  direction from the tongue to the cheek in the model's frame
/// @param upper   true for teeth of the upper jaw
/// Throws NoResultError if the two crowns do not come together.
CrownModes carry_crown_model(const FamilyTemplate& tooth, const CrownShapeModel& model, const Eigen::Vector3d& buccal,
                             bool upper);

}  // namespace rhizodont
