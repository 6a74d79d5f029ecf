// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crown_fit.hpp"

#include "completion/mean_crowns.hpp"
#include "completion/registration.hpp"
#include "families/crown_crop.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "training/completion_sample.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

struct Surface {
  std::vector<std::size_t> vertex;  // of the template, crown and neck
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;
};

Surface crown_part(const FamilyTemplate& tooth, const TriangleMesh& mesh) {
  Surface surface;
  const auto normals = vertex_normals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Point& rest = tooth.mesh.vertices[v];
    if (rest.z() < tooth.junction(rest.x(), rest.y()) - 2) continue;
    surface.vertex.push_back(v);
    surface.points.push_back(mesh.vertices[v]);
    surface.normals.push_back(normals[v]);
  }
  return surface;
}

const CrownModes* own_modes(const ToothFamilies& families, int type) {
  for (const FamilyCrownModel& model : families.crown_models)
    if (model.type == type && model.from == type) return &model.modes;
  return nullptr;
}

}  // namespace

CrownPoints pose_crown(const ToothFamilies& families, const Atlas& atlas, const TriangleMesh& crown, int fdi) {
  const int type = tooth_type_of_fdi(fdi);
  const auto t = static_cast<std::size_t>(type);
  const Eigen::Vector3d up(0, type < 8 ? -1 : 1, 0);
  const SurfaceSamples samples = sample_surface(crown, 1500, 3);
  OrientedPoints oriented;
  oriented.points = samples.points;
  oriented.normals = samples.normals;
  const RigidFit fit = fit_mean_crown(oriented, atlas.types[t], is_right_side(fdi), false, up);
  // From the mean crown's canonical pose to the mean tooth's millimetres, and from there to its template's.
  const SyntheticTooth mean = mean_tooth(families, type);
  GumLine junction;
  junction.offset_mm = 0.2;
  const auto crop = crop_crown(mean, junction);
  if (!crop) throw NoResultError("The mean crown is not in one piece.");
  const CanonicalFrame frame = frame_of_crop(*crop, -mean.crown_turn);
  const FamilyTemplate& tooth = families.templates[t];
  Eigen::AlignedBox3d enamel;
  for (std::size_t v = 0; v < mean.crown.size(); ++v)
    if (mean.crown[v] == 1) enamel.extend(mean.mesh.vertices[v]);
  const Eigen::Vector3d shrink(tooth.crown_width.x() / enamel.sizes().x(), tooth.crown_width.y() / enamel.sizes().y(),
                               tooth.crown_height / mean.crown_height);
  CrownPoints posed;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Eigen::Vector3d n = frame.direction_to_world(fit.frame.direction_to_canonical(samples.normals[i]));
    if (n.z() < -0.3) continue;  // the cap
    posed.points.emplace_back(
        frame.to_world(fit.frame.to_canonical(samples.points[i])).cwiseProduct(shrink.mean() * Point::Ones()));
    posed.normals.push_back(n);
  }
  return posed;
}

double fit_crown(const ToothFamilies& families, int type, const CrownPoints& crown, const CrownFitFreedom& freedom) {
  const FamilyTemplate& tooth = families.templates[static_cast<std::size_t>(type)];
  const CrownModes* model = freedom.modes ? own_modes(families, type) : nullptr;
  const Eigen::Index modes = model == nullptr ? 0 : model->modes.cols();
  std::vector<Point> points = crown.points;
  std::vector<Eigen::Vector3d> normals = crown.normals;
  Eigen::VectorXd coefficients = Eigen::VectorXd::Zero(modes);
  TriangleMesh mesh = tooth.mesh;
  double size = 1, mean = 0;
  constexpr int rounds = 40;
  for (int round = 0; round <= rounds; ++round) {
    const Surface surface = crown_part(tooth, mesh);
    const NearestVertexIndex index(surface.points);
    const double reach = std::max(1.0, 2.5 - 0.1 * round);
    const Eigen::Index unknowns = 9 + modes;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns), row(unknowns);
    double total = 0, sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const NearVertex near = index.nearest(points[i]);
      const auto at = static_cast<std::size_t>(near.index);
      const Eigen::Vector3d& n = surface.normals[at];
      const double distance = std::sqrt(near.squared_distance), over = n.dot(points[i] - surface.points[at]);
      // Beside a vertex but within its facet, the distance is that from the tangent plane.
      sum += std::min(distance < 0.5 ? std::abs(over) : distance, 1.5);
      if (distance > reach || n.dot(normals[i]) < 0.5) continue;
      row.head<3>() = points[i].cross(n);
      row.segment<3>(3) = n;
      row.segment<3>(6) = points[i].cwiseProduct(n);
      for (Eigen::Index k = 0; k < modes; ++k)
        row[9 + k] =
            -n.dot(model->modes.col(k).segment<3>(static_cast<Eigen::Index>(3 * surface.vertex[at])).cast<double>());
      matrix += row * row.transpose();
      right -= over * row;
      total += 1;
    }
    mean = sum / static_cast<double>(points.size()) / size;
    if (round == rounds) break;
    const Eigen::Matrix3d spread = Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3);
    matrix.block<3, 3>(6, 6) += (freedom.three_scales ? 0.5 : 1e6) * total * spread;
    matrix.diagonal().array() += 1e-6 * total;
    for (Eigen::Index k = 0; k < modes; ++k) {
      const double held = 0.02 / std::pow(model->deviations[static_cast<std::size_t>(k)], 2) * total / 100;
      matrix(9 + k, 9 + k) += held;
      right[9 + k] -= held * coefficients[k];
    }
    const Eigen::VectorXd step = matrix.ldlt().solve(right);
    const double angle = step.head<3>().norm();
    const Eigen::Matrix3d turn =
        angle > 0 ? Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
    const Eigen::Vector3d grow = Eigen::Vector3d::Ones() + step.segment<3>(6);
    size *= std::cbrt(grow.prod());
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = grow.cwiseProduct(turn * points[i]) + step.segment<3>(3);
      normals[i] = (turn * normals[i]).cwiseQuotient(grow).normalized();
    }
    if (modes == 0) continue;
    coefficients += step.tail(modes);
    const Eigen::VectorXf moved = model->modes * coefficients.cast<float>();
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      mesh.vertices[v] = tooth.mesh.vertices[v] + moved.segment<3>(static_cast<Eigen::Index>(3 * v)).cast<double>();
  }
  return mean;
}

}  // namespace rhizodont
