// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The finished networks (room networks) against the trainers' own forward pass, both in float, with the shipped
// weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "completion/mean_crowns.hpp"
#include "completion/registration.hpp"
#include "learning/adapointr.hpp"
#include "learning/diffusion_net.hpp"
#include "learning/with_weights.hpp"
#include "mesh/sampling.hpp"
#include "networks/completion_network.hpp"
#include "networks/surface_network.hpp"
#include "rhizodont/io.hpp"
#include "skirt/skirt_features.hpp"
#include "skirt/skirt_network.hpp"
#include "teeth/prepared_crown.hpp"

namespace rhizodont {
namespace {

const std::filesystem::path root = RHIZODONT_SOURCE_DIR;

double largest_difference(const std::vector<Eigen::Vector3f>& ours, const torch::Tensor& theirs) {
  const torch::Tensor other = theirs.contiguous();
  EXPECT_TRUE(torch::isfinite(other).all().item<bool>());
  EXPECT_EQ(static_cast<std::int64_t>(3 * ours.size()), other.numel());
  float largest = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    largest = std::max(
        largest, (ours[i] - Eigen::Map<const Eigen::Vector3f>(other.data_ptr<float>() + 3 * i)).cwiseAbs().maxCoeff());
  return static_cast<double>(largest);
}

/// Crowns as they come to the network: from the samples, and from the data folder where it is there.
struct Crown {
  std::string name;
  int fdi = 0;
  TriangleMesh mesh;
};

std::vector<Crown> crowns_of(const std::filesystem::path& folder) {
  std::vector<Crown> crowns;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("crown_") && entry.path().extension() != ".md")
      crowns.push_back({name, std::stoi(name.substr(6)), load_mesh(entry.path()).mesh});
  }
  std::sort(crowns.begin(), crowns.end(), [](const Crown& a, const Crown& b) { return a.name < b.name; });
  return crowns;
}

void expect_completion_agrees(const std::vector<Crown>& crowns) {
  const std::filesystem::path weights = root / "models" / "completion.safetensors";
  const TensorFile file = read_safetensors(weights);
  const CompletionShape shape = read_shape(file.metadata);
  AdaPoinTr trainers = with_weights(AdaPoinTr(shape), file);
  const CompletionNetwork ours = CompletionNetwork::load(weights);
  const Atlas atlas = load_atlas(root / "models" / "atlas.safetensors");
  torch::NoGradGuard no_gradient;
  for (const Crown& crown : crowns) {
    const int type = tooth_type_of_fdi(crown.fdi);
    const CrownFrame frame =
        canonical_frame(prepare_crown(crown.mesh), crown.fdi, atlas.types[static_cast<std::size_t>(type)]);
    CrownPoints input{{}, type, frame.form_axis.cast<float>()};
    std::vector<float> xyz;
    for (const Point& p : sample_surface(crown.mesh, static_cast<std::size_t>(shape.input_points), 1).points) {
      input.points.push_back(frame.frame.to_canonical(p).cast<float>());
      xyz.insert(xyz.end(), input.points.back().data(), input.points.back().data() + 3);
    }
    const CompletedPoints completed = ours.complete(input.points, type, input.form_axis);
    const Prediction expected =
        trainers->forward(make_crown_batch(shape, {xyz}, {type}, {input.form_axis.x(), input.form_axis.y()}), {}, {},
                          layers::Precision::single);
    ASSERT_EQ(static_cast<std::int64_t>(completed.points.size()), expected.fine.size(1));
    const double points = largest_difference(completed.points, expected.fine);
    EXPECT_LT(points, 1e-5) << crown.name;
    EXPECT_LT(largest_difference(completed.normals, expected.normals), 1e-4) << crown.name;
    const torch::Tensor spread = torch::exp(expected.spread).contiguous();
    for (std::size_t i = 0; i < completed.spread.size(); ++i)
      EXPECT_NEAR(completed.spread[i], spread.data_ptr<float>()[i], 1e-5F) << crown.name;
    ::testing::Test::RecordProperty(crown.name, std::to_string(points));
  }
}

void expect_skirt_agrees(const std::vector<Crown>& crowns) {
  const std::filesystem::path weights = root / "models" / "skirt.safetensors";
  const TensorFile file = read_safetensors(weights);
  const SurfaceShape shape = read_surface_shape(file.metadata);
  DiffusionNet trainers = with_weights(DiffusionNet(shape), file);
  const SurfaceNetwork ours = SurfaceNetwork::load(weights);
  torch::NoGradGuard no_gradient;
  for (const Crown& crown : crowns) {
    const SurfaceSample surface = skirt_features(decimated(crown.mesh, 3500), shape.eigenvectors);
    const std::vector<float> confidence = ours.confidence(surface);
    const torch::Tensor expected = torch::sigmoid(trainers->forward(to_tensors(surface, false))).contiguous();
    ASSERT_EQ(static_cast<std::int64_t>(confidence.size()), expected.numel());
    for (std::size_t v = 0; v < confidence.size(); ++v)
      EXPECT_NEAR(confidence[v], expected.data_ptr<float>()[v], 1e-5F) << crown.name;
  }
}

TEST(Agreement, CompletionOfTheSamples) {
  const std::vector<Crown> crowns = crowns_of(root / "samples");
  ASSERT_EQ(crowns.size(), 5U);
  expect_completion_agrees(crowns);
}

TEST(Agreement, SkirtOfTheSamples) {
  std::vector<Crown> crowns = crowns_of(root / "samples");
  crowns.push_back({"skirt_36", 36, load_mesh(root / "samples" / "skirt_36.ply").mesh});
  expect_skirt_agrees(crowns);
}

TEST(Agreement, OfRealCrowns) {
  const std::vector<Crown> crowns = crowns_of(root / "../shared/data/validation");
  if (crowns.empty()) GTEST_SKIP() << "no data in ../shared/data";
  expect_completion_agrees(crowns);
  expect_skirt_agrees(crowns);
}

}  // namespace
}  // namespace rhizodont
