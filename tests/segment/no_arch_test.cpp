// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/segment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

const std::filesystem::path source(RHIZODONT_SOURCE_DIR);

/// A sheet over the unit square.
TriangleMesh sheet(int columns, int rows, const std::function<Point(double, double)>& at) {
  TriangleMesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.vertices.push_back(at(i / (columns - 1.0), j / (rows - 1.0)));
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int v = columns * j + i;
      mesh.triangles.push_back({v, v + 1, v + columns + 1});
      mesh.triangles.push_back({v, v + columns + 1, v + columns});
    }
  return mesh;
}

void expect_refused(const TriangleMesh& mesh, const std::string& words) {
  const SegmentModels models = SegmentModels::load(source / "models");
  try {
    const SegmentedScan found = segment_scan(mesh, models);
    ADD_FAILURE() << found.teeth.size() << " teeth were found";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(NoArch, ASingleCrownIsRefused) {
  expect_refused(load_mesh(source / "samples/crown_36.stl").mesh, "single crown goes to complete");
}

TEST(NoArch, AFaceIsRefused) {
  expect_refused(sheet(120, 150,
                       [](double s, double t) {
                         const double x = 110 * (s - 0.5), y = 140 * (t - 0.5);
                         return Point(x, y, 60 * std::sqrt(std::max(0.0, 1 - x * x / 3400 - y * y / 5700)));
                       }),
                 "too large for a jaw");
}

TEST(NoArch, AModelBaseAloneIsRefused) {
  expect_refused(sheet(160, 60,
                       [](double s, double t) {
                         const double angle = std::numbers::pi * (1.05 * s - 0.025), radius = 18 + 18 * t;
                         return Point(radius * std::cos(angle), 1.3 * radius * std::sin(angle),
                                      8 * std::sqrt(std::sin(std::numbers::pi * t)));
                       }),
                 "no scan of an arch");
  expect_refused(sheet(100, 80, [](double s, double t) { return Point(70 * s, 55 * t, 0); }), "no scan of an arch");
}

TEST(NoArch, RowsOfKnobsAreRefused) {
  expect_refused(
      sheet(140, 110,
            [](double s, double t) { return Point(70 * s, 55 * t, 1.5 * std::sin(40 * s) * std::cos(35 * t)); }),
      "not in the order of an arch");
}

TEST(NoArch, AnImpressionOfTeethIsRefused) {
  const std::filesystem::path scan = source / "../shared/data/arches/scan_020_upper.ply";
  if (!std::filesystem::exists(scan)) GTEST_SKIP() << "no labelled scans at " << scan;
  // As a bite registration shows them: hollow.
  TriangleMesh mesh = load_mesh(scan).mesh;
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  expect_refused(mesh, "no scan of an arch");
}

}  // namespace
}  // namespace rhizodont
