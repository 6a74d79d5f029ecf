// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/frame.hpp"
#include "completion/mean_crowns.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace rhizodont {
namespace {

CanonicalFrame some_frame(bool mirrored) {
  CanonicalFrame frame;
  frame.rotation = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  frame.centre = {31.5, -12.25, 7.75};
  frame.mirrored = mirrored;
  return frame;
}

// A tent without floor: four walls rising to an apex; its border is the unit square in the plane z = 0.
TriangleMesh tent(double height) {
  return {{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, height}},
          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

TEST(CanonicalFrame, thereAndBackIsExactToRounding) {
  for (const bool mirrored : {false, true}) {
    const CanonicalFrame frame = some_frame(mirrored);
    for (int i = 0; i < 100; ++i) {
      const Point p(30 + 10 * std::sin(i), -10 + 10 * std::cos(3 * i), 8 * std::sin(7 * i));
      EXPECT_LT((frame.to_world(frame.to_canonical(p)) - p).norm(), 1e-13 * 60);
      EXPECT_LT((frame.to_canonical(frame.to_world(p)) - p).norm(), 1e-12);
    }
  }
}

TEST(CanonicalFrame, unitIsTwelveMillimetres) {
  const CanonicalFrame frame = some_frame(true);
  const Point a(1, 2, 3), b(1, 2, 15);
  EXPECT_NEAR((frame.to_canonical(a) - frame.to_canonical(b)).norm(), 1.0, 1e-14);
  EXPECT_LT(frame.to_canonical(frame.centre).norm(), 1e-15);
}

TEST(CanonicalFrame, mirroringTurnsHandsAndNothingElseDoes) {
  for (const bool mirrored : {false, true}) {
    const CanonicalFrame frame = some_frame(mirrored);
    Eigen::Matrix3d axes;
    for (int i = 0; i < 3; ++i) axes.col(i) = frame.direction_to_canonical(Eigen::Matrix3d::Identity().col(i));
    EXPECT_NEAR(axes.determinant(), mirrored ? -1 : 1, 1e-14);
    EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(CanonicalFrame, directionsFollowPoints) {
  const CanonicalFrame frame = some_frame(true);
  const Point p(5, 6, 7);
  const Eigen::Vector3d d(0.6, 0, -0.8);
  const Eigen::Vector3d moved = frame.to_canonical(p + d) - frame.to_canonical(p);
  EXPECT_LT((moved * frame.scale - frame.direction_to_canonical(d)).norm(), 1e-13);
  EXPECT_LT((frame.direction_to_world(frame.direction_to_canonical(d)) - d).norm(), 1e-15);
}

TEST(ToothType, leftAndRightShareATypeAndNumbersComeBack) {
  int numbers = 0;
  for (int fdi = 0; fdi < 100; ++fdi) {
    const int quadrant = fdi / 10, position = fdi % 10;
    if (quadrant < 1 || quadrant > 4 || position < 1 || position > 8) {
      EXPECT_THROW(tooth_type_of_fdi(fdi), UsageError) << fdi;
      EXPECT_THROW(is_right_side(fdi), UsageError) << fdi;
      continue;
    }
    EXPECT_EQ(fdi_of_type(tooth_type_of_fdi(fdi), is_right_side(fdi)), fdi);
    ++numbers;
  }
  EXPECT_EQ(numbers, 32);
  EXPECT_EQ(tooth_type_of_fdi(18), tooth_type_of_fdi(28));
  EXPECT_EQ(tooth_type_of_fdi(31), 8);
  EXPECT_THROW(tooth_type_of_fdi(-11), UsageError);
  EXPECT_THROW(fdi_of_type(16, false), UsageError);
}

TEST(GrowthAxis, dependsOnTheBorderAlone) {
  for (const double height : {0.5, 3.0, 20.0})
    EXPECT_LT((growth_axis(tent(height)) - Eigen::Vector3d::UnitZ()).norm(), 1e-14);
  TriangleMesh bent = tent(4);
  bent.vertices[4] = {7, -3, 5};
  EXPECT_LT((growth_axis(bent) - Eigen::Vector3d::UnitZ()).norm(), 1e-14);
}

TEST(GrowthAxis, turnsWithTheCrown) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  TriangleMesh crown = tent(2);
  for (Point& p : crown.vertices) p = turn * p + Point(5, 5, 5);
  EXPECT_LT((growth_axis(crown) - turn.col(2)).norm(), 1e-14);
}

TEST(GrowthAxis, closedSurfacesHaveNone) {
  TriangleMesh closed = tent(2);
  closed.triangles.push_back({0, 3, 2});
  closed.triangles.push_back({0, 2, 1});
  EXPECT_THROW(growth_axis(closed), InputError);
  EXPECT_THROW(growth_axis(TriangleMesh{}), InputError);
}

Atlas small_atlas() {
  Atlas atlas;
  for (std::size_t type = 0; type < atlas.types.size(); ++type) {
    for (int i = 0; i < 5; ++i) {
      atlas.types[type].crown.points.emplace_back(0.125 * i, 0.5, static_cast<double>(type));
      atlas.types[type].crown.normals.emplace_back(0, i % 2 == 0 ? 1 : -1, 0);
      atlas.types[type].anchors.emplace_back(-0.25 * i, 0, 1);
    }
  }
  return atlas;
}

std::filesystem::path scratch(const char* name) {
  return std::filesystem::temp_directory_path() / (std::string("rhizodont_completion_") + name);
}

TEST(Atlas, isReadAsItWasWritten) {
  const Atlas atlas = small_atlas();
  const auto path = scratch("atlas.safetensors");
  save_atlas(atlas, path);
  const Atlas read = load_atlas(path);
  for (std::size_t type = 0; type < atlas.types.size(); ++type) {
    EXPECT_EQ(read.types[type].crown.points, atlas.types[type].crown.points);
    EXPECT_EQ(read.types[type].crown.normals, atlas.types[type].crown.normals);
    EXPECT_EQ(read.types[type].anchors, atlas.types[type].anchors);
  }
  std::filesystem::remove(path);
}

TEST(Atlas, saysWhatIsWrongWithAFile) {
  const auto path = scratch("bad_atlas.safetensors");
  EXPECT_THROW(load_atlas(path), InputError);
  save_atlas(small_atlas(), path);
  TensorFile file = read_safetensors(path);
  const TensorFile whole = file;
  file.tensors.erase("anchors_7");
  write_safetensors(path, file);
  EXPECT_THROW(load_atlas(path), InputError);
  file = whole;
  file.tensors["crown_3"] = store_floats(std::vector<float>(10, 0.0F), {5, 2});
  write_safetensors(path, file);
  EXPECT_THROW(load_atlas(path), InputError);
  file = whole;
  file.tensors["crown_normals_0"] = store_floats(std::vector<float>(15, 0.0F), {5, 3});
  write_safetensors(path, file);
  EXPECT_THROW(load_atlas(path), InputError);
  file = whole;
  file.tensors["anchors_0"] = store_floats(std::vector<float>(15, std::nanf("")), {5, 3});
  write_safetensors(path, file);
  EXPECT_THROW(load_atlas(path), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace rhizodont
