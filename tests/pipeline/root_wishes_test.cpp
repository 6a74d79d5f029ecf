// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace rhizodont {
namespace {

using test::models;
using test::source_folder;

const TriangleMesh& crown() {
  static const TriangleMesh loaded = load_mesh(source_folder / "samples" / "crown_34.ply").mesh;
  return loaded;
}

CompleteOptions premolar() { return test::for_tooth(34); }

const CompletedTooth& expected() {
  static const CompletedTooth tooth = complete_tooth(crown(), models(), premolar());
  return tooth;
}

void expect_promises(const CompletedTooth& tooth) {
  CheckOptions exact;
  exact.compare_as_float = false;
  const CheckReport report = check(crown(), tooth.mesh, exact);
  EXPECT_TRUE(report.holds());
  EXPECT_EQ(report.crown.kept_triangles, static_cast<std::int64_t>(crown().triangles.size()));
}

/// The deepest vertex along the growth axis.
Point apex(const CompletedTooth& tooth) {
  const Eigen::Vector3d axis = tooth.record.frame.growth_axis;
  return *std::min_element(tooth.mesh.vertices.begin(), tooth.mesh.vertices.end(),
                           [&](const Point& a, const Point& b) { return a.dot(axis) < b.dot(axis); });
}

TEST(RootWishes, AMeasuredLengthIsKept) {
  for (const double wanted : {10.5, 16.0}) {
    CompleteOptions options = premolar();
    options.steering.length_mm = wanted;
    const CompletedTooth tooth = complete_tooth(crown(), models(), options);
    EXPECT_NEAR(tooth.record.root.length_mm, wanted, 0.1);
    EXPECT_FALSE(tooth.record.root.interval);
    expect_promises(tooth);
  }
}

TEST(RootWishes, TorqueTurnsTheApexToTheTongue) {
  CompleteOptions options = premolar();
  options.steering.torque_degrees = 10;
  options.steering.bend_degrees = -15;
  const CompletedTooth tooth = complete_tooth(crown(), models(), options);
  expect_promises(tooth);
  const Eigen::Vector3d to_world = (apex(tooth) - apex(expected()));
  const Eigen::Vector3d moved = tooth.record.frame.rotation * to_world;  // left tooth: no mirror
  EXPECT_LT(moved.y(), -1);                                              // +y is the cheek
  EXPECT_GT(moved.x(), 0.3);                                             // +x is mesial for lower teeth
}

TEST(RootWishes, UncertaintyIsNoneOnTheCrownAndGrowsDownTheRoot) {
  const CompletedTooth& tooth = expected();
  ASSERT_EQ(tooth.uncertainty.size(), tooth.mesh.vertices.size());
  const Eigen::Vector3d axis = tooth.record.frame.growth_axis;
  const double deepest = apex(tooth).dot(axis), length = tooth.record.root.length_mm;
  double upper = 0, lower = 0;
  int upper_count = 0, lower_count = 0;
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v) {
    if (tooth.source[v] == VertexSource::scan) {
      ASSERT_EQ(tooth.uncertainty[v], 0);
      continue;
    }
    ASSERT_GE(tooth.uncertainty[v], 0);
    ASSERT_LT(tooth.uncertainty[v], 10);
    const double height = (tooth.mesh.vertices[v].dot(axis) - deepest) / length;
    (height > 0.8 ? upper : lower) += height > 0.8 || height < 0.2 ? tooth.uncertainty[v] : 0;
    upper_count += height > 0.8 ? 1 : 0;
    lower_count += height < 0.2 ? 1 : 0;
  }
  EXPECT_GT(lower / lower_count, 1.5 * upper / upper_count);
}

TEST(RootWishes, CandidatesSpreadOverTheInterval) {
  ASSERT_TRUE(expected().record.root.interval) << "the shipped weights are calibrated";
  const RootInterval interval = *expected().record.root.interval;
  EXPECT_LT(interval.length_low_mm, interval.length_high_mm);
  EXPECT_GT(interval.apex_radius_mm, 0);
  const auto candidates = complete_candidates(crown(), models(), 3, premolar());
  ASSERT_EQ(candidates.size(), 3U);
  EXPECT_EQ(candidates[0].mesh.vertices, expected().mesh.vertices);
  EXPECT_NEAR(candidates[1].record.root.length_mm, interval.length_low_mm, 0.1);
  EXPECT_NEAR(candidates[2].record.root.length_mm, interval.length_high_mm, 0.1);
  for (const CompletedTooth& tooth : candidates) expect_promises(tooth);
}

TEST(RootWishes, CandidatesSayWhatTheyWereMadeWith) {
  const auto candidates = complete_candidates(crown(), models(), 3);
  ASSERT_EQ(candidates.size(), 3U);
  const RootInterval interval = candidates[0].record.root.interval.value();
  const std::array<std::optional<double>, 3> lengths{std::nullopt, interval.length_low_mm, interval.length_high_mm};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const CompletedTooth& tooth = candidates[i];
    EXPECT_TRUE(tooth.record.fdi_guessed) << i;
    EXPECT_EQ(tooth.record.fdi, candidates[0].record.fdi) << i;
    EXPECT_FALSE(tooth.options.fdi) << i;
    EXPECT_EQ(tooth.options.steering.length_mm, lengths[i]) << i;
    EXPECT_EQ(tooth.record.warnings.front(), candidates[0].record.warnings.front()) << i;
    const auto report = nlohmann::json::parse(completion_report(tooth, {}));
    EXPECT_TRUE(report["fdi"]["guessed"].get<bool>()) << i;
    EXPECT_TRUE(report["options"]["fdi"].is_null()) << i;
    const auto& length = report["options"]["steering"]["root_length_mm"];
    EXPECT_EQ(length.is_null() ? std::nullopt : std::optional(length.get<double>()), lengths[i]) << i;
    CompletedTooth again = complete_tooth(crown(), models(), tooth.options);
    EXPECT_EQ(again.mesh.vertices, tooth.mesh.vertices) << i;
  }
}

TEST(RootWishes, WhatCannotBeIsRefused) {
  CompleteOptions options = premolar();
  options.steering.length_mm = 13;
  EXPECT_THROW(complete_candidates(crown(), models(), 3, options), UsageError);
  EXPECT_THROW(complete_candidates(crown(), models(), 0, premolar()), UsageError);
  EXPECT_THROW(complete_candidates(crown(), models(), 10, premolar()), UsageError);
  options.steering.length_mm = 31;
  EXPECT_THROW(complete_tooth(crown(), models(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
