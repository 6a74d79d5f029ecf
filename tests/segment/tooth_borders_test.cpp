// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/tooth_borders.hpp"

#include "segment/sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rhizodont {
namespace {

constexpr int side = 41;

/// 20 mm x 20 mm with a groove along y at x = groove.
TriangleMesh grooved(double groove) {
  return test::sheet(side, side, [&](double s, double t) {
    const double x = 20 * s, y = 20 * t;
    return Point(x, y, -1.2 * std::exp(-(x - groove) * (x - groove)));
  });
}

/// A reading of it: tooth 0 left of `border`, tooth 1 right of it, less and less surely towards it.
TeethReading reading_of(const TriangleMesh& mesh) {
  TeethReading reading;
  reading.cloud = scan_points(mesh, reading.frame).cloud;
  reading.pyramid = scan_pyramid(reading.cloud, {});
  reading.said.kinds.assign(scan_kind_count * reading.size(), 0);
  return reading;
}

ToothInstances two_teeth(const TeethReading& reading, double border, double slope) {
  ToothInstances found;
  found.teeth.resize(2);
  for (std::size_t i = 0; i < reading.size(); ++i) {
    const double right = 1 / (1 + std::exp(-slope * (reading.place(i).x() - border)));
    found.shares.push_back(1 - right);
    found.shares.push_back(right);
  }
  return found;
}

double border_of(const TriangleMesh& mesh, const std::vector<int>& labels) {
  double left = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) left += labels[v] == 0 ? 1 : 0;
  return 20 * left / static_cast<double>(mesh.vertices.size());
}

TEST(ToothBorders, AreDrawnInTheGroove) {
  const TriangleMesh mesh = grooved(11);
  const TeethReading reading = reading_of(mesh);
  // The points say 10, not at all surely.
  const std::vector<int> labels = draw_borders(mesh, reading, two_teeth(reading, 10, 0.5));
  EXPECT_NEAR(border_of(mesh, labels), 11.2, 0.6);
  // Where they are sure, they are believed.
  EXPECT_NEAR(border_of(mesh, draw_borders(mesh, reading, two_teeth(reading, 6, 8))), 6.2, 0.6);
}

TEST(ToothBorders, SmoothOverSinglePoints) {
  const TriangleMesh mesh = grooved(50);
  const TeethReading reading = reading_of(mesh);
  ToothInstances found = two_teeth(reading, 10, 4);
  for (std::size_t i = 0; i < reading.size(); ++i)
    if ((reading.place(i) - Eigen::Vector3d(4, 4, 0)).norm() < 0.8)
      std::swap(found.shares[2 * i], found.shares[2 * i + 1]);
  ToothBorderOptions options;
  options.smoothness = 3;
  const std::vector<int> labels = draw_borders(mesh, reading, found, options);
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const double x = mesh.vertices[v].x();
    if (std::abs(x - 10) > 1.5) {
      EXPECT_EQ(labels[v], x < 10 ? 0 : 1);
    }
  }
}

TEST(ToothBorders, OnlyTheLargestPieceOfATooth) {
  const TriangleMesh mesh = grooved(50);
  std::vector<int> labels(mesh.vertices.size(), -1);
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (mesh.vertices[v].x() < 5) labels[v] = 0;
    if (mesh.vertices[v].x() > 19) labels[v] = 0;
  }
  keep_largest_pieces(mesh, labels);
  for (std::size_t v = 0; v < labels.size(); ++v) EXPECT_EQ(labels[v], mesh.vertices[v].x() < 5 ? 0 : -1);
}

}  // namespace
}  // namespace rhizodont
