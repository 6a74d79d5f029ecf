// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/crown_traits.hpp"

#include "completion/likely_teeth.hpp"
#include "completion/oriented_clouds.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

constexpr double normal_weight_mm = 2.5;  // as registration has it
constexpr double near_mm = 1.0;           // nearer surface is seen, or explained
constexpr double far_mm = 1.5;            // offsets end here
constexpr double least_agreement = 0.3;   // of normals, where surface counts as the same

/// The value that a share of the values stays below.
double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double mean_below(const std::vector<double>& values, double limit) {
  double sum = 0, count = 0;
  for (const double v : values)
    if (v <= limit) sum += v, count += 1;
  return sum / count;
}

/// One direction: from each point of one cloud to the nearest of the other.
struct OneWay {
  std::vector<double> oriented, plain;  // mm, with and without normals
  double near = 0;                      // share with surface near
  NearestOfCloud nearest;
};

OneWay one_way(const OrientedCloud& from, const OrientedCloud& to) {
  OneWay way;
  way.nearest = nearest(features_of(from, normal_weight_mm), features_of(to, normal_weight_mm));
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Index other = way.nearest.index[k];
    way.oriented.push_back(std::sqrt(way.nearest.squared[k]));
    way.plain.push_back((from.points.col(i) - to.points.col(other)).norm());
    if (way.plain.back() < near_mm && from.normals.col(i).dot(to.normals.col(other)) > least_agreement)
      way.near += 1 / static_cast<double>(from.size());
  }
  return way;
}

/// Extent of a cloud along an axis but for the outermost 1 % on either side.
std::pair<double, double> range_along(const OrientedCloud& cloud, Eigen::Index axis) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < cloud.size(); ++i) values.push_back(cloud.points(axis, i));
  return {quantile(values, 0.01), quantile(values, 0.99)};
}

double logarithm(double x) { return std::log(std::max(x, 1e-3)); }

CrownTraits traits(const OrientedPoints& crown, const Eigen::Vector3d& axis, const RigidFit& fit,
                   const OrientedCloud& mean) {
  OrientedPoints laid;
  for (const Point& p : crown.points) laid.points.push_back(fit.frame.to_canonical(p));
  for (const Eigen::Vector3d& n : crown.normals) laid.normals.push_back(fit.frame.direction_to_canonical(n));
  const OrientedCloud here = cloud_of(laid, fit.frame.scale / fit.scale_ratio);
  const OneWay forth = one_way(here, mean), back = one_way(mean, here);

  CrownTraits t;
  const auto mean_of = [](const std::vector<double>& values) { return mean_below(values, far_mm * 100); };
  constexpr double kept = 0.95;
  std::vector<double> a{logarithm(mean_below(forth.oriented, quantile(forth.oriented, kept))),
                        logarithm(mean_below(back.oriented, quantile(back.oriented, kept))),
                        logarithm(mean_of(forth.plain)),
                        logarithm(mean_of(back.plain)),
                        forth.near,
                        back.near,
                        std::log(fit.scale_ratio),
                        std::acos(std::clamp(fit.frame.direction_to_canonical(axis).z(), -1.0, 1.0))};
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto [low, high] = range_along(here, k);
    const auto [mean_low, mean_high] = range_along(mean, k);
    a.push_back(logarithm((high - low) / (mean_high - mean_low) * fit.scale_ratio));
    if (k == 2) a.push_back(low - mean_low);
  }
  a.push_back(logarithm(quantile(forth.plain, kept)));
  a.push_back(logarithm(quantile(back.plain, kept)));
  std::transform(a.begin(), a.end(), t.agreement.begin(), [](double x) { return static_cast<float>(x); });

  const auto step = mean.size() / static_cast<Eigen::Index>(CrownTraits::place_count);
  for (std::size_t k = 0; k < CrownTraits::place_count; ++k) {
    const Eigen::Index i = static_cast<Eigen::Index>(k) * std::max<Eigen::Index>(1, step) % mean.size();
    const Eigen::Index other = back.nearest.index[static_cast<std::size_t>(i)];
    if (back.plain[static_cast<std::size_t>(i)] > far_mm) continue;
    if (mean.normals.col(i).dot(here.normals.col(other)) < least_agreement) continue;
    t.offsets[k] = static_cast<float>(mean.normals.col(i).dot(here.points.col(other) - mean.points.col(i)));
  }
  t.distance_mm = 0.5 * (mean_of(forth.plain) + mean_of(back.plain)) * fit.scale_ratio;
  t.seen = back.near;
  t.explained = forth.near;
  return t;
}

}  // namespace

std::vector<ToothTraits> crown_traits(const TriangleMesh& open_crown, const Atlas& atlas,
                                      std::optional<std::size_t> also) {
  constexpr std::size_t likely = 12, points = 384;
  const std::vector<ToothFit> fits = lay_likely_teeth(open_crown, atlas, likely, also);
  const SurfaceSamples surface = sample_surface(open_crown, points, 1);
  const OrientedPoints crown{surface.points, surface.normals};
  const Eigen::Vector3d axis = growth_axis(open_crown);
  std::vector<ToothTraits> result(fits.size());
  tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t i) {
    const auto& [tooth, fit] = fits[i];
    result[i] = {tooth, traits(crown, axis, fit, cloud_of(atlas.types[tooth / 2].crown, fit.frame.scale))};
  });
  return result;
}

}  // namespace rhizodont
