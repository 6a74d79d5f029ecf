// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/root_length_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "completion/type_table.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

/// A cone with its tip at z = -10 and its base, 4 wide, at z = 2.
OrientedPoints cone() {
  OrientedPoints points;
  for (int i = 0; i <= 120; ++i) {
    const double z = 2 - 0.1 * i, radius = (z + 10) / 6, around = 0.7 * i;
    points.points.emplace_back(radius * std::cos(around), radius * std::sin(around), z);
    points.normals.push_back(Eigen::Vector3d(std::cos(around), std::sin(around), -1.0 / 6).normalized());
  }
  return points;
}

TEST(RootLengthCorrection, StretchesWhatIsBelowTheCrown) {
  const OrientedPoints before = cone();
  OrientedPoints after = before;
  lengthen_root(after, Eigen::Vector3d::UnitZ(), 0, 1);
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    const double z = before.points[i].z();
    if (z >= 0) {
      EXPECT_EQ(after.points[i], before.points[i]);
      EXPECT_EQ(after.normals[i], before.normals[i]);
      continue;
    }
    EXPECT_NEAR(after.points[i].z(), 1.1 * z, 1e-12);
    EXPECT_EQ(after.points[i].head<2>(), before.points[i].head<2>());
    // the cone is steeper there: 10/6 mm of radius on 11 mm of height
    EXPECT_NEAR(after.normals[i].z() / after.normals[i].head<2>().norm(), -10.0 / 6 / 11, 1e-12);
    EXPECT_NEAR(after.normals[i].norm(), 1, 1e-12);
  }
}

TEST(RootLengthCorrection, IsBoundedAndLeavesWhatHasNoRoot) {
  OrientedPoints longer = cone(), shorter = cone(), none = cone();
  lengthen_root(longer, Eigen::Vector3d::UnitZ(), 0, 100);
  lengthen_root(shorter, Eigen::Vector3d::UnitZ(), 0, -100);
  lengthen_root(none, Eigen::Vector3d::UnitZ(), -20, 1);
  EXPECT_NEAR(longer.points.back().z(), -12.5, 1e-9);
  EXPECT_NEAR(shorter.points.back().z(), -8, 1e-9);
  EXPECT_EQ(none.points, cone().points);
}

TEST(RootLengthCorrection, IsTakenBackAlsoWhereItWasBounded) {
  for (const double mm : {-100.0, -2.5, -1.0, 0.0, 0.7, 2.4, 3.0}) {
    OrientedPoints points = cone();
    lengthen_root(points, Eigen::Vector3d::UnitZ(), 0, mm);
    EXPECT_NEAR(length_before_correction(-points.points.back().z(), mm), 10, 1e-9) << mm;
  }
}

TEST(RootLengthCorrection, GoesThroughTheWeightFile) {
  std::map<std::string, std::string> metadata;
  EXPECT_EQ(root_length_correction(metadata, 36), 0);
  note_root_length_corrections({{36, -0.25}, {21, 0.5}}, metadata);
  EXPECT_EQ(root_length_correction(metadata, 36), -0.25);
  EXPECT_EQ(root_length_correction(metadata, 46), -0.25) << "left and right are one type";
  EXPECT_EQ(root_length_correction(metadata, 11), 0.5);
  EXPECT_EQ(root_length_correction(metadata, 37), 0);
  EXPECT_EQ(root_length_correction(metadata, 0), 0) << "a tooth of unknown type";
  note_root_length_corrections({}, metadata);
  EXPECT_TRUE(metadata.empty());
}

TEST(TypeTable, RefusesWhatItCannotRead) {
  EXPECT_EQ(read_type_table(type_table_text({{21, {1, -2.5}}, {38, {0, 3}}}), 2, "x"),
            (TypeTable{{21, {1, -2.5}}, {38, {0, 3}}}));
  EXPECT_TRUE(read_type_table("1", 2, "x").empty());
  for (const char* text : {"", "1; 21", "1; 21 1 2 3", "1; 21 1 nan", "1; 21 1 two", "1; 11 1 2", "1; 29 1 2",
                           "1; 21 1 2; 21 1 2", "one; 21 1 2"})
    EXPECT_THROW(read_type_table(text, 2, "x"), InputError) << text;
}

}  // namespace
}  // namespace rhizodont
