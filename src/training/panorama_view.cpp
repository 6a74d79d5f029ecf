// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/panorama_view.hpp"

#include "completion/crown_panorama.hpp"

#include <Eigen/Geometry>

namespace rhizodont {

PanoramaView view_from_beside(const TriangleMesh& crown, const Eigen::Vector3d& along, RandomStream& random) {
  constexpr double lean = 0.06, aside_mm = 0.25;
  const auto draw = [&] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Eigen::Vector3d(x, y, z);
  };
  const Eigen::Vector3d across = along.cross(draw()).normalized();
  const Eigen::Vector3d axis = (along + random.normal(0.0, lean) * across).normalized();
  return {axis, panorama_centre(crown, axis) + aside_mm * draw()};
}

}  // namespace rhizodont
