// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/root_figures.hpp"

#include "evaluation/made_teeth.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace rhizodont {
namespace {

using test::changed;
using test::crown_of;
using test::one_rooted;
using test::two_rooted;

const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

double crown_level(const TriangleMesh& crown) {
  double level = std::numeric_limits<double>::infinity();
  for (const Point& p : crown.vertices) level = std::min(level, p.z());
  return level;
}

/// The root made longer (or shorter) by a stretch along z; the crown and its border stay.
TriangleMesh lengthened(const TriangleMesh& tooth, double level, double by_mm) {
  double lowest = level;
  for (const Point& p : tooth.vertices) lowest = std::min(lowest, p.z());
  const double factor = (level - lowest + by_mm) / (level - lowest);
  return changed(tooth, [=](Point p) {
    if (p.z() < level) p.z() = level + factor * (p.z() - level);
    return p;
  });
}

TEST(RootFigures, ToothAgainstItselfIsPerfect) {
  const TriangleMesh tooth = two_rooted();
  const RootFigures f = root_figures(crown_of(tooth), tooth, tooth, up);
  EXPECT_EQ(f.root_length_error_mm, 0);
  EXPECT_EQ(f.apex_distance_mm, 0);
  EXPECT_EQ(f.matched_apex_distance_mm, 0);
  EXPECT_EQ(f.root_chamfer_mm, 0);
  EXPECT_EQ(f.root_f_score, 1);
  EXPECT_EQ(f.root_hausdorff95_mm, 0);
  EXPECT_EQ(f.root_axis_angle_deg, 0);
  EXPECT_EQ(f.chamfer_l2_e3, 0);
  EXPECT_EQ(f.f_score, 1);
  EXPECT_EQ(f.true_apices.size(), 2u);
  EXPECT_GT(f.true_root_length_mm, 5);
}

TEST(RootFigures, LengthErrorIsSignedAndExact) {
  const TriangleMesh tooth = one_rooted(), crown = crown_of(tooth);
  const double level = crown_level(crown);
  const RootFigures shorter = root_figures(crown, tooth, lengthened(tooth, level, -1), up);
  EXPECT_NEAR(shorter.root_length_error_mm, -1, 1e-12);
  EXPECT_NEAR(shorter.apex_distance_mm, 1, 1e-12);
  EXPECT_NEAR(shorter.matched_apex_distance_mm, 1, 1e-12);
  EXPECT_NEAR(root_figures(crown, tooth, lengthened(tooth, level, 2.5), up).root_length_error_mm, 2.5, 1e-12);
}

TEST(RootFigures, AxisMayHaveAnyLength) {
  const TriangleMesh tooth = one_rooted(), crown = crown_of(tooth);
  const TriangleMesh predicted = lengthened(tooth, crown_level(crown), 1.5);
  const RootFigures one = root_figures(crown, tooth, predicted, up),
                    seven = root_figures(crown, tooth, predicted, 7 * up);
  EXPECT_NEAR(one.root_length_error_mm, seven.root_length_error_mm, 1e-12);
  EXPECT_NEAR(one.root_chamfer_mm, seven.root_chamfer_mm, 1e-12);
}

TEST(RootFigures, RigidMotionChangesNothing) {
  const TriangleMesh tooth = two_rooted(), crown = crown_of(tooth);
  const TriangleMesh predicted = changed(lengthened(tooth, crown_level(crown), -0.7),
                                         [](const Point& p) { return Point(p + Point(0.2, 0.1 * p.z(), 0)); });
  const RootFigures here = root_figures(crown, tooth, predicted, up);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto move = [&](const Point& p) { return Point(turn * p + Point(40, -25, 13)); };
  const RootFigures there =
      root_figures(changed(crown, move), changed(tooth, move), changed(predicted, move), turn * up);
  EXPECT_NEAR(here.root_length_error_mm, there.root_length_error_mm, 1e-9);
  EXPECT_NEAR(here.apex_distance_mm, there.apex_distance_mm, 1e-9);
  EXPECT_NEAR(here.matched_apex_distance_mm, there.matched_apex_distance_mm, 1e-9);
  EXPECT_NEAR(here.root_axis_angle_deg, there.root_axis_angle_deg, 1e-3);
  EXPECT_NEAR(here.root_chamfer_mm, there.root_chamfer_mm, 1e-5);
  EXPECT_NEAR(here.root_hausdorff95_mm, there.root_hausdorff95_mm, 1e-4);
  EXPECT_NEAR(here.root_f_score, there.root_f_score, 1e-3);
  // The diagonal of the bounding box is not that of the turned tooth.
  const double ratio = std::pow(
      bounding_box(tooth.vertices).diagonal().norm() / bounding_box(changed(tooth, move).vertices).diagonal().norm(),
      2);
  EXPECT_NEAR(here.chamfer_l2_e3 * ratio, there.chamfer_l2_e3, 1e-5);
}

TEST(RootFigures, ChamferAndScoresOfAShiftedPlaneLikeRootAreTheShift) {
  // A tooth grown by 0.2 mm along its normals: every distance is 0.2 mm but for the spacing of the samples.
  const TriangleMesh tooth = one_rooted();
  const auto normals = vertex_normals(tooth);
  TriangleMesh grown = tooth;
  for (std::size_t v = 0; v < grown.vertices.size(); ++v) grown.vertices[v] += 0.2 * normals[v];
  const RootFigures f = root_figures(crown_of(tooth), tooth, grown, up);
  EXPECT_NEAR(f.root_chamfer_mm, 0.21, 0.03);
  EXPECT_GT(f.root_hausdorff95_mm, 0.19);
  EXPECT_LT(f.root_hausdorff95_mm, 0.33);
  EXPECT_EQ(f.root_f_score, 1);
  const double diagonal = bounding_box(tooth.vertices).diagonal().norm();
  EXPECT_NEAR(f.chamfer_l2_e3, 1000 * 2 * 0.047 / (diagonal * diagonal), 0.04);
  RootFigureOptions strict;
  strict.root_threshold_mm = 0.1;
  strict.surface_threshold = 0.1 / diagonal;
  EXPECT_LT(root_figures(crown_of(tooth), tooth, grown, up, strict).root_f_score, 0.01);
  EXPECT_LT(root_figures(crown_of(tooth), tooth, grown, up, strict).f_score, 0.01);
}

TEST(RootFigures, BentRootShowsInTheAxisAngle) {
  const TriangleMesh tooth = one_rooted(), crown = crown_of(tooth);
  const double level = crown_level(crown), slope = std::tan(0.1);
  const TriangleMesh tilted = changed(tooth, [=](Point p) {
    if (p.z() < level) p.x() += slope * (level - p.z());
    return p;
  });
  const RootFigures f = root_figures(crown, tooth, tilted, up);
  EXPECT_NEAR(f.root_axis_angle_deg, 0.1 * 180 / 3.14159265, 1.0);
  EXPECT_NEAR(f.root_length_error_mm, 0, 1e-12);
  EXPECT_NEAR(f.apex_distance_mm, slope * f.true_root_length_mm, 1e-9);
}

TEST(RootApices, AreFoundWithTheirProminence) {
  const TriangleMesh tooth = two_rooted();
  const auto apices = root_apices(tooth, up, 0, 1);
  ASSERT_EQ(apices.size(), 2u);
  EXPECT_LT(apices[0].point.z(), apices[1].point.z());
  EXPECT_LT(apices[0].point.x(), 0);
  EXPECT_GT(apices[1].point.x(), 0);
  EXPECT_NEAR(apices[0].prominence_mm, -apices[0].point.z(), 1e-12);  // up to the level
  EXPECT_LT(apices[1].prominence_mm, -apices[1].point.z());           // up to the furcation
  EXPECT_EQ(root_apices(tooth, up, 0, apices[1].prominence_mm + 1e-9).size(), 1u);
  EXPECT_EQ(root_apices(tooth, up, 0, apices[1].prominence_mm - 1e-9).size(), 2u);
  EXPECT_TRUE(root_apices(tooth, up, -100, 1).empty());
  EXPECT_EQ(root_apices(one_rooted(), up, 0, 1).size(), 1u);
  EXPECT_EQ(root_apices(test::tooth_with_roots({{-2.2, -1.2, 8}, {2.2, -1.2, 8}, {0, 2.4, 7}}), up, 0, 1).size(), 3u);
}

TEST(RootApices, RootsThatDoNotMeetBelowTheLevelAreSeparate) {
  const TriangleMesh two = test::together(test::sphere(3, 2), test::sphere(3, 2), {10, 0, 0});
  const auto apices = root_apices(two, up, 0, 1.5);
  ASSERT_EQ(apices.size(), 2u);
  EXPECT_NEAR(apices[0].prominence_mm, 2, 1e-12);
  EXPECT_NEAR(apices[1].prominence_mm, 2, 1e-12);
}

TEST(RootApices, UnusedVerticesAreNoRoots) {
  TriangleMesh tooth = one_rooted();
  tooth.vertices.emplace_back(0, 0, -100);
  EXPECT_EQ(root_apices(tooth, up, 0, 1).size(), 1u);
}

TEST(RootApices, EachStandsForTheNearestWhateverTheirDepth) {
  // The deeper root is the other one in the prediction: lowest vertices are far apart, matched apices are not.
  const TriangleMesh tooth = test::tooth_with_roots({{-2.2, 0, 8}, {2.2, 0, 7.6}});
  const TriangleMesh predicted = test::tooth_with_roots({{-2.2, 0, 7.4}, {2.2, 0, 8.2}});
  const RootFigures f = root_figures(crown_of(tooth), tooth, predicted, up);
  ASSERT_EQ(f.matched_apices.size(), 2u);
  EXPECT_GT(f.apex_distance_mm, 3);
  EXPECT_NEAR(f.matched_apices[0].distance_mm, 0.6, 0.1);
  EXPECT_NEAR(f.matched_apices[1].distance_mm, 0.6, 0.1);
  EXPECT_NEAR(f.matched_apex_distance_mm, 0.6, 0.1);
}

TEST(RootFigures, FurcationHeightIsWhereRootsMeet) {
  const TriangleMesh tooth = test::tooth_with_roots({{-2.2, 0, 8}, {2.2, 0, 7.6}});
  const RootFigures same = root_figures(crown_of(tooth), tooth, tooth, up);
  ASSERT_TRUE(same.furcation_height_error_mm);
  EXPECT_EQ(*same.furcation_height_error_mm, 0);
  // what lies below the crown made longer by 1.5 mm at the apex takes the furcation down by less
  const TriangleMesh longer = lengthened(tooth, crown_level(crown_of(tooth)), 1.5);
  const RootFigures moved = root_figures(crown_of(tooth), tooth, longer, up);
  EXPECT_LT(*moved.furcation_height_error_mm, -0.01);
  EXPECT_GT(*moved.furcation_height_error_mm, -1.5);
  EXPECT_FALSE(root_figures(crown_of(tooth), tooth, one_rooted(), up).furcation_height_error_mm);
}

TEST(RootApices, MissingRootShowsInTheCount) {
  const RootFigures f = root_figures(crown_of(two_rooted()), two_rooted(), one_rooted(), up);
  EXPECT_EQ(f.true_apices.size(), 2u);
  EXPECT_EQ(f.predicted_apices.size(), 1u);
  EXPECT_EQ(f.matched_apices.size(), 1u);
}

TEST(RootApices, SumOfMatchedDistancesIsLeast) {
  const auto at = [](double x) { return RootApex{{x, 0, 0}, 1}; };
  // Closest first would pair 3 with 2 and leave 0 with 10: 11 mm in all instead of 9.
  const auto pairs = match_apices({at(0), at(3)}, {at(10), at(2)});
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].predicted, 1u);
  EXPECT_EQ(pairs[1].predicted, 0u);
  EXPECT_NEAR(pairs[0].distance_mm + pairs[1].distance_mm, 9, 1e-12);
  const auto fewer = match_apices({at(0), at(5), at(9)}, {at(8.5)});
  ASSERT_EQ(fewer.size(), 1u);
  EXPECT_EQ(fewer[0].truth, 2u);
  EXPECT_TRUE(match_apices({}, {at(1)}).empty());
}

TEST(RootFigures, GrowthAxisIsThatOfTheBorder) {
  const TriangleMesh crown = test::grid(3);  // flat, facing up
  EXPECT_NEAR((crown_growth_axis(crown) - up).norm(), 0, 1e-12);
  EXPECT_THROW(crown_growth_axis(test::sphere(3)), InputError);
  EXPECT_THROW(crown_growth_axis({}), InputError);
}

TEST(RootFigures, BadInputIsRefused) {
  const TriangleMesh tooth = one_rooted(), crown = crown_of(tooth);
  TriangleMesh broken = tooth;
  broken.vertices[5].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(root_figures(crown, tooth, broken, up), InputError);
  broken = tooth;
  broken.triangles[3][1] = 1'000'000;
  EXPECT_THROW(root_figures(crown, broken, tooth, up), InputError);
  EXPECT_THROW(root_figures(crown, tooth, {}, up), InputError);
  EXPECT_THROW(root_figures({}, tooth, tooth, up), InputError);
  EXPECT_THROW(root_figures(crown, tooth, crown, up), NoResultError);
  EXPECT_THROW(root_figures(crown, crown, tooth, up), InputError);
  EXPECT_THROW(root_figures(crown, tooth, tooth, Eigen::Vector3d::Zero()), UsageError);
  RootFigureOptions few;
  few.samples = 5;
  EXPECT_THROW(root_figures(crown, tooth, tooth, up, few), UsageError);
}

/// The independent oracle beside the project, where it and its packages are.
TEST(RootFigures, AgreeWithTheIndependentJudge) {
  const std::filesystem::path judge = test::shared_folder() / "tools/judge.py";
  const std::filesystem::path cases = test::shared_folder() / "data/validation";
  if (!std::filesystem::exists(judge) || !std::filesystem::exists(cases))
    GTEST_SKIP() << "no " << judge << " or " << cases;
  if (std::system("/usr/bin/python3 -c 'import numpy, scipy' 2>/dev/null") != 0) GTEST_SKIP() << "no python3-scipy";
  const TriangleMesh crown = load_mesh(cases / "crown_36.ply").mesh, truth = load_mesh(cases / "tooth_36.ply").mesh;
  const Eigen::Vector3d axis = crown_growth_axis(crown);
  const Point centre = area_centroid(crown);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.06, axis.unitOrthogonal()).toRotationMatrix();
  MeshFile predicted;
  predicted.mesh =
      test::as_float(changed(truth, [&](const Point& p) { return Point(centre + 0.97 * (turn * (p - centre))); }));
  const auto folder = std::filesystem::temp_directory_path();
  const auto tooth_file = folder / "rhizodont_judged_tooth.ply", answer_file = folder / "rhizodont_judgement.json";
  save_mesh(tooth_file, predicted);
  const std::string command = "/usr/bin/python3 '" + judge.string() + "' '" + (cases / "crown_36.ply").string() +
                              "' '" + tooth_file.string() + "' --truth '" + (cases / "tooth_36.ply").string() +
                              "' --json '" + answer_file.string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const nlohmann::json judged = nlohmann::json::parse(std::ifstream(answer_file))["truth"];
  std::filesystem::remove(tooth_file);
  std::filesystem::remove(answer_file);

  const RootFigures ours = root_figures(crown, truth, predicted.mesh, axis);
  const auto agrees = [&](const char* name, double value, double tolerance) {
    const double theirs = judged[name];
    EXPECT_NEAR(value, theirs, tolerance * std::abs(theirs)) << name;
  };
  agrees("root_mm", ours.true_root_length_mm, 1e-6);
  agrees("root_error_mm", ours.root_length_error_mm, 1e-6);
  agrees("apex_mm", ours.apex_distance_mm, 1e-6);
  agrees("cd_l2_e3", ours.chamfer_l2_e3, 0.03);
  agrees("fscore_1pct", ours.f_score, 0.03);
  agrees("root_cd_l1_mm", ours.root_chamfer_mm, 0.03);
  agrees("root_hausdorff95_mm", ours.root_hausdorff95_mm, 0.03);
  agrees("root_f_0p5mm", ours.root_f_score, 0.03);
}

}  // namespace
}  // namespace rhizodont
