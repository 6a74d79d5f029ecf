// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/completion_network.hpp"

#include "common/temporary_folder.hpp"
#include "networks/safetensors.hpp"
#include "networks/sample_inputs.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>

namespace rhizodont {
namespace {

using testing::cap_points;

const CompletionNetwork& shipped() {
  static const CompletionNetwork network = CompletionNetwork::load(testing::model_file("completion.safetensors"));
  return network;
}

CompletedPoints completed(const CrownPoints& crown) {
  return shipped().complete(crown.points, crown.type, crown.form_axis);
}

void expect_same(const CompletedPoints& a, const CompletedPoints& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.spread, b.spread);
}

TEST(CompletionNetwork, SameBitsForAnyNumberOfThreads) {
  const CrownPoints crown = cap_points(1, 1024);
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, count);
    return completed(crown);
  };
  const CompletedPoints one = with_threads(1);
  for (const std::size_t count : {2U, 3U, 5U}) expect_same(with_threads(count), one);
}

TEST(CompletionNetwork, CrownsTogetherGiveTheSameBitsAsAlone) {
  std::vector<CrownPoints> crowns;
  for (unsigned i = 0; i < 5; ++i) crowns.push_back(cap_points(i, 1024 + static_cast<int>(i)));
  const std::vector<CompletedPoints> together = shipped().complete(crowns);
  ASSERT_EQ(together.size(), crowns.size());
  for (std::size_t i = 0; i < crowns.size(); ++i) expect_same(together[i], completed(crowns[i]));
  EXPECT_TRUE(shipped().complete(std::span<const CrownPoints>()).empty());
  crowns[3].points.resize(1000);
  EXPECT_THROW(shipped().complete(crowns), InputError);
  crowns[1].type = 99;
  EXPECT_THROW(shipped().complete(crowns), UsageError) << "the first that fails is the one that is told of";
}

TEST(CompletionNetwork, OrderOfPointsDoesNotMatter) {
  CrownPoints crown = cap_points(2, 1100);
  const CompletedPoints before = completed(crown);
  std::shuffle(crown.points.begin(), crown.points.end(), std::mt19937(1));
  expect_same(completed(crown), before);
  crown.type = (crown.type + 1) % 17;
  EXPECT_NE(completed(crown).points, before.points);
}

class CompletionWeights : public ::testing::Test {
 protected:
  void expect_refused(const TensorFile& file) {
    write_safetensors(folder_.path() / "weights.safetensors", file);
    EXPECT_THROW(CompletionNetwork::load(folder_.path() / "weights.safetensors"), InputError);
  }
  TensorFile good_ = read_safetensors(testing::model_file("completion.safetensors"));
  test::TemporaryFolder folder_;
};

TEST_F(CompletionWeights, FileWithoutATensorIsRefused) {
  for (const char* name : {"patches", "edge_3.norm.bias", "encoder.0.graph.centre.weight",
                           "decoder.3.cross_attention.to_query.bias", "head_spread.weight"}) {
    TensorFile bad = good_;
    ASSERT_EQ(bad.tensors.erase(name), 1U) << name;
    expect_refused(bad);
  }
}

TEST_F(CompletionWeights, TensorOfAnotherShapeOrTypeIsRefused) {
  TensorFile bad = good_;
  bad.tensors.at("head_out.weight").shape = {384, 72};
  expect_refused(bad);
  bad = good_;
  bad.tensors.at("norm_queries.weight") = store_integers(std::vector<std::int32_t>(192), {192});
  expect_refused(bad);
}

TEST_F(CompletionWeights, WhatIsNotANumberIsRefused) {
  TensorFile bad = good_;
  bad.tensors.at("head_out.bias") = store_floats(std::vector<float>(72, std::numeric_limits<float>::infinity()), {72});
  expect_refused(bad);
}

TEST_F(CompletionWeights, OtherNetworksAreRefused) {
  expect_refused(read_safetensors(testing::model_file("skirt.safetensors")));
  TensorFile bad = good_;
  bad.metadata["shape.heads"] = "5";
  expect_refused(bad);
  EXPECT_THROW(CompletionNetwork::load(folder_.path() / "none.safetensors"), InputError);
}

}  // namespace
}  // namespace rhizodont
