// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Panoramas of shapes: B. Shi, S. Bai, Z. Zhou, X. Bai, "DeepPano: Deep panoramic representation for 3-D shape
// recognition", 2015. Rays and triangles: T. Moeller, B. Trumbore, "Fast, minimum storage ray-triangle intersection",
// 1997.
#include "completion/crown_panorama.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace rhizodont {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double lowest = CrownPanorama::lowest_elevation * pi / 180;
constexpr double row_step = (pi / 2 - lowest) / CrownPanorama::rows;
constexpr double column_step = 2 * pi / CrownPanorama::columns;
constexpr double unit_mm = 5;

double elevation_of(std::ptrdiff_t row) { return lowest + (static_cast<double>(row) + 0.5) * row_step; }
double azimuth_of(std::ptrdiff_t column) { return (static_cast<double>(column) + 0.5) * column_step; }

using Corners = std::array<Eigen::Vector3d, 3>;

/// How far from the origin a ray meets a triangle.
std::optional<double> meets(const Eigen::Vector3d& ray, const Corners& t) {
  const Eigen::Vector3d one = t[1] - t[0], two = t[2] - t[0], across = ray.cross(two);
  const double det = one.dot(across);
  if (std::abs(det) < 1e-12) return std::nullopt;
  const double u = -t[0].dot(across) / det;
  const Eigen::Vector3d other = (-t[0]).cross(one);
  const double v = ray.dot(other) / det;
  if (u < 0 || v < 0 || u + v > 1) return std::nullopt;
  const double distance = two.dot(other) / det;
  return distance > 0 ? std::optional(distance) : std::nullopt;
}

/// Elevations and azimuths between which a triangle is seen.
struct Window {
  double low = 0, high = 0, from = 0, width = 0;
};

Window window_of(const Corners& t) {
  std::array<double, 3> azimuth{}, elevation{};
  for (std::size_t i = 0; i < 3; ++i) {
    azimuth[i] = std::atan2(t[i].y(), t[i].x());
    elevation[i] = std::atan2(t[i].z(), std::hypot(t[i].x(), t[i].y()));
  }
  std::sort(azimuth.begin(), azimuth.end());
  const std::array<double, 3> gap{azimuth[1] - azimuth[0], azimuth[2] - azimuth[1], azimuth[0] + 2 * pi - azimuth[2]};
  const auto widest = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
  Window window{*std::min_element(elevation.begin(), elevation.end()),
                *std::max_element(elevation.begin(), elevation.end()), azimuth[(widest + 1) % 3], 2 * pi - gap[widest]};
  if (window.width >= 0.9 * pi) return {window.low > 0 ? window.low : -pi / 2, pi / 2, 0, 2 * pi};  // about the axis
  // Edges are great circles: between its ends one rises above them.
  const double bulge = std::cos(0.5 * window.width);
  if (window.high > 0) window.high = std::atan(std::tan(std::min(window.high, 1.57)) / bulge);
  if (window.low < 0) window.low = std::atan(std::tan(std::max(window.low, -1.57)) / bulge);
  return window;
}

}  // namespace

CrownPanorama crown_panorama(const TriangleMesh& crown, const Eigen::Vector3d& axis, const Point& centre) {
  constexpr auto rows = static_cast<std::ptrdiff_t>(CrownPanorama::rows);
  constexpr auto columns = static_cast<std::ptrdiff_t>(CrownPanorama::columns);
  constexpr std::size_t places = CrownPanorama::rows * CrownPanorama::columns;
  const Eigen::Matrix3d turn = panorama_view(axis);
  std::vector<Eigen::Vector3d> rays(places);
  for (std::ptrdiff_t r = 0; r < rows; ++r)
    for (std::ptrdiff_t c = 0; c < columns; ++c)
      rays[static_cast<std::size_t>(r * columns + c)] = {std::cos(elevation_of(r)) * std::cos(azimuth_of(c)),
                                                         std::cos(elevation_of(r)) * std::sin(azimuth_of(c)),
                                                         std::sin(elevation_of(r))};
  std::vector<double> distance(places, 0);
  std::vector<Eigen::Vector3d> normal(places, Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < crown.triangles.size(); ++t) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
      corners[i] = turn * (crown.vertices[static_cast<std::size_t>(crown.triangles[t][i])] - centre);
    const Window window = window_of(corners);
    const auto row_of = [](double elevation) { return (elevation - lowest) / row_step - 0.5; };
    const auto first = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::floor(row_of(window.low))));
    const auto last = std::min<std::ptrdiff_t>(rows - 1, static_cast<std::ptrdiff_t>(std::ceil(row_of(window.high))));
    const auto start = static_cast<std::ptrdiff_t>(std::floor(window.from / column_step - 0.5));
    const auto count =
        std::min<std::ptrdiff_t>(columns, 2 + static_cast<std::ptrdiff_t>(window.width / column_step) + 1);
    const Eigen::Vector3d direction = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (std::ptrdiff_t r = first; r <= last; ++r)
      for (std::ptrdiff_t k = 0; k < count; ++k) {
        const auto at = static_cast<std::size_t>(r * columns + (start + k + 2 * columns) % columns);
        const auto met = meets(rays[at], corners);
        if (!met || *met <= distance[at]) continue;
        distance[at] = *met;
        normal[at] = direction;
      }
  }
  CrownPanorama panorama;
  panorama.values.assign(CrownPanorama::channels * places, 0);
  for (std::ptrdiff_t r = 0; r < rows; ++r)
    for (std::ptrdiff_t c = 0; c < columns; ++c) {
      const auto at = static_cast<std::size_t>(r * columns + c);
      if (!(distance[at] > 0)) continue;
      const double e = elevation_of(r), a = azimuth_of(c);
      const Eigen::Vector3d around(-std::sin(a), std::cos(a), 0);
      const Eigen::Vector3d up(-std::sin(e) * std::cos(a), -std::sin(e) * std::sin(a), std::cos(e));
      const std::array<double, CrownPanorama::channels> here{distance[at] / unit_mm, 1, normal[at].dot(rays[at]),
                                                             normal[at].dot(around), normal[at].dot(up)};
      for (std::size_t channel = 0; channel < here.size(); ++channel)
        panorama.values[channel * places + at] = static_cast<float>(here[channel]);
    }
  return panorama;
}

Eigen::Matrix3d panorama_view(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
  Eigen::Matrix3d view;
  view << x.transpose(), y.transpose(), axis.transpose();
  return view;
}

Point panorama_centre(const TriangleMesh& open_crown, const Eigen::Vector3d& axis) {
  const EdgeTable edges = edge_table(open_crown);
  std::vector<int> border;  // half-edges
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.triangle_count(e) == 1) border.push_back(edges.half_edges[static_cast<std::size_t>(edges.first[e])]);
  std::sort(border.begin(),
            border.end());  // so that the numbers of the vertices have no say in how the sums are rounded
  double height = 0, length = 0;
  for (const int h : border) {
    const Triangle& t = open_crown.triangles[static_cast<std::size_t>(h / 3)];
    const Point& a = open_crown.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(h % 3)])];
    const Point& b = open_crown.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>((h + 1) % 3)])];
    const double l = (b - a).norm();
    height += l * axis.dot(0.5 * (a + b)), length += l;
  }
  if (!(length > 0)) throw InputError("The crown has no border: it is closed.");
  const Point centroid = area_centroid(open_crown);
  return centroid + (height / length - axis.dot(centroid)) * axis;
}

}  // namespace rhizodont
