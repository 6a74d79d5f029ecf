// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace rhizodont {

/// Which way a tooth stands as far as its place in the arch tells: two unit directions in the input's frame, at right
/// angles to each other to within a degree.
struct ToothDirections {
  Eigen::Vector3d occlusal{0, 0, 1};  ///< along the tooth's long axis, from root to crown
  Eigen::Vector3d buccal{0, 1, 0};    ///< from the tongue or palate to the cheek or lip
};

}  // namespace rhizodont
