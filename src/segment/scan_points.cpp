// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/scan_points.hpp"

#include "mesh/geometry.hpp"
#include "networks/cloud_grid.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include <tbb/parallel_for.h>

namespace rhizodont {
namespace {

constexpr double spacing_mm = 0.5;

/// A small piece of surface.
struct Piece {
  std::array<std::int32_t, 3> cell;
  std::int32_t order;
  float area;
  Eigen::Vector3f place, normal;
  std::int32_t vertex;
};

void add_pieces(const TriangleMesh& scan, const std::vector<Eigen::Vector3d>& normals, const ScanFrame& frame,
                std::size_t triangle, std::vector<Piece>& pieces) {
  const double area = triangle_area(scan, triangle);
  if (!(area > 0)) return;
  const Triangle& t = scan.triangles[triangle];
  std::array<Point, 3> p, n;
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = frame.rotation * (scan.vertices[static_cast<std::size_t>(t[i])] - frame.origin);
    n[i] = frame.rotation * normals[static_cast<std::size_t>(t[i])];
  }
  for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, (p[i] - p[(i + 1) % 3]).norm());
  const int parts = std::clamp(static_cast<int>(std::ceil(longest / (0.8 * spacing_mm))), 1, 64);
  // Small triangles that are like the whole one, upright and upside down.
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j)
      for (const double third : {1.0 / 3, 2.0 / 3}) {
        if (third > 0.5 && i + j + 2 > parts) continue;
        const double a = (i + third) / parts, b = (j + third) / parts, c = 1 - a - b;
        const Point place = a * p[0] + b * p[1] + c * p[2];
        Piece piece{};
        for (Eigen::Index axis = 0; axis < 3; ++axis)
          piece.cell[static_cast<std::size_t>(2 - axis)] =
              static_cast<std::int32_t>(std::floor(std::clamp(place[axis] / spacing_mm, -1e9, 1e9)));
        piece.order = static_cast<std::int32_t>(pieces.size());
        piece.area = static_cast<float>(area / (parts * parts));
        piece.place = place.cast<float>();
        piece.normal = (a * n[0] + b * n[1] + c * n[2]).cast<float>();
        piece.vertex = t[a >= b && a >= c ? 0 : b >= c ? 1 : 2];
        pieces.push_back(piece);
      }
}

void append(std::vector<float>& values, const Eigen::Vector3f& v) { values.insert(values.end(), v.begin(), v.end()); }

/// The pieces of one cell as one point.
void add_point(const Piece* begin, const Piece* end, ScanPoints& points) {
  Eigen::Vector3f place = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  float area = 0;
  for (const Piece* p = begin; p != end; ++p) {
    place += p->area * p->place;
    normal += p->area * p->normal;
    area += p->area;
  }
  place /= area;
  if (!(normal.norm() > 1e-3F * area)) return;
  const Piece* nearest = std::min_element(begin, end, [&](const Piece& a, const Piece& b) {
    return (a.place - place).squaredNorm() < (b.place - place).squaredNorm();
  });
  append(points.cloud.positions, place);
  append(points.cloud.normals, normal.normalized());
  points.vertices.push_back(nearest->vertex);
}

Eigen::Vector3f float_vector_at(const std::vector<float>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void add_curvatures(ScanCloud& cloud) {
  constexpr std::array<float, scan_curvature_count> widths{1.0F, 2.2F};
  cloud.curvatures.assign(scan_curvature_count * cloud.size(), 0);
  const CloudGrid grid(cloud.positions, 1.1F);
  tbb::parallel_for(std::size_t{0}, cloud.size(), [&](std::size_t i) {
    const Eigen::Vector3f p = float_vector_at(cloud.positions, i), n = float_vector_at(cloud.normals, i);
    std::array<float, scan_curvature_count> sum{};
    std::array<int, scan_curvature_count> count{};
    grid.visit_near(p.data(), widths.back(), [&](std::int32_t j) {
      const auto k = static_cast<std::size_t>(j);
      const Eigen::Vector3f d = float_vector_at(cloud.positions, k) - p;
      if (n.dot(float_vector_at(cloud.normals, k)) < -0.3F) return;  // the other side of something thin
      const float distance = d.norm();
      for (std::size_t w = 0; w < widths.size(); ++w) {
        if (distance > widths[w]) continue;
        sum[w] += n.dot(d) / widths[w];
        ++count[w];
      }
    });
    for (std::size_t w = 0; w < widths.size(); ++w)
      cloud.curvatures[scan_curvature_count * i + w] =
          std::clamp(8 * sum[w] / static_cast<float>(std::max(count[w], 1)), -3.0F, 3.0F);
  });
}

/// The normal of the largest plane that a closed model stands on: the direction that most area faces.
Eigen::Vector3d facing_most(const TriangleMesh& scan) {
  constexpr int cells = 24;
  std::vector<Eigen::Vector3d> sums(6 * cells * cells, Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
    const Eigen::Vector3d a = triangle_area_vector(scan, t);
    Eigen::Index axis = 0;
    if (!(a.cwiseAbs().maxCoeff(&axis) > 0)) continue;
    const auto cell = [&](Eigen::Index other) {
      return std::clamp(static_cast<int>((a[other] / std::abs(a[axis]) + 1) / 2 * cells), 0, cells - 1);
    };
    const auto face = static_cast<int>(2 * axis + (a[axis] < 0));
    sums[static_cast<std::size_t>((face * cells + cell((axis + 1) % 3)) * cells + cell((axis + 2) % 3))] += a;
  }
  Eigen::Vector3d most = *std::max_element(
      sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  // The cells are the world's: all that faces the same way, whatever cells it is in, hangs little on how the scan lies.
  constexpr double alike = 0.97;  // cosine
  for (int round = 0; round < 3; ++round) {
    const Eigen::Vector3d direction = most.normalized();
    most = Eigen::Vector3d::Zero();
    for (std::size_t t = 0; t < scan.triangles.size(); ++t)
      if (const Eigen::Vector3d a = triangle_area_vector(scan, t); a.dot(direction) > alike * a.norm()) most += a;
  }
  return most;
}

}  // namespace

ScanPoints scan_points(const TriangleMesh& scan, const ScanFrame& frame) {
  const std::vector<Eigen::Vector3d> normals = vertex_normals(scan);
  std::vector<Piece> pieces;
  for (std::size_t t = 0; t < scan.triangles.size(); ++t) add_pieces(scan, normals, frame, t, pieces);
  if (pieces.empty()) throw InputError("The scan has no surface.");
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return std::tie(a.cell, a.order) < std::tie(b.cell, b.order); });
  ScanPoints points;
  for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
    while (end < pieces.size() && pieces[end].cell == pieces[begin].cell) ++end;
    add_point(pieces.data() + begin, pieces.data() + end, points);
  }
  if (points.cloud.size() == 0)
    throw InputError("The scan has no side: each place of its surface is there twice, facing both ways.");
  add_curvatures(points.cloud);
  return points;
}

Eigen::Matrix3d rotation_to(const Eigen::Vector3d& up, const Eigen::Vector3d& front) {
  Eigen::Vector3d y = front - up.dot(front) * up;
  if (!(y.norm() > 1e-3)) y = up.unitOrthogonal();
  y.normalize();
  Eigen::Matrix3d rotation;
  rotation << y.cross(up).transpose(), y.transpose(), up.transpose();
  return rotation;
}

void move_origin_to_mean(ScanFrame& frame, ScanCloud& cloud) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < cloud.size(); ++i) mean += vector_at(cloud.positions, i);
  mean /= static_cast<double>(cloud.size());
  frame.origin += frame.rotation.transpose() * mean;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    cloud.positions[i] -= static_cast<float>(mean[static_cast<Eigen::Index>(i % 3)]);
}

ScanFrame first_frame(const TriangleMesh& scan) {
  const double area = surface_area(scan);
  if (!(area > 0)) throw InputError("The scan has no surface.");
  constexpr double least_open = 0.1;  // of the area: a scan of gum and teeth faces one way with about half of it
  Eigen::Vector3d up = area_vector(scan);
  if (up.norm() < least_open * area) up = -facing_most(scan);
  ScanFrame frame;
  frame.origin = area_centroid(scan);
  const Eigen::Vector3d z = up.normalized();
  double farthest = -1;
  Eigen::Vector3d front = Eigen::Vector3d::Zero();
  for (const Point& p : scan.vertices) {
    const Eigen::Vector3d d = p - frame.origin;
    if (const double level = (d - z.dot(d) * z).norm(); level > farthest) {
      farthest = level;
      front = d;
    }
  }
  frame.rotation = rotation_to(z, front);
  return frame;
}

}  // namespace rhizodont
