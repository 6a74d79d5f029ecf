// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/pose_network.hpp"

#include "completion/product_atlas.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace rhizodont {
namespace {

using test::source_folder;

const std::map<int, std::string> crowns{
    {11, "crown_11.stl"}, {16, "crown_16.ply"}, {23, "crown_23.ply"}, {34, "crown_34.ply"}, {36, "crown_36.stl"}};

TriangleMesh posed_sample(int fdi) { return load_mesh(source_folder / "samples" / crowns.at(fdi)).mesh; }

TensorFile pose_weights() { return read_safetensors(source_folder / "models" / "pose.safetensors"); }

const PoseNetwork& shipped_pose() {
  static const PoseNetwork network(pose_weights());
  return network;
}

double between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

TEST(PoseNetworkOfCrowns, DirectionsAreUnitAndTheCheekLiesAcrossTheAxis) {
  for (const auto& [fdi, name] : crowns) {
    const TriangleMesh crown = posed_sample(fdi);
    const CrownPose pose = shipped_pose().pose_of(crown, fdi);
    EXPECT_NEAR(pose.buccal.norm(), 1, 1e-9) << name;
    EXPECT_NEAR(pose.form_axis.norm(), 1, 1e-9) << name;
    EXPECT_NEAR(pose.buccal.dot(growth_axis(crown)), 0, 1e-9) << name;
    EXPECT_LT(between(pose.form_axis, growth_axis(crown)), 0.6) << name;
  }
}

TEST(PoseNetworkOfCrowns, TurnsWithTheCrown) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const auto& [fdi, name] : crowns) {
    TriangleMesh crown = posed_sample(fdi);
    const CrownPose before = shipped_pose().pose_of(crown, fdi);
    for (Point& p : crown.vertices) p = turn * p + Point(30, -20, 10);
    const CrownPose after = shipped_pose().pose_of(crown, fdi);
    EXPECT_LT(between(turn * before.buccal, after.buccal), 0.06) << name << ": the columns lie elsewhere";
    EXPECT_LT(between(turn * before.form_axis, after.form_axis), 0.03) << name;
  }
}

TEST(PoseNetworkOfCrowns, AMirroredCrownOfTheOtherSideHasTheMirroredPose) {
  for (const auto& [fdi, name] : crowns) {
    TriangleMesh crown = posed_sample(fdi);
    const CrownPose before = shipped_pose().pose_of(crown, fdi);
    for (Point& p : crown.vertices) p.x() = -p.x();
    for (Triangle& t : crown.triangles) std::swap(t[1], t[2]);
    const int other = fdi_of_type(tooth_type_of_fdi(fdi), !is_right_side(fdi));
    const CrownPose after = shipped_pose().pose_of(crown, other);
    const Eigen::Vector3d mirror(-1, 1, 1);
    EXPECT_LT(between(mirror.cwiseProduct(before.buccal), after.buccal), 0.06) << name;
    EXPECT_LT(between(mirror.cwiseProduct(before.form_axis), after.form_axis), 0.03) << name;
  }
}

TEST(PoseNetworkOfCrowns, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh crown = posed_sample(16);
  const CrownPose many = shipped_pose().pose_of(crown, 16);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CrownPose single = shipped_pose().pose_of(crown, 16);
  EXPECT_EQ(many.buccal, single.buccal);
  EXPECT_EQ(many.form_axis, single.form_axis);
}

TEST(PoseNetworkOfCrowns, WeightsThatLackALayerOrDoNotFitAreRefused) {
  for (const std::string name : {"maps.0.weight", "around.2.bias", "pose.0.weight", "pose.1.bias"}) {
    TensorFile weights = pose_weights();
    weights.tensors.erase(name);
    EXPECT_THROW(PoseNetwork{weights}, InputError) << name;
  }
  TensorFile weights = pose_weights();
  std::vector<float> bias = load_floats(weights.tensors.at("pose.1.bias"));
  bias.pop_back();
  weights.tensors["pose.1.bias"] = store_floats(bias, {static_cast<std::int64_t>(bias.size())});
  EXPECT_THROW(PoseNetwork{weights}, InputError);
  TensorFile wide = pose_weights();
  const StoredTensor& kernel = wide.tensors.at("around.1.weight");
  const std::int64_t outputs = kernel.shape[0], inputs = kernel.shape[1];
  wide.tensors["around.1.weight"] =
      store_floats(std::vector<float>(static_cast<std::size_t>(outputs * inputs * 17)), {outputs, inputs, 17});
  EXPECT_THROW(PoseNetwork{wide}, InputError) << "wider than there are places";
}

TEST(PoseNetworkOfCrowns, WeightsThatSayNoNumberAreRefused) {
  TensorFile weights = pose_weights();
  std::vector<float> values = load_floats(weights.tensors.at("pose.1.weight"));
  for (float& value : values) value = 3e38F;
  weights.tensors["pose.1.weight"] = store_floats(values, weights.tensors.at("pose.1.weight").shape);
  EXPECT_THROW(PoseNetwork{weights}.pose_of(posed_sample(36), 36), InputError);
}

TEST(PoseNetworkOfCrowns, RefusesWhatItCannotLookAt) {
  EXPECT_THROW(shipped_pose().pose_of(posed_sample(36), 19), UsageError);
  EXPECT_THROW(shipped_pose().pose_of(TriangleMesh{}, 36), InputError);
}

}  // namespace
}  // namespace rhizodont
