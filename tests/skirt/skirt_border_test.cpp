// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/skirt_border.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "operators/surfaces.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

/// A sheet of 6 x 4 mm; tooth where x is less than 4, and surely so.
struct Sheet {
  TriangleMesh mesh = test::rectangle(30, 20, 6, 4);
  std::vector<float> confidence;

  Sheet() {
    for (const Point& p : mesh.vertices) confidence.push_back(p.x() < 4 ? 0.95F : 0.05F);
  }
  double kept_area(const std::vector<bool>& keep) const {
    double area = 0;
    for (std::size_t t = 0; t < keep.size(); ++t)
      if (keep[t]) area += triangle_area(mesh, t);
    return area;
  }
  void set_around(const Point& middle, double radius, float value) {
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      if ((mesh.vertices[v] - middle).norm() < radius) confidence[v] = value;
  }
};

TEST(SkirtBorder, LiesWhereConfidenceTurns) {
  const Sheet sheet;
  const std::vector<bool> keep = tooth_triangles(sheet.mesh, sheet.confidence);
  EXPECT_NEAR(sheet.kept_area(keep), 16, 1);
  const KeptCrown kept = keep_crown(sheet.mesh, keep, DropReason::skirt);
  const Diagnosis diagnosis = diagnose(kept.mesh);
  EXPECT_TRUE(diagnosis.is_oriented_manifold());
  EXPECT_EQ(diagnosis.border_loop_count, 1);
  EXPECT_EQ(diagnosis.euler_number, 1);
}

TEST(SkirtBorder, KeepsEverythingWhereAllIsTooth) {
  Sheet sheet;
  std::fill(sheet.confidence.begin(), sheet.confidence.end(), 0.51F);
  const std::vector<bool> keep = tooth_triangles(sheet.mesh, sheet.confidence);
  EXPECT_TRUE(std::all_of(keep.begin(), keep.end(), [](bool k) { return k; }));
}

TEST(SkirtBorder, IgnoresSpecksAndIslands) {
  const Sheet plain;
  const std::vector<bool> kept = tooth_triangles(plain.mesh, plain.confidence);
  struct Island {
    const char* what;
    Point middle;
    double radius;
    float confidence;
  };
  const std::vector<Island> islands{{"a speck in the tooth", {2, 2, 0}, 0.25, 0.05F},
                                    {"a larger island that no border reaches", {1, 1.4, 0}, 0.7, 0.02F},
                                    {"an island of tooth in the skirt", {5, 2, 0}, 0.7, 0.98F}};
  Sheet all;
  for (const Island& island : islands) {
    Sheet sheet;
    sheet.set_around(island.middle, island.radius, island.confidence);
    all.set_around(island.middle, island.radius, island.confidence);
    ASSERT_NE(sheet.confidence, plain.confidence) << island.what;
    EXPECT_EQ(tooth_triangles(sheet.mesh, sheet.confidence), kept) << island.what;
  }
  EXPECT_EQ(tooth_triangles(all.mesh, all.confidence), kept);
  // What reaches the tooth's border is no island.
  Sheet bay;
  bay.set_around({4, 2, 0}, 1.2, 0.02F);
  EXPECT_LT(bay.kept_area(tooth_triangles(bay.mesh, bay.confidence)), plain.kept_area(kept) - 1);
}

TEST(SkirtBorder, IsSmoothWhereConfidenceIsRagged) {
  Sheet sheet;
  for (std::size_t v = 0; v < sheet.mesh.vertices.size(); ++v) {
    const Point& p = sheet.mesh.vertices[v];
    const bool tooth = p.x() < 4 + (static_cast<int>(std::round(p.y() / 0.2)) % 2 == 0 ? 0.25 : -0.25);
    sheet.confidence[v] = tooth ? 0.7F : 0.3F;
  }
  const KeptCrown kept = keep_crown(sheet.mesh, tooth_triangles(sheet.mesh, sheet.confidence), DropReason::skirt);
  double length = 0;
  for (const auto& loop : border_loops(kept.mesh))
    for (std::size_t i = 0; i < loop.size(); ++i)
      length += (kept.mesh.vertices[static_cast<std::size_t>(loop[i])] -
                 kept.mesh.vertices[static_cast<std::size_t>(loop[(i + 1) % loop.size()])])
                    .norm();
  EXPECT_LT(length, 4 + 2 * 4 + 4 * 1.25);  // a comb of single triangles would be 10 mm long instead of about 4
}

TEST(SkirtBorder, RunsInTheCrease) {
  // Tooth up a wall, gum on the floor: the crease is at x = 4, the confidence turns half a millimetre beyond it.
  Sheet sheet;
  for (std::size_t v = 0; v < sheet.mesh.vertices.size(); ++v) {
    Point& p = sheet.mesh.vertices[v];
    const double beyond = p.x() - 4;
    sheet.confidence[v] = beyond < -0.3 ? 0.9F : beyond < 0.55 ? 0.55F : 0.05F;
    if (beyond < 0) p = Point(4, p.y(), -beyond);
  }
  const std::vector<bool> keep = tooth_triangles(sheet.mesh, sheet.confidence);
  double lowest = 10;
  for (std::size_t t = 0; t < keep.size(); ++t) {
    if (!keep[t]) continue;
    for (const int v : sheet.mesh.triangles[t])
      lowest = std::min(lowest, sheet.mesh.vertices[static_cast<std::size_t>(v)].z() -
                                    sheet.mesh.vertices[static_cast<std::size_t>(v)].x() + 4);
  }
  EXPECT_NEAR(lowest, 0, 0.21);
}

TEST(SkirtBorder, TakesABridgeOff) {
  // A strip of the sheet's far end bent round and joined to the near end would be a handle; here a bridge over a gap:
  // the skirt is cut away but for two strips that meet again, which makes a hole and no disc.
  Sheet sheet;
  std::erase_if(sheet.mesh.triangles, [&](const Triangle& t) {
    Point middle = Point::Zero();
    for (const int v : t) middle += sheet.mesh.vertices[static_cast<std::size_t>(v)] / 3;
    return middle.x() > 4.4 && middle.x() < 5.4 && middle.y() > 0.6 && middle.y() < 3.4;
  });
  sheet.confidence.clear();
  const Submesh part = compact(sheet.mesh);
  for (const Point& p : part.mesh.vertices) sheet.confidence.push_back(p.x() < 4 ? 0.95F : 0.1F);
  ASSERT_EQ(diagnose(part.mesh).border_loop_count, 2);
  const KeptCrown kept = keep_crown(part.mesh, tooth_triangles(part.mesh, sheet.confidence), DropReason::skirt);
  EXPECT_EQ(diagnose(kept.mesh).border_loop_count, 1);
}

TEST(SkirtBorder, AHoleInTheToothStays) {
  Sheet sheet;
  std::erase_if(sheet.mesh.triangles, [&](const Triangle& t) {
    Point middle = Point::Zero();
    for (const int v : t) middle += sheet.mesh.vertices[static_cast<std::size_t>(v)] / 3;
    return (middle - Point(2, 2, 0)).norm() < 0.5;
  });
  const Submesh part = compact(sheet.mesh);
  std::vector<float> confidence;
  for (const Point& p : part.mesh.vertices) confidence.push_back(p.x() < 4 ? 0.95F : 0.05F);
  const KeptCrown kept = keep_crown(part.mesh, tooth_triangles(part.mesh, confidence), DropReason::skirt);
  EXPECT_EQ(diagnose(kept.mesh).border_loop_count, 2);
}

TEST(SkirtBorder, AHigherThresholdKeepsLess) {
  Sheet sheet;
  for (std::size_t v = 0; v < sheet.mesh.vertices.size(); ++v)
    sheet.confidence[v] = static_cast<float>(1 - sheet.mesh.vertices[v].x() / 6);
  double before = 24;
  for (const double threshold : {0.2, 0.4, 0.6}) {
    SkirtBorderOptions options;
    options.threshold = threshold;
    const double area = sheet.kept_area(tooth_triangles(sheet.mesh, sheet.confidence, options));
    EXPECT_LT(area, before);
    EXPECT_NEAR(area, 24 * (1 - threshold), 2.5);
    before = area;
  }
}

TEST(SkirtBorder, RefusesWhatMakesNoSense) {
  Sheet sheet;
  SkirtBorderOptions options;
  options.threshold = 1;
  EXPECT_THROW(tooth_triangles(sheet.mesh, sheet.confidence, options), UsageError);
  EXPECT_THROW(tooth_triangles(sheet.mesh, {0.5F}), UsageError);
  std::fill(sheet.confidence.begin(), sheet.confidence.end(), 0.01F);
  EXPECT_THROW(tooth_triangles(sheet.mesh, sheet.confidence), InputError);
}

}  // namespace
}  // namespace rhizodont
