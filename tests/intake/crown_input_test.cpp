// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/crown_input.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <limits>
#include <string_view>

namespace rhizodont {
namespace {

/// A crown of sorts, 8 mm across.
TriangleMesh bowl() { return test::dome(3, 4); }

/// Runs all checks and returns what is said, or nothing.
std::string complaint(const TriangleMesh& crown, double millimetres_per_unit = 1) {
  try {
    require_usable_crown(crown);
    require_tooth_size(crown, millimetres_per_unit);
    require_outward_and_uncut(crown);
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ErrorCode::unusable_input);
    return error.what();
  }
  return {};
}

void expect_complaint(const TriangleMesh& crown, const std::string& words) {
  const std::string said = complaint(crown);
  EXPECT_NE(said.find(words), std::string::npos) << "said: " << said;
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Point& p : mesh.vertices) p *= factor;
  return mesh;
}

TEST(CrownInput, OneHandleIsTooMany) {
  TriangleMesh ring = test::torus(24, 12);
  ring.triangles.pop_back();
  try {
    require_outward_and_uncut(ring);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string_view(error.what()).find("1 handle"), std::string_view::npos) << error.what();
  }
}

TEST(CrownInput, AGoodCrownPasses) { EXPECT_EQ(complaint(bowl()), ""); }

TEST(CrownInput, DamagedMeshesAreRefused) {
  expect_complaint({}, "no triangles");
  TriangleMesh mesh = bowl();
  mesh.vertices[5].y() = std::numeric_limits<double>::quiet_NaN();
  expect_complaint(mesh, "not numbers");
  mesh = bowl();
  mesh.triangles[7][1] = 100000;
  expect_complaint(mesh, "do not exist");
  mesh = bowl();
  mesh.triangles[7][1] = mesh.triangles[7][0];
  expect_complaint(mesh, "one vertex twice");
  mesh = bowl();
  std::swap(mesh.triangles[20][0], mesh.triangles[20][1]);
  expect_complaint(mesh, "flipped against their neighbours");
  mesh = bowl();
  mesh.vertices.emplace_back(0, 0, 9);
  mesh.triangles.push_back({mesh.triangles[3][0], mesh.triangles[3][1], static_cast<int>(mesh.vertices.size()) - 1});
  expect_complaint(mesh, "more than two triangles");
  expect_complaint(test::together(bowl(), bowl(), Point(20, 0, 0)), "2 crowns");
  expect_complaint(flipped(bowl()), "inside out");
  expect_complaint(flipped(test::sphere(3, 4)), "inside out");
  mesh = bowl();
  for (const Triangle& t : bowl().triangles) mesh.triangles.push_back({t[0], t[2], t[1]});
  expect_complaint(mesh, "double-sided");
}

TEST(CrownInput, TheUnitIsGuessedFromTheSize) {
  expect_complaint(scaled(bowl(), 1e-3), "metres (--unit m)");
  expect_complaint(scaled(bowl(), 0.1), "centimetres (--unit cm)");
  expect_complaint(scaled(bowl(), 1 / 25.4), "inches (--unit in)");
  expect_complaint(scaled(bowl(), 1e4), "teeth are 2 to 20 mm");
  expect_complaint(scaled(bowl(), 1e3), "micrometres (--unit um)");
  // Read as centimetres, a crown in millimetres is too large; the hint speaks of the raw size.
  const TriangleMesh wrong = scaled(bowl(), 10);
  EXPECT_NE(complaint(wrong, 10).find("Is it in millimetres (--unit mm)?"), std::string::npos);
}

TEST(CrownInput, UnitsHaveNames) {
  EXPECT_EQ(unit_in_words(1), "millimetres");
  EXPECT_EQ(unit_in_words(1e-3), "micrometres");
  EXPECT_EQ(unit_in_words(25.4), "inches");
  EXPECT_EQ(unit_in_words(3), "3 mm");
}

TEST(CrownInput, AClosedMeshMayBeLongerForItMayHaveARoot) {
  const TriangleMesh tooth = scaled(test::sphere(3, 4), 3);  // 24 mm
  EXPECT_NO_THROW(require_tooth_size(tooth, 1, true));
  EXPECT_THROW(require_tooth_size(tooth, 1), InputError);
  EXPECT_THROW(require_tooth_size(scaled(tooth, 1e3), 1, true), InputError);
  try {
    require_no_root(tooth);
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("its root already"), std::string::npos);
  }
  EXPECT_NO_THROW(require_no_root(test::sphere(3, 4)));
}

TEST(CrownInput, ARootIsKnownByTheLengthHoweverTheFileIsTurned) {
  for (const double length : {14.0, 16.0}) {
    TriangleMesh tooth = test::sphere(3, 1);
    for (Point& p : tooth.vertices) p = Point(3 * p.x(), 3 * p.y(), length / 2 * p.z());
    for (int k = 0; k < 6; ++k) {
      TriangleMesh turned = tooth;
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(0.4 * k, Eigen::Vector3d(1, 2, 0.3).normalized()).toRotationMatrix();
      for (Point& p : turned.vertices) p = turn * p;
      if (length < 15)
        EXPECT_NO_THROW(require_no_root(turned)) << k;
      else
        EXPECT_THROW(require_no_root(turned), InputError) << k;
    }
  }
}

TEST(CrownInput, ACrownThatCutsItselfIsRefusedWithTheTriangles) {
  TriangleMesh mesh = bowl();
  // The top is pushed through the opposite wall.
  for (Point& p : mesh.vertices)
    if (p.z() > 3.9) p = Point(6, 0.1, 1);
  try {
    require_outward_and_uncut(mesh);
    FAIL() << "nothing was said";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cuts itself"), std::string::npos);
    EXPECT_FALSE(error.elements().empty());
  }
}

}  // namespace
}  // namespace rhizodont
