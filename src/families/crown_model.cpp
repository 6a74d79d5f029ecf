// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Statistical crown models on whole teeth.
// Rigid part: iterative closest points, point to plane (Y. Chen, G. Medioni, "Object modelling by registration of
// multiple range images", 1992). Non-rigid part and the modes: Gaussian process regression on inducing points (after
// M. Luethi, T. Gerig, C. Jud, T. Vetter, "Gaussian process morphable models", 2018).
#include "families/crown_model.hpp"

#include "families/tooth_family.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/sampling.hpp"
#include "mesh/smooth_functions.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace rhizodont {
namespace {

std::vector<float> floats(const TensorFile& file, const std::string& name, std::size_t dimensions,
                          const std::filesystem::path& path) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end() || found->second.shape.size() != dimensions)
    throw InputError("The crown model " + path.string() + " has no fitting tensor '" + name + "'.");
  return load_floats(found->second);
}

// The template's crown and neck, as targets for closest points.
struct CrownSurface {
  std::vector<int> vertex;  ///< into the template
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;
};

CrownSurface crown_surface(const FamilyTemplate& tooth) {
  CrownSurface surface;
  const auto normals = vertex_normals(tooth.mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Point& p = tooth.mesh.vertices[v];
    if (p.z() < tooth.junction(p.x(), p.y()) - 2.0) continue;
    surface.vertex.push_back(static_cast<int>(v));
    surface.points.push_back(p);
    surface.normals.push_back(normals[v]);
  }
  return surface;
}

struct Affine {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double agreement = 0;  // mean weight of the pairs in the end, 0..1
};

// Robust weight of a pair: 1 when close, 0 beyond `reach`; pairs whose normals disagree do not count.
double pair_weight(double distance, double reach, double cosine) {
  if (distance >= reach || std::abs(cosine) < 0.5) return 0;
  const double t = 1 - distance * distance / (reach * reach);
  return t * t;
}

// Point to plane, with a scale for each axis of the template's frame that is held near a common one.
Affine fit_axes(const std::vector<Point>& points, const std::vector<Eigen::Vector3d>& normals,
                const CrownSurface& surface, const NearestVertexIndex& index, Affine map) {
  constexpr int rounds = 30;
  // Flat crowns could be turned far at little cost; a turn of 0.3 rad has to pay for itself.
  constexpr double turn_cost = 0.15;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  for (int round = 0; round < rounds; ++round) {
    const double reach = 3.0 * std::pow(1.0 / 3.0, round / (rounds - 1.0));
    Eigen::Matrix<double, 9, 9> normal_matrix = Eigen::Matrix<double, 9, 9>::Zero();
    Eigen::Matrix<double, 9, 1> right_side = Eigen::Matrix<double, 9, 1>::Zero();
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point x = map.linear * points[i] + map.shift;
      const NearVertex near = index.nearest(x);
      const auto at = static_cast<std::size_t>(near.index);
      const Eigen::Vector3d& n = surface.normals[at];
      const double w =
          pair_weight(std::sqrt(near.squared_distance), reach, n.dot((map.linear * normals[i]).normalized()));
      if (w == 0) continue;
      Eigen::Matrix<double, 9, 1> row;
      row << x.cross(n), n, x.cwiseProduct(n);
      normal_matrix += w * row * row.transpose();
      right_side += w * n.dot(surface.points[at] - x) * row;
      total += w;
    }
    if (total < 0.05 * static_cast<double>(points.size())) return map;
    map.agreement = total / static_cast<double>(points.size());
    const Eigen::Matrix3d spread = Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Constant(1.0 / 3);
    normal_matrix.bottomRightCorner<3, 3>() += 2.0 * total * spread;
    normal_matrix.diagonal().array() += 1e-6 * total;
    const Eigen::AngleAxisd so_far(turned);
    normal_matrix.topLeftCorner<3, 3>().diagonal().array() += turn_cost * total;
    right_side.head<3>() -= turn_cost * total * so_far.angle() * so_far.axis();
    const Eigen::Matrix<double, 9, 1> step = normal_matrix.ldlt().solve(right_side);
    const double angle = step.head<3>().norm();
    const Eigen::Matrix3d turn =
        angle > 0 ? Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d grow = (Eigen::Vector3d::Ones() + step.tail<3>()).asDiagonal();
    turned = turn * turned;
    map.linear = grow * turn * map.linear;
    map.shift = grow * turn * map.shift + step.segment<3>(3);
  }
  return map;
}

// Arches differ in how teeth are turned in them; what agrees best wins.
Affine fit_from_several_turns(const std::vector<Point>& points, const std::vector<Eigen::Vector3d>& normals,
                              const CrownSurface& surface, const Affine& start) {
  const NearestVertexIndex index(surface.points);
  std::vector<Point> few;
  std::vector<Eigen::Vector3d> few_normals;
  for (std::size_t i = 0; i < points.size(); i += 3) few.push_back(points[i]), few_normals.push_back(normals[i]);
  Affine best;
  for (int i = -1; i <= 1; ++i) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.35 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Affine turned;
    turned.linear = turn * start.linear;
    Point middle = Point::Zero();
    for (const Point& p : points) middle += p / static_cast<double>(points.size());
    turned.shift = start.linear * middle + start.shift - turned.linear * middle;
    const Affine found = fit_axes(few, few_normals, surface, index, turned);
    if (found.agreement > best.agreement) best = found;
  }
  if (best.agreement < 0.2) throw NoResultError("A crown model does not come to lie on its template.");
  return best;
}

// Smooth regression of displacements given at points: an affine trend and a Gaussian process with a Matern 3/2 kernel.
class SmoothField {
 public:
  SmoothField(const std::vector<Point>& centres, const std::vector<Point>& data, double length, double noise)
      : cross_(kernel(centres, data, length)), trend_data_(trend(data)), trend_solver_(trend_data_) {
    Eigen::MatrixXd system = noise * kernel(centres, centres, length);
    system.selfadjointView<Eigen::Lower>().rankUpdate(cross_.transpose());
    system_.compute(system);
  }

  /// Values: one row per datum, any number of columns. Result: coefficients, centres first, then the trend's four.
  Eigen::MatrixXd fit(const Eigen::MatrixXd& values) const {
    Eigen::MatrixXd result(cross_.cols() + 4, values.cols());
    result.bottomRows(4) = trend_solver_.solve(values);
    result.topRows(cross_.cols()) = system_.solve(cross_.transpose() * (values - trend_data_ * result.bottomRows(4)));
    return result;
  }

  /// What to multiply the coefficients by to get the field at points.
  static Eigen::MatrixXd basis(const std::vector<Point>& centres, const std::vector<Point>& points, double length) {
    const auto count = static_cast<Eigen::Index>(centres.size());
    Eigen::MatrixXd result(static_cast<Eigen::Index>(points.size()), count + 4);
    result.leftCols(count) = kernel(centres, points, length);
    result.rightCols(4) = trend(points);
    return result;
  }

 private:
  static Eigen::MatrixXd kernel(const std::vector<Point>& centres, const std::vector<Point>& points, double length) {
    Eigen::MatrixXd k(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(centres.size()));
    for (std::size_t j = 0; j < centres.size(); ++j) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double r = std::sqrt(3.0) * (points[i] - centres[j]).norm() / length;
        k(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (1 + r) * std::exp(-r);
      }
    }
    return k;
  }

  static Eigen::MatrixXd trend(const std::vector<Point>& points) {
    Eigen::MatrixXd t(static_cast<Eigen::Index>(points.size()), 4);
    for (std::size_t i = 0; i < points.size(); ++i) t.row(static_cast<Eigen::Index>(i)) << 1, points[i].transpose();
    return t;
  }

  Eigen::MatrixXd cross_, trend_data_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> trend_solver_;
  Eigen::LDLT<Eigen::MatrixXd> system_;
};

std::vector<Point> spread_centres(const std::vector<Point>& points, std::size_t count) {
  std::vector<Point> centres;
  for (int i : farthest_point_sampling(points, std::min(count, points.size())))
    centres.push_back(points[static_cast<std::size_t>(i)]);
  return centres;
}

// Where the field is read for a vertex: on the crown in place, below the neck straight above, at the neck. The root's
// lower half stays where it is.
struct Carrier {
  std::size_t vertex_count = 0;
  std::vector<std::size_t> vertex;
  std::vector<Point> points;
  std::vector<double> across, along;  ///< strength of the displacement across the axis and along it, 0..1
};

Carrier carrier_of(const FamilyTemplate& tooth, double neck) {
  Carrier carrier;
  carrier.vertex_count = tooth.mesh.vertices.size();
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v) {
    const Point& p = tooth.mesh.vertices[v];
    const double h = p.z() - tooth.junction(p.x(), p.y());
    const double across = 1 - smooth_step((neck - h) / 8.0);
    if (across <= 0) continue;
    carrier.vertex.push_back(v);
    carrier.points.emplace_back(p.x(), p.y(), p.z() + neck + soft_plus(h - neck, 0.5) - h);
    carrier.across.push_back(across);
    carrier.along.push_back(1 - smooth_step((neck - h) / 4.0));
  }
  return carrier;
}

Eigen::VectorXf as_displacement(const Eigen::MatrixXd& field, const Carrier& carrier) {
  Eigen::VectorXf result = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(3 * carrier.vertex_count));
  for (std::size_t i = 0; i < carrier.vertex.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i), at = static_cast<Eigen::Index>(3 * carrier.vertex[i]);
    result[at] = static_cast<float>(field(row, 0) * carrier.across[i]);
    result[at + 1] = static_cast<float>(field(row, 1) * carrier.across[i]);
    result[at + 2] = static_cast<float>(field(row, 2) * carrier.along[i]);
  }
  return result;
}

// Pairs of a place on the template and the displacement that brings it to the model's surface.
struct Correspondence {
  std::vector<Point> place;
  std::vector<std::size_t> datum;
  Eigen::MatrixXd displacement;
  double mean_distance = 0;
};

Correspondence correspond(const std::vector<Point>& data, const std::vector<Eigen::Vector3d>& data_normals,
                          const CrownSurface& rest, const TriangleMesh& moved, double reach) {
  const auto normals = vertex_normals(moved);
  std::vector<Point> points;
  for (int v : rest.vertex) points.push_back(moved.vertices[static_cast<std::size_t>(v)]);
  const NearestVertexIndex index(points);
  Correspondence pairs;
  std::vector<Eigen::Vector3d> displacement;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const NearVertex near = index.nearest(data[i]);
    const auto at = static_cast<std::size_t>(near.index);
    const Eigen::Vector3d& n = normals[static_cast<std::size_t>(rest.vertex[at])];
    if (near.squared_distance > reach * reach || std::abs(n.dot(data_normals[i])) < 0.7) continue;
    const double over = n.dot(data[i] - points[at]);
    if (over < -0.35 * reach) continue;  // inside the tooth: what is left of the cap
    // Beside the vertex in its tangent plane: only the distance along the normal is to be made up for.
    const Eigen::Vector3d beside = data[i] - over * n - points[at];
    pairs.place.push_back(rest.points[at] + beside);
    pairs.datum.push_back(i);
    displacement.emplace_back(data[i] - pairs.place.back());
    pairs.mean_distance += std::abs(over);
  }
  pairs.mean_distance /= std::max(1.0, static_cast<double>(pairs.place.size()));
  pairs.displacement.resize(static_cast<Eigen::Index>(displacement.size()), 3);
  for (std::size_t i = 0; i < displacement.size(); ++i)
    pairs.displacement.row(static_cast<Eigen::Index>(i)) = displacement[i].transpose();
  return pairs;
}

double neck_height(const FamilyTemplate& tooth, const std::vector<Point>& data) {
  std::vector<double> heights;
  for (const Point& p : data) heights.push_back(p.z() - tooth.junction(p.x(), p.y()));
  std::sort(heights.begin(), heights.end());
  return std::clamp(heights[heights.size() / 12], -0.5, 1.5);
}

}  // namespace

CrownShapeModel load_crown_shape_model(const std::filesystem::path& file, std::size_t mode_count, bool right_side) {
  const TensorFile tensors = read_safetensors(file);
  const std::vector<float> mean = floats(tensors, "mean", 2, file), normals = floats(tensors, "mean_normals", 2, file);
  const std::vector<float> modes = floats(tensors, "modes", 3, file), variances = floats(tensors, "variances", 1, file);
  const std::size_t count = mean.size() / 3;
  if (count < 100 || mean.size() != 3 * count || normals.size() != mean.size() ||
      modes.size() != variances.size() * mean.size())
    throw InputError("The tensors of the crown model " + file.string() + " do not fit together.");
  const Eigen::Vector3d mirror(right_side ? -1 : 1, 1, 1);
  const auto read = [&](const std::vector<float>& values, std::size_t at) {
    const Eigen::Vector3d p(values[at], values[at + 1], values[at + 2]);
    if (!p.allFinite()) throw InputError("The crown model " + file.string() + " has a value that is not a number.");
    return Eigen::Vector3d(p.cwiseProduct(mirror));
  };
  CrownShapeModel model;
  for (std::size_t i = 0; i < count; ++i) {
    model.mean.push_back(read(mean, 3 * i));
    model.normals.push_back(read(normals, 3 * i));
  }
  for (std::size_t k = 0; k < std::min(mode_count, variances.size()); ++k) {
    Eigen::MatrixX3d mode(static_cast<Eigen::Index>(count), 3);
    for (std::size_t i = 0; i < count; ++i)
      mode.row(static_cast<Eigen::Index>(i)) = read(modes, 3 * (k * count + i)).transpose();
    model.modes.push_back(std::move(mode));
    model.deviations.push_back(std::sqrt(std::max(0.0F, variances[k])));
  }
  return model;
}

CrownCap find_cap(const CrownShapeModel& model, bool upper) {
  const Eigen::Vector3d down = upper ? Eigen::Vector3d::UnitY() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  const std::size_t count = model.mean.size();
  Point centre = Point::Zero();
  for (const Point& p : model.mean) centre += p / static_cast<double>(count);
  std::vector<Eigen::Vector3d> outward(model.normals);
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < count; ++i) {
    if (outward[i].dot(model.mean[i] - centre) < 0) outward[i] = -outward[i];
    if (outward[i].dot(down) > 0.4) candidates.push_back(i);
  }
  const auto on_plane = [&](std::size_t seed, std::size_t i) {
    return std::abs(outward[seed].dot(model.mean[i] - model.mean[seed])) < 0.3 && outward[seed].dot(outward[i]) > 0.85;
  };
  std::size_t best = 0, most = 0;
  for (std::size_t seed : candidates) {
    const auto agree = static_cast<std::size_t>(
        std::count_if(candidates.begin(), candidates.end(), [&](std::size_t i) { return on_plane(seed, i); }));
    if (agree > most) best = seed, most = agree;
  }
  if (most < 20) throw NoResultError("A crown model has no flat cap at the gum.");
  CrownCap cap;
  double height = 0;
  for (std::size_t i : candidates)
    if (on_plane(best, i)) cap.direction += outward[i], height += 1;
  cap.direction.normalize();
  double level = 0;
  for (std::size_t i : candidates)
    if (on_plane(best, i)) level += cap.direction.dot(model.mean[i]) / height;
  for (std::size_t i = 0; i < count; ++i) {
    const double above = level - cap.direction.dot(model.mean[i]);
    cap.is_cap.push_back(above < 0.15 || outward[i].dot(cap.direction) > 0.3);
  }
  return cap;
}

CrownModes carry_crown_model(const FamilyTemplate& tooth, const CrownShapeModel& model, const Eigen::Vector3d& buccal,
                             bool upper) {
  const CrownCap cap = find_cap(model, upper);
  const Eigen::Vector3d z = -cap.direction, y = (buccal - buccal.dot(z) * z).normalized();
  Affine map;
  map.linear.row(0) = y.cross(z);
  map.linear.row(1) = y;
  map.linear.row(2) = z;
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::size_t> source;
  for (std::size_t i = 0; i < model.mean.size(); ++i) {
    if (cap.is_cap[i]) continue;
    points.push_back(model.mean[i]);
    normals.push_back(model.normals[i]);
    source.push_back(i);
  }
  const CrownSurface surface = crown_surface(tooth);
  // Tops together, and middles across the axis.
  Eigen::AlignedBox3d from, to;
  for (const Point& p : points) from.extend(Point(map.linear * p));
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    if (tooth.crown[static_cast<std::size_t>(surface.vertex[i])] == 1) to.extend(surface.points[i]);
  const double size = (to.sizes().x() + to.sizes().y()) / (from.sizes().x() + from.sizes().y());
  map.linear *= size;
  map.shift = to.center() - size * from.center();
  map.shift.z() = to.max().z() - size * from.max().z();
  map = fit_from_several_turns(points, normals, surface, map);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = map.linear * points[i] + map.shift;
    normals[i] = (map.linear.inverse().transpose() * normals[i]).normalized();
  }

  constexpr double length = 3.5, noise = 0.08;
  const std::vector<Point> centres = spread_centres(surface.points, 150);
  const Carrier carrier = carrier_of(tooth, neck_height(tooth, points));
  const Eigen::MatrixXd basis = SmoothField::basis(centres, carrier.points, length);
  TriangleMesh moved = tooth.mesh;
  CrownModes carried;
  constexpr int rounds = 5;
  for (int round = 0;; ++round) {
    const Correspondence pairs = correspond(points, normals, surface, moved, round < 3 ? 2.0 : 1.2);
    if (pairs.place.size() < points.size() / 3)
      throw NoResultError("A crown model does not come to lie on its template.");
    carried.residual_mm = pairs.mean_distance;
    const SmoothField field(centres, pairs.place, length, noise);
    if (round < rounds) {
      carried.mean_shift = as_displacement(basis * field.fit(pairs.displacement), carrier);
      for (std::size_t v = 0; v < moved.vertices.size(); ++v)
        moved.vertices[v] =
            tooth.mesh.vertices[v] + carried.mean_shift.segment<3>(static_cast<Eigen::Index>(3 * v)).cast<double>();
      continue;
    }
    const auto count = static_cast<Eigen::Index>(pairs.place.size());
    const auto mode_count = static_cast<Eigen::Index>(model.modes.size());
    Eigen::MatrixXd values(count, 3 * mode_count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto row = static_cast<Eigen::Index>(source[pairs.datum[static_cast<std::size_t>(i)]]);
      for (Eigen::Index k = 0; k < mode_count; ++k)
        values.block<1, 3>(i, 3 * k) =
            (map.linear * model.modes[static_cast<std::size_t>(k)].row(row).transpose()).transpose();
    }
    const Eigen::MatrixXd fields = basis * field.fit(values);
    carried.modes.resize(carried.mean_shift.size(), mode_count);
    for (Eigen::Index k = 0; k < mode_count; ++k)
      carried.modes.col(k) = as_displacement(fields.middleCols<3>(3 * k), carrier);
    carried.deviations = model.deviations;
    return carried;
  }
}

}  // namespace rhizodont
