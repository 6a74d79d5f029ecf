// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Laying mean crowns on crowns: a search over starting rotations, then trimmed two-way iterative closest points with
// normals. P. J. Besl, N. D. McKay, "A method for registration of 3-D shapes", 1992; D. Chetverikov, D. Stepanov,
// P. Krsek, "Robust Euclidean alignment of 3D point sets: the trimmed iterative closest point algorithm", 2005.
#include "completion/registration.hpp"
#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "completion/lay_teeth.hpp"
#include "completion/oriented_clouds.hpp"
#include "completion/similarity.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace rhizodont {
namespace {

using Matrix3X = Eigen::Matrix3Xd;

// Every k-th point: the clouds are in random or farthest-point order, of which any part is even.
OrientedCloud thinned(const OrientedCloud& cloud, Eigen::Index count) {
  if (cloud.size() <= count) return cloud;
  OrientedCloud result;
  result.points.resize(3, count);
  result.normals.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index from = i * cloud.size() / count;
    result.points.col(i) = cloud.points.col(from);
    result.normals.col(i) = cloud.normals.col(from);
  }
  return result;
}

OrientedCloud moved(const OrientedCloud& cloud, const Similarity& by) {
  OrientedCloud result;
  result.points = (by.scale * by.rotation * cloud.points).colwise() + by.shift;
  result.normals = by.rotation * cloud.normals;
  return result;
}

double trimmed_limit(std::vector<double> values, double share) {
  const auto at = std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

double trimmed_mean_distance(const std::vector<double>& squared, double share) {
  const double limit = trimmed_limit(squared, share);
  double sum = 0;
  Eigen::Index count = 0;
  for (double value : squared)
    if (value <= limit) sum += std::sqrt(value), ++count;
  return sum / static_cast<double>(count);
}

// Shares of the pairs that count, by direction. A crown with a cap, or cut lower than the mean crown, has surface that
// the mean lacks; one cut higher lacks surface of the mean.
struct Trim {
  double crown, mean;
};

double two_way_distance(const CloudFeatures& crown, const CloudFeatures& mean, const Trim& trim) {
  return 0.5 * (trimmed_mean_distance(nearest(crown, mean).squared, trim.crown) +
                trimmed_mean_distance(nearest(mean, crown).squared, trim.mean));
}

Similarity refined(const OrientedCloud& crown, const OrientedCloud& mean, Similarity at,
                   const RegistrationOptions& options, const Trim& trim, int iterations) {
  const CloudFeatures goal = features_of(mean, options.normal_weight_mm);
  for (int i = 0; i < iterations; ++i) {
    const OrientedCloud here = moved(crown, at);
    const CloudFeatures features = features_of(here, options.normal_weight_mm);
    const NearestOfCloud forth = nearest(features, goal), back = nearest(goal, features);
    const double forth_limit = trimmed_limit(forth.squared, trim.crown);
    const double back_limit = trimmed_limit(back.squared, trim.mean);
    std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs;  // crown point, mean point
    for (Eigen::Index k = 0; k < here.size(); ++k)
      if (forth.squared[static_cast<std::size_t>(k)] <= forth_limit)
        pairs.emplace_back(k, forth.index[static_cast<std::size_t>(k)]);
    for (Eigen::Index k = 0; k < mean.size(); ++k)
      if (back.squared[static_cast<std::size_t>(k)] <= back_limit)
        pairs.emplace_back(back.index[static_cast<std::size_t>(k)], k);
    Matrix3X from(3, static_cast<Eigen::Index>(pairs.size())), to(3, from.cols());
    for (Eigen::Index k = 0; k < from.cols(); ++k) {
      const auto& [c, m] = pairs[static_cast<std::size_t>(k)];
      from.col(k) = crown.points.col(c);
      to.col(k) = mean.points.col(m);
    }
    const Similarity before = std::exchange(at, similarity_of_pairs(from, to, {0.8, 1.3}));
    constexpr double still = 1e-3;  // radians and millimetres
    if ((at.rotation - before.rotation).norm() < still && (at.shift - before.shift).norm() < still) break;
  }
  return at;
}

// Start with a rotation: tops together along z, centres together across.
Similarity start_with(const Eigen::Matrix3d& rotation, const OrientedCloud& crown, const OrientedCloud& mean) {
  Similarity start;
  start.rotation = rotation;
  const Matrix3X turned = rotation * crown.points;
  start.shift = mean.points.rowwise().mean() - turned.rowwise().mean();
  start.shift.z() = mean.points.row(2).maxCoeff() - turned.row(2).maxCoeff();
  return start;
}

struct Registered {
  Similarity at;
  double residual = std::numeric_limits<double>::max();
};

Registered register_cloud(const OrientedCloud& crown, const OrientedCloud& mean,
                          const std::vector<Eigen::Matrix3d>& rotations, const RegistrationOptions& options,
                          const Trim& trim) {
  const OrientedCloud coarse_crown = thinned(crown, 128), coarse_mean = thinned(mean, 128);
  const OrientedCloud fine_crown = thinned(crown, 256), fine_mean = thinned(mean, 256);
  const CloudFeatures coarse_goal = features_of(coarse_mean, options.normal_weight_mm);
  std::vector<std::pair<double, std::size_t>> starts(rotations.size());
  parallel_tasks(rotations.size(), [&](std::size_t r) {
    const Similarity start = start_with(rotations[r], coarse_crown, coarse_mean);
    const CloudFeatures features = features_of(moved(coarse_crown, start), options.normal_weight_mm);
    starts[r] = {two_way_distance(features, coarse_goal, trim), r};
  });
  std::sort(starts.begin(), starts.end());
  std::vector<Eigen::Matrix3d> chosen;
  for (const auto& start : starts) {
    const std::size_t r = start.second;
    // Starts next to one already taken would only find the same place.
    const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Eigen::Matrix3d& other) {
      return Eigen::AngleAxisd(Eigen::Matrix3d(other.transpose() * rotations[r])).angle() < 0.4;
    });
    if (is_new) chosen.push_back(rotations[r]);
    if (static_cast<int>(chosen.size()) == options.refined_starts) break;
  }
  const CloudFeatures goal = features_of(mean, options.normal_weight_mm);
  std::vector<Registered> refined_starts(chosen.size());
  parallel_tasks(chosen.size(), [&](std::size_t k) {
    Similarity at = start_with(chosen[k], fine_crown, fine_mean);
    at = refined(fine_crown, fine_mean, at, options, trim, options.iterations);
    const CloudFeatures features = features_of(moved(crown, at), options.normal_weight_mm);
    refined_starts[k] = {at, two_way_distance(features, goal, trim)};
  });
  Registered best;
  for (const Registered& found : refined_starts)
    if (found.residual < best.residual) best = found;
  best.at = refined(crown, mean, best.at, options, trim, 3);
  best.residual = two_way_distance(features_of(moved(crown, best.at), options.normal_weight_mm), goal, trim);
  return best;
}

void require_in_range(const RegistrationOptions& options) {
  require_ranges("a registration",
                 {{"start_angles", options.start_angles, OptionRange::at_least(4)},
                  {"refined_starts", options.refined_starts, OptionRange::at_least(1).at_most(options.start_angles)},
                  {"iterations", options.iterations, OptionRange::at_least(1)},
                  {"trim", options.trim, OptionRange::at_least(0.3).at_most(1)},
                  {"normal_weight_mm", options.normal_weight_mm, OptionRange::at_least(0)}});
}

Eigen::Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix(); }

std::vector<Eigen::Matrix3d> rotations_about_z(int count) {
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) rotations.push_back(about_z(2 * std::numbers::pi * i / count));
  return rotations;
}

// Directions spread evenly over the sphere (Fibonacci lattice), each brought up to z and turned about it.
std::vector<Eigen::Matrix3d> all_rotations(int directions, int angles) {
  std::vector<Eigen::Matrix3d> rotations;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int d = 0; d < directions; ++d) {
    const double z = 1 - (2.0 * d + 1) / directions, radius = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(radius * std::cos(golden * d), radius * std::sin(golden * d), z);
    const Eigen::Matrix3d up =
        Eigen::Quaterniond::FromTwoVectors(direction, Eigen::Vector3d::UnitZ().eval()).toRotationMatrix();
    for (int a = 0; a < angles; ++a) rotations.push_back(about_z(2 * std::numbers::pi * a / angles) * up);
  }
  return rotations;
}

OrientedPoints surface_points(const TriangleMesh& mesh) {
  const SurfaceSamples samples = sample_surface(mesh, 512, 1);
  return {samples.points, samples.normals};
}

// World points to a pose with `axis` up and `centre` in the origin, mirrored for the right side.
OrientedCloud upright_cloud(const OrientedPoints& points, const CanonicalFrame& upright) {
  OrientedPoints turned;
  for (const Point& p : points.points) turned.points.push_back(upright.to_canonical(p));
  for (const Eigen::Vector3d& n : points.normals) turned.normals.push_back(upright.direction_to_canonical(n));
  return cloud_of(turned, upright.scale);
}

CanonicalFrame upright_frame(const Eigen::Vector3d& axis, const Point& centre, bool right_side) {
  CanonicalFrame frame;
  frame.rotation = Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ().eval()).toRotationMatrix();
  frame.centre = centre;
  frame.mirrored = right_side;
  return frame;
}

// A rotation that acts after the mirroring of an upright frame, taken into the frame.
CanonicalFrame turned_frame(const CanonicalFrame& upright, const Eigen::Matrix3d& rotation) {
  CanonicalFrame frame = upright;
  const Eigen::Vector3d mirror(upright.mirrored ? -1 : 1, 1, 1);
  frame.rotation = mirror.asDiagonal() * rotation * mirror.asDiagonal() * upright.rotation;
  return frame;
}

// The same pose turned about its axis, so that +y is the part across it of a direction in the world.
CanonicalFrame facing(const CanonicalFrame& frame, const Eigen::Vector3d& buccal) {
  const Eigen::Vector3d towards = frame.direction_to_canonical(buccal);
  return turned_frame(frame, about_z(std::atan2(towards.x(), towards.y())));
}

// A crown brought upright and what laying a mean crown on it found from there.
struct Laid {
  CanonicalFrame upright;
  Registered found;
};

Laid lay(const OrientedPoints& points, const CanonicalFrame& upright, const MeanCrown& mean,
         const std::vector<Eigen::Matrix3d>& starts, const RegistrationOptions& options) {
  const OrientedCloud crown = upright_cloud(points, upright), goal = cloud_of(mean.crown, upright.scale);
  return {upright, register_cloud(crown, goal, starts, options, {options.trim, options.trim})};
}

Laid lay(const OrientedPoints& points, const CanonicalFrame& upright, const MeanCrown& mean,
         const RegistrationOptions& options) {
  return lay(points, upright, mean, rotations_about_z(options.start_angles), options);
}

double turn_about_z(const Laid& laid) {
  const Eigen::Matrix3d& r = laid.found.at.rotation;
  return std::atan2(r(1, 0) - r(0, 1), r(0, 0) + r(1, 1));
}

/// x and y of a unit axis, not too long. What points down was laid, or seen, upside down and tells nothing.
Eigen::Vector2d form_axis_along(const Eigen::Vector3d& axis) {
  if (!(axis.z() > 0)) return Eigen::Vector2d::Zero();
  constexpr double longest = CrownFrame::longest_form_axis;
  return longest / std::max(axis.head<2>().norm(), longest) * axis.head<2>();
}

CrownFrame crown_frame(const Laid& laid) {
  // The axis is the crown's own: of the registration only the turn about it is kept.
  const Eigen::Matrix3d& r = laid.found.at.rotation;
  CrownFrame result;
  const Eigen::Matrix3d turn = about_z(turn_about_z(laid));
  result.frame = turned_frame(laid.upright, turn);
  result.form_axis = form_axis_along((turn * r.transpose()).col(2));
  result.residual_mm = laid.found.residual / laid.found.at.scale;
  return result;
}

RigidFit rigid_fit(const Laid& laid) {
  const Registered& found = laid.found;
  RigidFit fit;
  fit.frame = turned_frame(laid.upright, found.at.rotation);
  fit.residual_mm = found.residual / found.at.scale;
  fit.scale_ratio = 1 / found.at.scale;
  // The mean crown's own origin, carried back to the scan.
  const Eigen::Vector3d origin =
      found.at.rotation.transpose() * (-found.at.shift) / found.at.scale / laid.upright.scale;
  fit.frame.centre = laid.upright.to_world(origin);
  return fit;
}

CrownFrame frame_from(const OrientedPoints& points, const Eigen::Vector3d& axis, const Point& centre, bool right_side,
                      const MeanCrown& mean, const RegistrationOptions& options) {
  return crown_frame(lay(points, upright_frame(axis, centre, right_side), mean, options));
}

/// As `frame_from`, of a crown of which it is known where the cheek is: +y is not far from `buccal`, and is `buccal`
/// itself where the registration turns away from it.
CrownFrame frame_near(const OrientedPoints& points, const Eigen::Vector3d& axis, const Point& centre, bool right_side,
                      const Eigen::Vector3d& buccal, const MeanCrown& mean, const RegistrationOptions& options) {
  constexpr double furthest_start = std::numbers::pi / 4, furthest_found = std::numbers::pi / 3;
  const CanonicalFrame upright = facing(upright_frame(axis, centre, right_side), buccal);
  constexpr int steps = 4;
  std::vector<Eigen::Matrix3d> starts;
  for (int i = -steps; i <= steps; ++i) starts.push_back(about_z(furthest_start * i / steps));
  const Laid laid = lay(points, upright, mean, starts, options);
  CrownFrame found = crown_frame(laid);
  if (std::abs(turn_about_z(laid)) > furthest_found) {
    found.frame = upright;
    found.form_axis.setZero();
  }
  return found;
}

void check_mean(const MeanCrown& mean) {
  if (mean.crown.points.size() < 50 || mean.crown.points.size() != mean.crown.normals.size())
    throw UsageError("The mean crown of this tooth type is missing from the atlas.");
}

}  // namespace

Eigen::Vector3d CrownFrame::form_direction() const {
  return {form_axis.x(), form_axis.y(), std::sqrt(std::max(0.0, 1 - form_axis.squaredNorm()))};
}

CrownFrame canonical_frame(const PreparedCrown& crown, int fdi, const MeanCrown& mean,
                           const RegistrationOptions& options, const std::optional<ToothDirections>& directions,
                           const std::optional<CrownPose>& seen) {
  require_in_range(options);
  check_mean(mean);
  const bool right_side = is_right_side(fdi);
  const OrientedPoints points = surface_points(crown.mesh);
  const Point centre = area_centroid(crown.mesh);
  if (!directions && !seen) return frame_from(points, crown.growth_axis, centre, right_side, mean, options);
  CrownFrame found;
  if (directions) {
    found = frame_near(points, crown.growth_axis, centre, right_side, directions->buccal, mean, options);
  } else {
    const CanonicalFrame upright = facing(upright_frame(crown.growth_axis, centre, right_side), seen->buccal);
    found.frame = upright;
    found.residual_mm = crown_frame(lay(points, upright, mean, {Eigen::Matrix3d::Identity()}, options)).residual_mm;
  }
  if (seen) found.form_axis = form_axis_along(found.frame.direction_to_canonical(seen->form_axis));
  // The form's lean is against an axis that knows of the tooth's place, not against a border alone: two estimates of
  // one axis, each taken for half (measured in docs/arches.md).
  if (directions) found.form_axis /= 2;
  return found;
}

TypeGuess guess_fdi_type(const PreparedCrown& crown, const Atlas& atlas, const RegistrationOptions& options) {
  require_in_range(options);
  const OrientedPoints points = surface_points(crown.mesh);
  const Point centre = area_centroid(crown.mesh);
  for (const MeanCrown& mean : atlas.types) check_mean(mean);
  std::array<CrownFrame, std::size_t{2} * tooth_type_count> frames;
  const auto fit = [&](std::size_t i, const OrientedPoints& cloud, const RegistrationOptions& how) {
    frames[i] = frame_from(cloud, crown.growth_axis, centre, i % 2 == 1, atlas.types[i / 2], how);
  };
  // A rough pass over everything, then the full registration of what came out best.
  constexpr std::size_t candidates = 8;
  OrientedPoints few;
  for (std::size_t i = 0; i < points.points.size(); i += 3) {
    few.points.push_back(points.points[i]);
    few.normals.push_back(points.normals[i]);
  }
  RegistrationOptions rough = options;
  rough.refined_starts = std::min(2, options.refined_starts);
  rough.iterations = std::min(6, options.iterations);
  parallel_tasks(frames.size(), [&](std::size_t i) { fit(i, few, rough); });
  std::array<std::size_t, std::size_t{2} * tooth_type_count> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&frames](std::size_t a, std::size_t b) { return frames[a].residual_mm < frames[b].residual_mm; });
  parallel_tasks(candidates, [&](std::size_t k) { fit(order[k], points, options); });
  TypeGuess guess;
  for (std::size_t i = 0; i < frames.size(); ++i) guess.residuals_mm[i] = frames[i].residual_mm;
  const std::size_t best =
      *std::min_element(order.begin(), order.begin() + candidates, [&frames](std::size_t a, std::size_t b) {
        return frames[a].residual_mm != frames[b].residual_mm ? frames[a].residual_mm < frames[b].residual_mm : a < b;
      });
  guess.fdi = fdi_of_type(static_cast<int>(best / 2), best % 2 == 1);
  guess.frame = frames[best];
  return guess;
}

RigidFit fit_mean_crown(const OrientedPoints& points, const MeanCrown& mean, bool right_side, bool any_orientation,
                        const Eigen::Vector3d& axis_hint, const RegistrationOptions& options) {
  require_in_range(options);
  check_mean(mean);
  if (points.points.size() < 50 || points.points.size() != points.normals.size())
    throw InputError("Too few surface points to lay a mean crown on.");
  if (!any_orientation && !(std::abs(axis_hint.norm() - 1) < 1e-6)) throw UsageError("The axis is not a unit vector.");
  Point centre = Point::Zero();
  for (const Point& p : points.points) centre += p / static_cast<double>(points.points.size());
  const CanonicalFrame upright =
      upright_frame(any_orientation ? Eigen::Vector3d::UnitZ().eval() : axis_hint, centre, right_side);
  const OrientedCloud crown = upright_cloud(points, upright), goal = cloud_of(mean.crown, upright.scale);
  const std::vector<Eigen::Matrix3d> rotations =
      any_orientation ? all_rotations(40, 12) : rotations_about_z(options.start_angles);
  RegistrationOptions wide = options;
  if (any_orientation) wide.refined_starts = std::max(12, options.refined_starts);
  // The cap over a base takes up to a third of a crown's surface.
  const Registered found = register_cloud(crown, goal, rotations, wide, {0.65 * options.trim, options.trim});
  return rigid_fit({upright, found});
}

std::vector<RigidFit> lay_teeth(const PreparedCrown& crown, const Atlas& atlas, const std::vector<std::size_t>& teeth) {
  constexpr Eigen::Index few = 96, crown_points = 160, mean_points = 256;
  constexpr int start_angles = 24, first_iterations = 4, last_iterations = 6;
  const RegistrationOptions options;
  const Trim trim{options.trim, options.trim};
  const OrientedPoints points = surface_points(crown.mesh);
  const Point centre = area_centroid(crown.mesh);
  for (const std::size_t tooth : teeth) check_mean(atlas.types.at(tooth / 2));
  const std::vector<Eigen::Matrix3d> rotations = rotations_about_z(start_angles);

  std::vector<RigidFit> fits(teeth.size());
  parallel_tasks(fits.size(), [&](std::size_t i) {
    Laid laid;
    laid.upright = upright_frame(crown.growth_axis, centre, teeth[i] % 2 == 1);
    const OrientedCloud cloud = upright_cloud(points, laid.upright);
    const OrientedCloud mean = cloud_of(atlas.types[teeth[i] / 2].crown, laid.upright.scale);
    const auto distance_to = [&](const OrientedCloud& from, const CloudFeatures& goal, const Similarity& at) {
      return two_way_distance(features_of(moved(from, at), options.normal_weight_mm), goal, trim);
    };
    const OrientedCloud rough_crown = thinned(cloud, few), rough_mean = thinned(mean, few);
    const CloudFeatures rough_goal = features_of(rough_mean, options.normal_weight_mm);
    std::vector<std::pair<double, Similarity>> starts;
    for (const Eigen::Matrix3d& rotation : rotations) {
      const Similarity at = start_with(rotation, rough_crown, rough_mean);
      starts.emplace_back(distance_to(rough_crown, rough_goal, at), at);
    }
    std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {  // the second has a turn of its own more often
      const Similarity at = refined(rough_crown, rough_mean, starts[k].second, options, trim, first_iterations);
      if (const double residual = distance_to(rough_crown, rough_goal, at); residual < laid.found.residual)
        laid.found = {at, residual};
    }
    const OrientedCloud fine_crown = thinned(cloud, crown_points), fine_mean = thinned(mean, mean_points);
    laid.found.at = refined(fine_crown, fine_mean, laid.found.at, options, trim, last_iterations);
    laid.found.residual = distance_to(fine_crown, features_of(fine_mean, options.normal_weight_mm), laid.found.at);
    fits[i] = rigid_fit(laid);
  });
  return fits;
}

}  // namespace rhizodont
