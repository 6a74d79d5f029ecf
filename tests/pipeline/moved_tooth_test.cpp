// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/moved_tooth.hpp"

#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

const TriangleMesh& scanned() {
  static const TriangleMesh loaded = test::sample("crown_34.ply");
  return loaded;
}

const CompletedTooth& finished() {
  static const CompletedTooth made = complete_tooth(scanned(), test::models(), test::for_tooth(34));
  return made;
}

/// All new vertices farther down than 3 mm below the crown, moved along the growth axis.
std::vector<Point> with_root_longer(double mm) {
  const Eigen::Vector3d axis = finished().record.frame.growth_axis;
  double lowest = 1e9;
  for (const Point& p : scanned().vertices) lowest = std::min(lowest, p.dot(axis));
  std::vector<Point> vertices = finished().mesh.vertices;
  for (Point& p : vertices)
    if (const double depth = lowest - p.dot(axis); depth > 3) p -= mm * std::min(1.0, (depth - 3) / 4) * axis;
  return vertices;
}

TEST(MovedTooth, InTheSamePlacesIsTheSameTooth) {
  const CompletedTooth same = moved_tooth(scanned(), finished(), finished().mesh.vertices);
  EXPECT_EQ(same.mesh.vertices, finished().mesh.vertices);
  EXPECT_EQ(same.record.root.length_mm, finished().record.root.length_mm);
  EXPECT_EQ(same.record.promises.new_triangles.all->theta_min, finished().record.promises.new_triangles.all->theta_min);
  EXPECT_EQ(same.record.missed_places.size(), finished().record.missed_places.size());
}

TEST(MovedTooth, IsCheckedAndMeasuredAnew) {
  const CompletedTooth longer = moved_tooth(scanned(), finished(), with_root_longer(0.75));
  EXPECT_NEAR(longer.record.root.length_mm, finished().record.root.length_mm + 0.75, 1e-4);
  EXPECT_NEAR(longer.record.root.tooth_length_mm, finished().record.root.tooth_length_mm + 0.75, 1e-4);
  EXPECT_NEAR(longer.record.root.interval->length_low_mm, finished().record.root.interval->length_low_mm + 0.75, 1e-4);
  EXPECT_NEAR(longer.record.root.interval->length_high_mm, finished().record.root.interval->length_high_mm + 0.75,
              1e-4);
  EXPECT_GT(longer.record.promises.solid.volume, finished().record.promises.solid.volume);
  CheckOptions exact;
  exact.compare_as_float = false;
  EXPECT_TRUE(check(scanned(), longer.mesh, exact).holds());
}

TEST(MovedTooth, TheCrownStaysWhateverIsSaidOfIt) {
  std::vector<Point> vertices = finished().mesh.vertices;
  for (std::size_t v = 0; v < scanned().vertices.size(); ++v) vertices[v] += Point(1, 2, 3);
  EXPECT_EQ(moved_tooth(scanned(), finished(), vertices).mesh.vertices, finished().mesh.vertices);
}

TEST(MovedTooth, RefusesWhatIsNoSolid) {
  const Eigen::Vector3d axis = finished().record.frame.growth_axis;
  std::vector<Point> vertices = finished().mesh.vertices;
  auto deepest = std::min_element(vertices.begin(), vertices.end(),
                                  [&](const Point& a, const Point& b) { return a.dot(axis) < b.dot(axis); });
  *deepest += 40 * axis;  // out through the crown
  EXPECT_THROW(moved_tooth(scanned(), finished(), vertices), NoResultError);
  vertices.pop_back();
  EXPECT_THROW(moved_tooth(scanned(), finished(), vertices), UsageError);
}

}  // namespace
}  // namespace rhizodont
