// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/scan_sample.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/segment.hpp"
#include "segment/label_scan.hpp"
#include "segment/sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

using test::sheet;

const std::filesystem::path source(RHIZODONT_SOURCE_DIR);

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
      "no scan of an arch");
}

TEST(NoArch, ARowWithoutNumbersIsRefused) {
  // Twelve knobs 8 mm apart that the network takes for teeth, any number as likely as any other.
  constexpr double apart = 8;
  const TriangleMesh mesh = sheet(200, 24, [](double s, double t) {
    return Point(12 * apart * s, 10 * t, 3 * std::pow(std::sin(12 * std::numbers::pi * s), 2));
  });
  TeethReading reading;
  reading.cloud = scan_points(mesh, reading.frame).cloud;
  reading.pyramid = scan_pyramid(reading.cloud, {});
  reading.said.borders.assign(reading.size(), 0);
  for (std::size_t i = 0; i < reading.size(); ++i) {
    reading.said.kinds.push_back(0.04F);
    for (int kind = 1; kind < scan_kind_count; ++kind) reading.said.kinds.push_back(0.06F);
    const Eigen::Vector3d place = reading.place(i);
    const Eigen::Vector3d to(apart * (std::floor(place.x() / apart) + 0.5) - place.x(), 5 - place.y(), 2 - place.z());
    for (const double x : to) reading.said.offsets.push_back(static_cast<float>(x));
  }
  const ArchModel model = load_arch_model(source / "models/arch.safetensors");
  try {
    label_scan(mesh, reading, model, {});
    ADD_FAILURE() << "numbers were given";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not in the order of an arch"), std::string::npos) << error.what();
  }
  // A person who names one knows better.
  SegmentOptions options;
  options.jaw = Jaw::lower;
  options.teeth[36] = Point(apart * 2.5, 5, 3);
  EXPECT_NO_THROW(label_scan(mesh, reading, model, options));
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
