// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

// What generated arches are drawn from. A tooth of the left side is named by its row: 0 to 6 are 21 to 27, 7 to 13 are
// 31 to 37. Places and directions are the arch's: x to the patient's left, y up, z to the front, millimetres.
namespace rhizodont {

inline constexpr std::size_t arch_rows = 14;

/// A statistical crown model about its middle, or its mirror image for a model of the right side.
struct ArchCrownForm {
  TriangleMesh mean;                    ///< closed, outward, about its middle
  std::vector<Eigen::MatrixX3f> modes;  ///< per mode a displacement of each vertex
  std::vector<double> deviations;       ///< of the modes' coefficients, mm
  Point place = Point::Zero();          ///< of the middle in the mean arch
};

/// A crown of a real person where it stands.
struct RealCrown {
  TriangleMesh mesh;            ///< closed, outward, about its middle, left side
  Point place = Point::Zero();  ///< of the middle, left side
  /// Brought to the size of the mean crown of its side's model, along each axis; about the mean's middle.
  std::vector<Point> as_mean;
  /// Smooth displacement of each vertex of `as_mean` that brings it to the mean crown but for its finer forms.
  std::vector<Eigen::Vector3d> to_mean;
  /// Per vertex three of the model's vertices and their shares, to carry the modes over.
  std::vector<std::array<std::pair<int, float>, 3>> carriers;
};

struct ArchSource {
  std::array<std::array<ArchCrownForm, 2>, arch_rows> forms;  ///< the left side's own model and the right side's
  /// Square roots of how places (mm) and turns (radians about x, y, z) vary, left side.
  std::array<Eigen::Matrix3d, arch_rows> place_root, turn_root;
  /// Cholesky factor of the relative sizes' covariance; rows: left teeth, then the right ones in the same order.
  Eigen::Matrix<double, 2 * arch_rows, 2 * arch_rows> size_root;
  /// Per person and side: 0 left, 1 right (mirrored). Empty where the crowns of these people are not at hand.
  std::vector<std::array<std::array<RealCrown, 2>, arch_rows>> people;
};

/// Row of a permanent tooth 1 to 7. Precondition: it is one.
std::size_t arch_row(int fdi);

/// Of a folder with ssm/, arch_covariances.safetensors and perhaps patient0/ and patient1/. Throws InputError where a
/// model or the covariances are missing or damaged.
ArchSource load_arch_source(const std::filesystem::path& crowns);

}  // namespace rhizodont
