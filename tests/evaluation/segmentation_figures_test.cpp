// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/segmentation_figures.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rhizodont {
namespace {

/// Eight vertices in a row, 1 mm apart, in a strip.
TriangleMesh strip() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back(Point(i, i % 2, 0));
  for (int i = 0; i + 2 < 8; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(SegmentationFigures, OfTheTruthAreOne) {
  const std::vector<int> labels{11, 11, 11, 0, 0, 21, 21, 21};
  const SegmentationFigures f = segmentation_figures(strip(), labels, labels);
  EXPECT_EQ(f.tsa, 1);
  EXPECT_EQ(f.tla, 1);
  EXPECT_EQ(f.tir, 1);
  EXPECT_EQ(f.faces_right, 1);
  EXPECT_EQ(f.faces_wholly_right, 1);
  EXPECT_TRUE(f.is_without_error());
  EXPECT_TRUE(f.jaw_right);
  EXPECT_EQ(f.mean_overlap(), 1);
}

TEST(SegmentationFigures, MilkTeethCountByTheirPlaces) {
  const SegmentationFigures f =
      segmentation_figures(strip(), {55, 55, 55, 0, 0, 65, 65, 65}, {15, 15, 15, 0, 0, 25, 25, 25});
  EXPECT_EQ(f.right(), 2U);
  EXPECT_EQ(f.faces_right, 1);
  EXPECT_FALSE(
      segmentation_figures(strip(), {55, 55, 55, 0, 0, 0, 0, 0}, {14, 14, 14, 0, 0, 0, 0, 0}).teeth[0].is_right());
}

TEST(SegmentationFigures, CountedByHand) {
  const std::vector<int> truth{11, 11, 11, 0, 0, 21, 21, 21}, found{11, 11, 0, 0, 22, 22, 22, 22};
  const SegmentationFigures f = segmentation_figures(strip(), truth, found);
  EXPECT_DOUBLE_EQ(f.tsa, 6.0 / 8);
  ASSERT_EQ(f.teeth.size(), 2U);
  EXPECT_DOUBLE_EQ(f.teeth[0].overlap, 2.0 / 3);
  EXPECT_TRUE(f.teeth[0].is_right());
  EXPECT_EQ(f.teeth[1].overlap, 0);
  EXPECT_EQ(f.teeth[1].most_like, 22);
  EXPECT_DOUBLE_EQ(f.teeth[1].most_overlap, 3.0 / 4);
  EXPECT_FALSE(f.teeth[1].is_right());
  EXPECT_TRUE(f.extra.empty());
  // 11: middles (1, 1/3) and (0.5, 0.5), 0.53 apart, over half of its box's size, (2 + 1 + 0) / 3; 22: the same. So
  // neither counts as found, which costs 5 each.
  EXPECT_EQ(f.tir, 0);
  EXPECT_NEAR(f.tla, std::exp(-5), 1e-12);
  // Each of the six triangles has vertex 2, 4 or one of those called 22 instead of 21; most corners of 0 1 2 are
  // rightly 11, and of 2 3 4 rightly gum.
  EXPECT_DOUBLE_EQ(f.faces_wholly_right, 0);
  EXPECT_DOUBLE_EQ(f.faces_right, 2.0 / 6);
  const SegmentationSummary sum = summary_of({f, segmentation_figures(strip(), truth, truth)});
  EXPECT_EQ(sum.teeth, 4U);
  EXPECT_EQ(sum.right, 3U);
  EXPECT_EQ(sum.located, 4U);
  EXPECT_EQ(sum.without_error, 1U);
  EXPECT_EQ(sum.by_type.at(1), (std::pair<std::size_t, std::size_t>(4, 3)));
  EXPECT_NE(describe(sum).find("3 of 4 teeth right"), std::string::npos);
}

TEST(SegmentationFigures, MissedTeethAndOtherJaw) {
  const std::vector<int> truth{11, 11, 11, 0, 0, 21, 21, 21}, none(8, 0), lower{41, 41, 41, 0, 0, 31, 31, 31};
  const SegmentationFigures f = segmentation_figures(strip(), truth, none);
  EXPECT_DOUBLE_EQ(f.tsa, 2.0 / 8);
  EXPECT_NEAR(f.tla, std::exp(-5.0), 1e-12);
  EXPECT_EQ(f.tir, 0);
  EXPECT_FALSE(f.jaw_right);
  const SegmentationFigures g = segmentation_figures(strip(), truth, lower);
  EXPECT_EQ(g.tsa, 1);
  EXPECT_EQ(g.tir, 0);
  EXPECT_FALSE(g.jaw_right);
  EXPECT_EQ(g.right(), 0U);
  EXPECT_THROW(segmentation_figures(strip(), truth, {0}), UsageError);
}

}  // namespace
}  // namespace rhizodont
