// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "rhizodont/tooth_directions.hpp"

#include <Eigen/Core>

#include <filesystem>
#include <map>

namespace rhizodont {

/// How a permanent tooth stands in the mean arch: millimetres, x to the patient's left, y up, z to the front.
struct ArchTooth {
  Point place;                 ///< middle of the crown's surface
  ToothDirections directions;  ///< of the mean crown of its type, laid on the tooth's
  /// rad^2: how its turns vary between people, about x, y and z of the arch.
  Eigen::Matrix3d turn_covariance = Eigen::Matrix3d::Zero();
};

/// The mean arch, both jaws: every permanent tooth by its FDI number. Left and right mirror each other. Third molars,
/// of which there are few to learn from, carry the line of the first and second on and stand as the second.
struct ArchModel {
  std::map<int, ArchTooth> teeth;
};

/// Puts third molars behind the second molars of a model that lacks them. Throws UsageError if first or second molars
/// are missing.
void add_third_molars(ArchModel& model);

/// Reads tensors places (28 x 3), occlusal (28 x 3), buccal (28 x 3) and turn_covariances (28 x 3 x 3), teeth in the
/// order 11-17, 21-27, 31-37, 41-47; third molars are added. Throws InputError if the file is missing, damaged, or its
/// directions are no unit vectors.
ArchModel load_arch_model(const std::filesystem::path& file);

/// Writes such a file; third molars are left out.
void save_arch_model(const ArchModel& model, const std::filesystem::path& file);

}  // namespace rhizodont
