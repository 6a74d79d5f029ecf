// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "guiding/guiding_cloud.hpp"

#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rhizodont {
namespace {

constexpr double dome_radius = 5;

TriangleMesh upper_half() { return test::dome(4, dome_radius); }

/// Points of the whole ball, moved by `shift` and disturbed.
OrientedPoints prediction(const Eigen::Vector3d& shift, double noise) {
  const SurfaceSamples samples = sample_surface(test::sphere(5, dome_radius), 3000, 3);
  OrientedPoints points{samples.points, samples.normals};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (Point& p : points.points) p += shift + noise * Eigen::Vector3d(normal(random), normal(random), normal(random));
  return points;
}

double mean_distance_from_ball(const GuidingCloud& cloud) {
  double sum = 0;
  const auto first = static_cast<std::size_t>(cloud.crown_samples);
  for (std::size_t i = first; i < cloud.samples.points.size(); ++i)
    sum += std::abs(cloud.samples.points[i].norm() - dome_radius);
  return sum / static_cast<double>(cloud.samples.points.size() - first);
}

TEST(GuidingCloud, PredictedPointsOverTheCrownAreLeftOut) {
  const TriangleMesh crown = upper_half();
  const GuidingCloud cloud = assemble_guiding_cloud(prepare_crown(crown), prediction(Eigen::Vector3d::Zero(), 0));
  EXPECT_NEAR(cloud.predicted_dropped, 1500, 150);
  for (std::size_t i = static_cast<std::size_t>(cloud.crown_samples); i < cloud.samples.points.size(); ++i)
    EXPECT_LT(cloud.samples.points[i].z(), 0);
  EXPECT_LT(mean_distance_from_ball(cloud), 0.08) << "smoothing pulls a ball of 5 mm in by little";
  ASSERT_EQ(cloud.confidence.size(), cloud.samples.points.size());
  EXPECT_GT(cloud.confidence.front(), cloud.confidence.back());
}

TEST(GuidingCloud, APredictionThatIsOffIsMovedOntoTheCrown) {
  const TriangleMesh crown = upper_half();
  const Eigen::Vector3d shift(0.5, -0.3, 0.2);
  GuidingCloudOptions uncorrected;
  uncorrected.correction_reach = 1e-9;
  const double before =
      mean_distance_from_ball(assemble_guiding_cloud(prepare_crown(crown), prediction(shift, 0), uncorrected));
  const GuidingCloud cloud = assemble_guiding_cloud(prepare_crown(crown), prediction(shift, 0));
  EXPECT_LT(mean_distance_from_ball(cloud), 0.6 * before);
  EXPECT_NEAR(cloud.prediction_error, 0.3, 0.15);
}

TEST(GuidingCloud, NoiseIsSmoothedAndNormalsPointOutward) {
  const GuidingCloud cloud =
      assemble_guiding_cloud(prepare_crown(upper_half()), prediction(Eigen::Vector3d::Zero(), 0.15));
  EXPECT_LT(mean_distance_from_ball(cloud), 0.09) << "from 0.12";
  int outward = 0;
  const auto first = static_cast<std::size_t>(cloud.crown_samples);
  for (std::size_t i = first; i < cloud.samples.points.size(); ++i)
    outward += cloud.samples.normals[i].dot(cloud.samples.points[i]) > 0;
  EXPECT_GE(outward, 0.99 * static_cast<double>(cloud.samples.points.size() - first));
}

TEST(GuidingCloud, NoRootIsAnError) {
  const TriangleMesh crown = upper_half();
  const SurfaceSamples samples = sample_surface(crown, 2000, 3);
  EXPECT_THROW(assemble_guiding_cloud(prepare_crown(crown), {samples.points, samples.normals}), NoResultError);
}

}  // namespace
}  // namespace rhizodont
