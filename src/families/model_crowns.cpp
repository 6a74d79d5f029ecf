// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Crowns of real people by their statistical models alone. Surfaces from points: D. Cohen-Steiner, F. Da, "A greedy
// Delaunay-based surface reconstruction algorithm", The Visual Computer 20, 2004.
#include "families/model_crowns.hpp"

#include "base/parallel_tasks.hpp"
#include "families/arch_directions.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mean_point.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

constexpr int types_with_models = 14, teeth_of_jaw = 7;

/// Where the crown ends at the gum, around the axis: of each sector's outer points the lowest, for the cap is a
/// membrane that may hang lower amid the crown but not at its rim.
std::vector<Point> rim_of(const std::vector<Point>& points) {
  constexpr std::size_t sectors = 24;
  constexpr double outer_share = 0.7;
  const auto sector_of = [](const Point& p) {
    const double turns = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) + 0.5;
    return std::min(sectors - 1, static_cast<std::size_t>(turns * sectors));
  };
  std::array<double, sectors> radius{};
  for (const Point& p : points) radius[sector_of(p)] = std::max(radius[sector_of(p)], p.head<2>().norm());
  std::array<std::optional<Point>, sectors> lowest;
  for (const Point& p : points) {
    const std::size_t sector = sector_of(p);
    if (p.head<2>().norm() < outer_share * radius[sector]) continue;
    if (!lowest[sector] || p.z() < lowest[sector]->z()) lowest[sector] = p;
  }
  std::vector<Point> rim;
  for (const std::optional<Point>& p : lowest)
    if (p) rim.push_back(*p);
  return rim;
}

/// Height of the rim as a quadratic of the place around the axis.
JunctionHeight rim_height(const std::vector<Point>& points) {
  const std::vector<Point> rim = rim_of(points);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(rim.size()), 6);
  Eigen::VectorXd heights(rows.rows());
  JunctionHeight junction;
  junction.half_width.setZero();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const double x = rim[i].x(), y = rim[i].y();
    rows.row(static_cast<Eigen::Index>(i)) << 1, x, y, x * x, x * y, y * y;
    heights[static_cast<Eigen::Index>(i)] = rim[i].z();
    junction.half_width = junction.half_width.cwiseMax(rim[i].head<2>().cwiseAbs());
  }
  const Eigen::VectorXd fitted = rows.colPivHouseholderQr().solve(heights);
  std::copy(fitted.begin(), fitted.end(), junction.coefficients.begin());
  junction.coefficients[0] += ModelCrown::junction_above_rim_mm;
  return junction;
}

/// Rows: the axes of the tooth's frame in the model's, +z across the rim, +y towards the cheek.
Eigen::Matrix3d tooth_axes(const std::vector<Point>& points, const Eigen::Vector3d& up, const Eigen::Vector3d& buccal) {
  constexpr int rounds = 4;  // the rim is found around the axis, which is found from the rim
  Eigen::Vector3d z = up;
  Eigen::Matrix3d axes;
  for (int round = 0; round <= rounds; ++round) {
    axes.row(2) = z;
    axes.row(1) = (buccal - buccal.dot(z) * z).normalized();
    axes.row(0) = Eigen::Vector3d(axes.row(1)).cross(z);
    std::vector<Point> turned;
    for (const Point& p : points) turned.emplace_back(axes * p);
    const std::vector<Point> rim = rim_of(turned);
    Eigen::Vector3d across = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < rim.size(); ++i) across += rim[i].cross(rim[(i + 1) % rim.size()]);
    z = (axes.transpose() * across).normalized();
  }
  return axes;
}

/// Moves the crown so that its junction's middle is the origin, as in a whole tooth's frame.
void settle(SyntheticTooth& crown) {
  crown.junction = rim_height(crown.mesh.vertices);
  const double level = std::exchange(crown.junction.coefficients[0], 0.0);
  for (Point& p : crown.mesh.vertices) p.z() -= level;
  crown.crown_height = bounding_box(crown.mesh.vertices).max().z();
}

ModelCrown model_crown(const CrownShapeModel& model, int type, const Eigen::Vector3d& buccal) {
  const Point middle = mean_point(model.mean);
  ModelCrown crown;
  std::vector<Point> points;
  for (const Point& p : model.mean) points.emplace_back(p - middle);
  const Eigen::Matrix3d axes = tooth_axes(points, -find_cap(model, type < tooth_type_count / 2).direction, buccal);
  for (Point& p : points) p = axes * p;
  crown.mean.type = type;
  crown.mean.mesh = closed_surface(points);
  if (!diagnose(crown.mean.mesh).is_closed_solid())
    throw InputError("The points of the crown model of type " + std::to_string(type) + " give no closed surface.");
  for (const Eigen::MatrixX3d& mode : model.modes) crown.modes.emplace_back(mode * axes.transpose());
  crown.deviations = model.deviations;
  return crown;
}

}  // namespace

TriangleMesh closed_surface(const std::vector<Point>& points) {
  std::vector<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3> sites;
  for (const Point& p : points) sites.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> facets;
  CGAL::advancing_front_surface_reconstruction(sites.begin(), sites.end(), std::back_inserter(facets));
  TriangleMesh mesh;
  mesh.vertices = points;
  for (const auto& f : facets)
    mesh.triangles.push_back({static_cast<int>(f[0]), static_cast<int>(f[1]), static_cast<int>(f[2])});
  if (volume(mesh) < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

std::vector<ModelCrown> load_model_crowns(const std::filesystem::path& folder) {
  constexpr std::size_t all_modes = 40;
  std::vector<CrownShapeModel> models(2 * types_with_models);
  const auto type_of = [](std::size_t i) {
    const auto place = static_cast<int>(i / 2);
    return place < teeth_of_jaw ? place : place - teeth_of_jaw + tooth_type_count / 2;
  };
  parallel_tasks(models.size(), [&](std::size_t i) {
    const bool right_side = i % 2 == 1;
    models[i] = load_crown_shape_model(
        folder / ("crown_ssm_" + std::to_string(fdi_of_type(type_of(i), right_side)) + ".safetensors"), all_modes,
        right_side);
  });
  std::vector<ModelCrown> crowns(models.size());
  parallel_tasks(models.size(), [&](std::size_t i) {
    std::vector<Eigen::Vector3d> arch;  // of the same jaw and side, from the front to the back
    const std::size_t jaw = i / (2 * teeth_of_jaw);
    for (std::size_t k = 0; k < teeth_of_jaw; ++k)
      arch.push_back(mean_point(models[2 * (jaw * teeth_of_jaw + k) + i % 2].mean));
    crowns[i] = model_crown(models[i], type_of(i), buccal_direction(arch, (i / 2) % teeth_of_jaw));
  });
  return crowns;
}

SyntheticTooth draw_model_crown(const ModelCrown& crown, double factor, RandomStream& random) {
  SyntheticTooth tooth = crown.mean;
  for (std::size_t k = 0; k < crown.modes.size(); ++k) {
    const double coefficient = factor * random.normal(0.0, crown.deviations[k]);
    for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v)
      tooth.mesh.vertices[v] += coefficient * crown.modes[k].row(static_cast<Eigen::Index>(v)).transpose();
  }
  settle(tooth);
  return tooth;
}

}  // namespace rhizodont
