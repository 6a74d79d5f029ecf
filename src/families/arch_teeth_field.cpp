// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_fields.hpp"
#include "families/wave_noise.hpp"
#include "mesh/closest_on_triangle.hpp"
#include "mesh/geometry.hpp"
#include "mesh/smooth_functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace rhizodont {
namespace {

/// A part of the lattice and the distances of one tooth on it.
struct Patch {
  std::array<int, 3> low{}, count{};
  std::vector<float> value;  ///< signed distance; not a number: not known yet

  std::size_t index(int x, int y, int z) const { return static_cast<std::size_t>((z * count[1] + y) * count[0] + x); }
};

Patch patch_around(const Lattice& lattice, const std::vector<Point>& points, double below, double around) {
  Eigen::AlignedBox3d box = bounding_box(points);
  box.min() -= Point(around, below, around);
  box.max() += Point(around, around, around);
  Patch patch;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const int last = lattice.count[axis] - 1;
    const int low = static_cast<int>(std::floor((box.min()[i] - lattice.origin[i]) / lattice.cell));
    const int high = static_cast<int>(std::ceil((box.max()[i] - lattice.origin[i]) / lattice.cell));
    patch.low[axis] = std::clamp(low, 0, last);
    patch.count[axis] = std::clamp(high, 0, last) - patch.low[axis] + 1;
  }
  patch.value.assign(static_cast<std::size_t>(patch.count[0] * patch.count[1] * patch.count[2]),
                     std::numeric_limits<float>::quiet_NaN());
  return patch;
}

/// Distances near the surface; the sign by the triangle that faces the point most of those at equal distance.
void splat(const Lattice& lattice, const TriangleMesh& mesh, Patch& patch) {
  constexpr double reach = 0.8;
  std::vector<float> facing(patch.value.size(), 0);
  std::array<int, 3> from{}, to{};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Point &pa = mesh.vertices[static_cast<std::size_t>(a)], &pb = mesh.vertices[static_cast<std::size_t>(b)],
                &pc = mesh.vertices[static_cast<std::size_t>(c)];
    const Eigen::Vector3d normal = triangle_normal(mesh, t);
    if (normal.isZero()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      const double low = std::min({pa[i], pb[i], pc[i]}) - reach, high = std::max({pa[i], pb[i], pc[i]}) + reach;
      from[axis] = std::max(0, static_cast<int>(std::ceil((low - lattice.origin[i]) / lattice.cell)) - patch.low[axis]);
      to[axis] = std::min(patch.count[axis] - 1,
                          static_cast<int>(std::floor((high - lattice.origin[i]) / lattice.cell)) - patch.low[axis]);
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x) {
          const Point p = lattice.at(x + patch.low[0], y + patch.low[1], z + patch.low[2]);
          const double height = normal.dot(p - pa);
          if (std::abs(height) > reach) continue;
          const std::size_t i = patch.index(x, y, z);
          const double so_far = std::isnan(patch.value[i]) ? reach : std::abs(static_cast<double>(patch.value[i]));
          if (std::abs(height) > so_far + 1e-6) continue;
          const OnTriangle near = closest_on_triangle(p, pa, pb, pc);
          const double distance = std::sqrt(near.squared_distance);
          if (distance > so_far + 1e-5) continue;
          const auto faces = static_cast<float>(distance > 0 ? height / distance : 1);
          if (distance > so_far - 1e-5 && std::abs(faces) <= std::abs(facing[i])) continue;
          facing[i] = faces;
          patch.value[i] = static_cast<float>(faces < 0 ? -distance : distance);
        }
  }
}

/// What is not near the surface has the sign of what is, before it in its row.
void fill_inside(Patch& patch) {
  for (int z = 0; z < patch.count[2]; ++z)
    for (int y = 0; y < patch.count[1]; ++y) {
      bool inside = false;
      for (int x = 0; x < patch.count[0]; ++x) {
        float& value = patch.value[patch.index(x, y, z)];
        if (std::isnan(value))
          value = inside ? -field_reach : field_reach;
        else
          inside = value < 0;
      }
    }
}

float soft_max(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0F) / width;
  return std::max(a, b) + 0.25F * h * h * width;
}

/// A box with rounded edges.
double box_distance(const Point& p, const Eigen::Vector3d& half, double round) {
  const Eigen::Vector3d q = p.cwiseAbs() - (half - Eigen::Vector3d::Constant(round));
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0) - round;
}

/// What happened to a crown in its life, in its own frame.
class CrownFate {
 public:
  CrownFate(const ArchCrown& crown, RandomStream& random)
      : crown_(crown), warp_(random, 3, 9), warp_mm_(random.uniform(0, 0.1)) {
    wear_tilt_ = Eigen::Vector2d(random.normal(0.0, 0.08), random.normal(0.0, 0.12));
    stump_loss_ = random.uniform(0.6, 1.3);
    stump_margin_ = random.uniform(-0.3, 1.2);
    stump_top_ = crown.height * random.uniform(0.55, 0.8);
    chip_ = random.chance(0.02);
    chip_at_ = Point(random.uniform(-0.5, 0.5) * crown.width, random.normal(0.0, 1.5), crown.height + 0.5);
    chip_radius_ = random.uniform(1.0, 2.2);
    place_plate(random);
  }

  float operator()(const Point& p, float distance) const {
    if (std::abs(distance) < field_reach) distance += static_cast<float>(warp_mm_ * warp_(p));
    if (crown_.stump) distance = stump(p, distance);
    if (crown_.wear_mm > 0) {
      const double plane = p.z() - (crown_.height - crown_.wear_mm) - wear_tilt_.dot(p.head<2>());
      distance = soft_max(distance, static_cast<float>(plane), 0.35F);
    }
    if (chip_) distance = soft_max(distance, static_cast<float>(chip_radius_ - (p - chip_at_).norm()), 0.3F);
    if (crown_.bracket || crown_.attachment) distance = std::min(distance, static_cast<float>(plate(p)));
    return std::clamp(distance, -field_reach, field_reach);
  }

 private:
  float stump(const Point& p, float distance) const {
    const auto [radius, height] = crown_.rim.at(std::atan2(p.y(), p.x()));
    const double loss =
        stump_loss_ * smooth_step((p.z() - height - stump_margin_) / 0.7) + 0.05 * std::max(0.0, p.z() - height);
    return soft_max(distance + static_cast<float>(loss), static_cast<float>(p.z() - stump_top_), 0.6F);
  }

  /// Onto the middle of the cheek side, or of the tongue's for some.
  void place_plate(RandomStream& random) {
    const double side = random.chance(crown_.bracket ? 0.05 : 0.02) ? -1 : 1;
    const double z = crown_.height * (crown_.bracket ? random.uniform(0.45, 0.6) : random.uniform(0.35, 0.7));
    const double x = crown_.bracket ? random.normal(0.0, 0.3) : random.uniform(-1.5, 1.5);
    Point best(x, 0, z);
    for (const Point& p : crown_.mesh.vertices)
      if (std::abs(p.z() - z) < 0.5 && std::abs(p.x() - x) < 0.6 && side * p.y() > side * best.y()) best = p;
    plate_at_ = best;
    plate_turn_ = random.normal(0.0, crown_.bracket ? 0.08 : 0.6);
    plate_half_ = crown_.bracket
                      ? Eigen::Vector3d(random.uniform(1.2, 1.9), random.uniform(0.8, 1.5), random.uniform(1.3, 2.0))
                      : Eigen::Vector3d(random.uniform(0.8, 2.0), random.uniform(0.4, 1.0), random.uniform(0.5, 1.3));
  }

  double plate(const Point& p) const {
    Point q = p - plate_at_;
    const double c = std::cos(plate_turn_), s = std::sin(plate_turn_);
    q = Point(c * q.x() - s * q.z(), q.y(), s * q.x() + c * q.z());
    const double body = box_distance(q, plate_half_, 0.3);
    if (!crown_.bracket) return body;
    // The slot for the wire, and wings above and below it.
    const Point outer(0, (plate_at_.y() > 0 ? 1 : -1) * plate_half_.y(), 0);
    return std::max(body, -box_distance(q - outer, {9, 0.45 * plate_half_.y(), 0.35}, 0.05));
  }

  const ArchCrown& crown_;
  WaveNoise warp_;
  double warp_mm_ = 0;
  Eigen::Vector2d wear_tilt_;
  double stump_loss_ = 0, stump_margin_ = 0, stump_top_ = 0;
  bool chip_ = false;
  Point chip_at_;
  double chip_radius_ = 1;
  Point plate_at_;
  Eigen::Vector3d plate_half_;
  double plate_turn_ = 0;
};

void add_tooth(const ArchCrown& crown, std::uint8_t number, RandomStream& random, ArchFields& fields) {
  const Lattice& lattice = fields.lattice;
  TriangleMesh mesh = crown.mesh;
  for (Point& p : mesh.vertices) p = crown.to_work * p;
  const double around = crown.bracket ? 2.8 : 1.2;
  Patch patch = patch_around(lattice, mesh.vertices, 4, around);
  splat(lattice, mesh, patch);
  fill_inside(patch);
  const CrownFate fate(crown, random);
  const Eigen::Isometry3d inverse = crown.to_work.inverse();
  for (int z = 0; z < patch.count[2]; ++z)
    for (int y = 0; y < patch.count[1]; ++y)
      for (int x = 0; x < patch.count[0]; ++x) {
        const int gx = x + patch.low[0], gy = y + patch.low[1], gz = z + patch.low[2];
        const Point p = inverse * lattice.at(gx, gy, gz);
        float value = fate(p, patch.value[patch.index(x, y, z)]);
        const auto [radius, height] = crown.rim.at(std::atan2(p.y(), p.x()));
        const double depth = height - p.z();
        // The root goes on below the rim, a little narrower as it goes.
        const double root = std::max(p.head<2>().norm() - (radius - 0.08) * (1 - 0.03 * std::max(0.0, depth)), -depth);
        value = std::clamp(std::min(value, static_cast<float>(root)), -field_reach, field_reach);
        const std::size_t i = lattice.index(gx, gy, gz);
        if (value < fields.tooth[i]) {
          fields.second[i] = fields.tooth[i];
          fields.tooth[i] = value;
          fields.owner[i] = number;
        } else {
          fields.second[i] = std::min(fields.second[i], value);
        }
      }
}

}  // namespace

Lattice lattice_around(const ArchCrowns& arch, double cell) {
  Eigen::AlignedBox3d box;
  for (const ArchCrown& crown : arch.crowns) {
    box.extend(Point(crown.to_work.translation()));
    for (const Point& p : crown.mesh.vertices) box.extend(Point(crown.to_work * p));
  }
  box.min() -= Point(8, 9, 10);
  box.max() += Point(8, 2, 7);
  box.min().y() = std::min(box.min().y(), arch.jaw == Jaw::upper ? -24.0 : -18.0);
  Lattice lattice;
  lattice.origin = box.min();
  lattice.cell = cell;
  for (std::size_t axis = 0; axis < 3; ++axis)
    lattice.count[axis] = static_cast<int>(std::ceil(box.sizes()[static_cast<Eigen::Index>(axis)] / cell)) + 1;
  return lattice;
}

void add_teeth(const ArchCrowns& arch, RandomStream& random, ArchFields& fields) {
  fields.tooth.assign(fields.lattice.size(), field_reach);
  fields.second = fields.tooth;
  fields.owner.assign(fields.lattice.size(), 255);
  for (std::size_t i = 0; i < arch.crowns.size(); ++i) {
    RandomStream own(random.bits(), i);
    if (!arch.crowns[i].ghost) add_tooth(arch.crowns[i], static_cast<std::uint8_t>(i), own, fields);
  }
}

}  // namespace rhizodont
