// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/arch_pose.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

namespace rhizodont {
namespace {

const ArchModel& shipped() {
  static const ArchModel model =
      load_arch_model(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / "arch.safetensors");
  return model;
}

/// Teeth where the model has them, seen from another pose.
std::map<int, CrownPlace> placed(const std::vector<int>& teeth, const ArchPose& pose, bool closed = false) {
  std::map<int, CrownPlace> places;
  for (const int fdi : teeth) {
    const ArchTooth& tooth = shipped().teeth.at(fdi);
    const Eigen::Vector3d axis = closed ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                        : Eigen::Vector3d(60 * (pose.rotation * tooth.directions.occlusal));
    places[fdi] = {pose.scale * pose.rotation * tooth.place + pose.shift, axis, 150};
  }
  return places;
}

ArchPose some_pose() {
  return {Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(), 1.07, {100, -40, 7}};
}

const std::vector<int> upper{17, 16, 15, 14, 13, 12, 11, 21, 22, 23, 24, 25, 26, 27},
    lower{47, 46, 44, 43, 41, 31, 33, 35, 36, 38};

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(a.transpose() * b)).angle();
}

TEST(ArchPose, IsFoundExactlyInAnyPose) {
  const ArchPose truth = some_pose();
  for (const auto& teeth : {upper, lower, std::vector<int>{36, 37}, std::vector<int>{11, 21, 22}}) {
    for (const bool closed : {false, true}) {
      if (closed && teeth.size() < 4) continue;
      const auto found = fit_arch(shipped(), placed(teeth, truth, closed));
      ASSERT_TRUE(found) << teeth.front();
      EXPECT_LT(angle_between(found->rotation, truth.rotation), closed ? 1e-6 : 0.02) << teeth.front();
      if (closed) {
        EXPECT_NEAR(found->scale, truth.scale, 1e-6);
      }
    }
  }
}

TEST(ArchPose, OneMisplacedToothHardlyMoves) {
  const ArchPose truth = some_pose();
  auto places = placed(upper, truth);
  places[23].middle += Eigen::Vector3d(6, 5, -4);
  places[14].area_vector = -places[14].area_vector;
  const auto found = fit_arch(shipped(), places);
  ASSERT_TRUE(found);
  EXPECT_LT(angle_between(found->rotation, truth.rotation), 0.06);
}

TEST(ArchPose, IsLeftOpenWhereNothingTells) {
  EXPECT_FALSE(fit_arch(shipped(), placed({36}, some_pose(), true)));
  EXPECT_FALSE(fit_arch(shipped(), placed({36, 37}, some_pose(), true)));
}

TEST(ArchPose, RefusesWhatIsNoJaw) {
  EXPECT_THROW(fit_arch(shipped(), {}), UsageError);
  auto both = placed(upper, some_pose());
  both[31] = both[11];
  EXPECT_THROW(fit_arch(shipped(), both), UsageError);
  std::map<int, CrownPlace> milk;
  milk[55] = {};
  EXPECT_THROW(fit_arch(shipped(), milk), UsageError);
}

TEST(DirectionsInArch, AreTheModelsOwnForTheMeanArch) {
  const ArchPose truth = some_pose();
  const auto directions = directions_in_arch(shipped(), truth, placed(upper, truth));
  for (const auto& [fdi, found] : directions) {
    const ToothDirections& expected = shipped().teeth.at(fdi).directions;
    EXPECT_LT((found.occlusal - truth.rotation * expected.occlusal).norm(), 1e-6) << fdi;
    EXPECT_LT((found.buccal - truth.rotation * expected.buccal).norm(), 1e-6) << fdi;
  }
}

TEST(DirectionsInArch, FollowTheLineBetweenNeighbours) {
  const ArchPose truth = some_pose();
  auto places = placed(lower, truth);
  // 35 between 33 and 36: the line is turned by moving 33 outwards.
  const Eigen::Vector3d up = truth.rotation.col(1);
  const Point middle = places[36].middle;
  const Eigen::AngleAxisd turn(0.3, up);
  places[33].middle = middle + turn * (places[33].middle - middle);
  const auto before = directions_in_arch(shipped(), truth, placed(lower, truth)),
             after = directions_in_arch(shipped(), truth, places);
  EXPECT_NEAR(std::acos(before.at(35).buccal.dot(after.at(35).buccal)), 0.3, 0.05);
  EXPECT_NEAR(after.at(35).occlusal.dot(after.at(35).buccal), 0, 1e-12);
  EXPECT_NEAR(after.at(35).buccal.norm(), 1, 1e-12);
}

TEST(CrownPlace, OfAnOpenBoxIsAlongItsAxis) {
  TriangleMesh box;  // a cube without its floor
  box.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  box.triangles = {{4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6},
                   {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  const CrownPlace place = place_of_crown(box);
  EXPECT_LT((place.area_vector - Eigen::Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_NEAR(place.area, 5, 1e-12);
  EXPECT_LT((place.middle - Point(0.5, 0.5, 0.6)).norm(), 1e-12);
}

}  // namespace
}  // namespace rhizodont
