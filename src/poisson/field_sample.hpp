// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace rhizodont {

/// What a scalar field says at one point.
struct FieldSample {
  double value = 0.0;                                  ///< of the field
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the field, per mm
};

}  // namespace rhizodont
