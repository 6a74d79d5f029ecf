// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Two-way distances as in registration: P. Besl, N. McKay, "A method for registration of 3-D shapes", 1992.
#include "completion/mean_crown_agreement.hpp"

#include "base/parallel_tasks.hpp"
#include "completion/lay_teeth.hpp"
#include "completion/oriented_clouds.hpp"
#include "mesh/sampling.hpp"

#include <vector>

namespace rhizodont {
namespace {

struct OneWay {
  double distance_mm = 0;  // mean
  double near = 0;         // share with surface near
};

/// From each point of one cloud to the nearest of the other, which is sought with normals.
OneWay one_way(const OrientedCloud& from, const OrientedCloud& to) {
  constexpr double near_mm = 1.0, least_agreement = 0.3;
  const double weight = RegistrationOptions().normal_weight_mm;
  const NearestOfCloud found = nearest(features_of(from, weight), features_of(to, weight));
  OneWay way;
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const Eigen::Index other = found.index[static_cast<std::size_t>(i)];
    const double distance = (from.points.col(i) - to.points.col(other)).norm();
    const double share = 1 / static_cast<double>(from.size());
    way.distance_mm += share * distance;
    if (distance < near_mm && from.normals.col(i).dot(to.normals.col(other)) > least_agreement) way.near += share;
  }
  return way;
}

}  // namespace

std::vector<MeanCrownAgreement> mean_crown_agreement(const PreparedCrown& crown, const Atlas& atlas,
                                                     const std::vector<std::size_t>& teeth) {
  constexpr std::size_t points = 384;
  const std::vector<RigidFit> fits = lay_teeth(crown, atlas, teeth);
  const SurfaceSamples surface = sample_surface(crown.mesh, points, 1);
  std::vector<MeanCrownAgreement> result(fits.size());
  parallel_tasks(result.size(), [&](std::size_t i) {
    const CanonicalFrame& frame = fits[i].frame;
    OrientedPoints laid;
    for (const Point& p : surface.points) laid.points.push_back(frame.to_canonical(p));
    for (const Eigen::Vector3d& n : surface.normals) laid.normals.push_back(frame.direction_to_canonical(n));
    const OrientedCloud here = cloud_of(laid, frame.scale / fits[i].scale_ratio);
    const OrientedCloud mean = cloud_of(atlas.types[teeth[i] / 2].crown, frame.scale);
    const OneWay forth = one_way(here, mean), back = one_way(mean, here);
    result[i] = {0.5 * (forth.distance_mm + back.distance_mm) * fits[i].scale_ratio, back.near, forth.near};
  });
  return result;
}

}  // namespace rhizodont
