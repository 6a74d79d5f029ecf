// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Chamfer distance and F-score of point clouds: H. Fan, H. Su, L. Guibas, "A point set generation network for 3D object
// reconstruction from a single image", 2017; M. Tatarchenko et al., "What do single-view 3D reconstruction networks
// learn?", 2019.
#include "evaluation/root_figures.hpp"

#include "base/option_range.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "teeth/frame.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace rhizodont {
namespace {

void require_in_range(const RootFigureOptions& options) {
  require_ranges("root figures", {{"samples", options.samples, OptionRange::at_least(100)},
                                  {"root_threshold_mm", options.root_threshold_mm, OptionRange::above(0)},
                                  {"surface_threshold", options.surface_threshold, OptionRange::above(0)},
                                  {"least_prominence_mm", options.least_prominence_mm, OptionRange::above(0)}});
}

void require_surface(const TriangleMesh& mesh, const char* what) {
  if (mesh.triangles.empty()) throw InputError(std::string(what) + " has no triangles.");
  require_valid_indices(mesh);
  require_finite(mesh.vertices);
}

/// Lowest point along the axis among the vertices that a triangle uses.
Point lowest_point(const TriangleMesh& mesh, const Eigen::Vector3d& axis) {
  Point lowest = Point::Zero();
  double height = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : mesh.triangles)
    for (const int v : triangle) {
      const Point& p = mesh.vertices[static_cast<std::size_t>(v)];
      if (p.dot(axis) >= height) continue;
      height = p.dot(axis);
      lowest = p;
    }
  return lowest;
}

double used_diagonal(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : mesh.triangles)
    for (const int v : triangle) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  return box.diagonal().norm();
}

std::vector<Point> below(const std::vector<Point>& points, const Eigen::Vector3d& axis, double level) {
  std::vector<Point> result;
  std::copy_if(points.begin(), points.end(), std::back_inserter(result),
               [&](const Point& p) { return p.dot(axis) < level; });
  return result;
}

/// Distances from each of `from` to the nearest of `to`, mm.
std::vector<double> distances(const std::vector<Point>& from, const std::vector<Point>& to) {
  const NearestVertexIndex index(to);
  std::vector<double> result(from.size());
  tbb::parallel_for(std::size_t{0}, from.size(),
                    [&](std::size_t i) { result[i] = std::sqrt(index.nearest(from[i]).squared_distance); });
  return result;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double mean_square(const std::vector<double>& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / static_cast<double>(values.size());
}

/// Linear between the two values beside the percentile's place.
double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

double share_within(const std::vector<double>& values, double threshold) {
  const auto within = std::count_if(values.begin(), values.end(), [=](double d) { return d < threshold; });
  return static_cast<double>(within) / static_cast<double>(values.size());
}

/// Harmonic mean of the shares of both directions within the threshold.
double f_score(const std::vector<double>& one, const std::vector<double>& other, double threshold) {
  const double precision = share_within(one, threshold), recall = share_within(other, threshold);
  return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
}

/// From the mean of the upper half of the root's points (by count along the axis) to that of the lower half.
Eigen::Vector3d root_axis(std::vector<Point> root, const Eigen::Vector3d& axis) {
  const auto half = static_cast<std::ptrdiff_t>(root.size() / 2);
  std::nth_element(root.begin(), root.begin() + half, root.end(),
                   [&](const Point& a, const Point& b) { return a.dot(axis) < b.dot(axis); });
  const auto mean_of = [](auto first, auto last) {
    return Point(std::accumulate(first, last, Point(Point::Zero())) / static_cast<double>(last - first));
  };
  return mean_of(root.begin(), root.begin() + half) - mean_of(root.begin() + half, root.end());
}

/// Height along the axis of the highest furcation; nothing for a tooth with one root. The deepest apex, which comes
/// first, climbs to the level where roots were looked for.
std::optional<double> furcation_height(const std::vector<RootApex>& apices, const Eigen::Vector3d& axis) {
  std::optional<double> highest;
  for (std::size_t i = 1; i < apices.size(); ++i) {
    const double height = apices[i].point.dot(axis) + apices[i].prominence_mm;
    highest = std::max(highest.value_or(height), height);
  }
  return highest;
}

double angle_degrees(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

void compare_roots(const std::vector<Point>& truth, const std::vector<Point>& predicted, const Eigen::Vector3d& axis,
                   const RootFigureOptions& options, RootFigures& figures) {
  constexpr std::size_t least_points = 10;
  if (truth.size() < least_points) throw InputError("The true tooth has no root below the crown.");
  if (predicted.size() < least_points) throw NoResultError("The predicted tooth has no root below the crown.");
  const std::vector<double> to_truth = distances(predicted, truth), to_predicted = distances(truth, predicted);
  figures.root_chamfer_mm = (mean(to_truth) + mean(to_predicted)) / 2;
  figures.root_f_score = f_score(to_truth, to_predicted, options.root_threshold_mm);
  figures.root_hausdorff95_mm = std::max(percentile(to_truth, 0.95), percentile(to_predicted, 0.95));
  figures.root_axis_angle_deg = angle_degrees(root_axis(truth, axis), root_axis(predicted, axis));
}

void compare_surfaces(const std::vector<Point>& truth, const std::vector<Point>& predicted, double diagonal,
                      const RootFigureOptions& options, RootFigures& figures) {
  const std::vector<double> to_truth = distances(predicted, truth), to_predicted = distances(truth, predicted);
  figures.chamfer_l2_e3 = 1000 * (mean_square(to_truth) + mean_square(to_predicted)) / (diagonal * diagonal);
  figures.f_score = f_score(to_truth, to_predicted, options.surface_threshold * diagonal);
}

void compare_apices(const TriangleMesh& truth, const TriangleMesh& predicted, const Eigen::Vector3d& axis, double level,
                    const RootFigureOptions& options, RootFigures& figures) {
  const Point true_apex = lowest_point(truth, axis), predicted_apex = lowest_point(predicted, axis);
  figures.true_root_length_mm = level - true_apex.dot(axis);
  figures.root_length_error_mm = true_apex.dot(axis) - predicted_apex.dot(axis);
  figures.apex_distance_mm = (true_apex - predicted_apex).norm();
  figures.true_apices = root_apices(truth, axis, level, options.least_prominence_mm);
  figures.predicted_apices = root_apices(predicted, axis, level, options.least_prominence_mm);
  figures.matched_apices = match_apices(figures.true_apices, figures.predicted_apices);
  const auto true_furcation = furcation_height(figures.true_apices, axis);
  const auto predicted_furcation = furcation_height(figures.predicted_apices, axis);
  if (true_furcation && predicted_furcation) figures.furcation_height_error_mm = *predicted_furcation - *true_furcation;
  figures.matched_apex_distance_mm = figures.apex_distance_mm;
  if (figures.matched_apices.empty()) return;
  double sum = 0;
  for (const ApexPair& pair : figures.matched_apices) sum += pair.distance_mm;
  figures.matched_apex_distance_mm = sum / static_cast<double>(figures.matched_apices.size());
}

}  // namespace

Eigen::Vector3d crown_growth_axis(const TriangleMesh& crown) {
  require_surface(crown, "The crown");
  return growth_axis(crown);
}

RootFigures root_figures(const TriangleMesh& crown, const TriangleMesh& truth, const TriangleMesh& predicted,
                         const Eigen::Vector3d& axis, const RootFigureOptions& options) {
  require_in_range(options);
  if (!(axis.norm() > 0) || !axis.allFinite()) throw UsageError("The growth axis has no direction.");
  require_surface(crown, "The crown");
  require_surface(truth, "The true tooth");
  require_surface(predicted, "The predicted tooth");
  const Eigen::Vector3d up = axis.normalized();
  const double level = lowest_point(crown, up).dot(up);

  RootFigures figures;
  const std::vector<Point> true_points = sample_surface(truth, options.samples, options.seed).points;
  const std::vector<Point> predicted_points = sample_surface(predicted, options.samples, options.seed).points;
  compare_roots(below(true_points, up, level), below(predicted_points, up, level), up, options, figures);
  compare_surfaces(true_points, predicted_points, used_diagonal(truth), options, figures);
  compare_apices(truth, predicted, up, level, options, figures);
  return figures;
}

}  // namespace rhizodont
