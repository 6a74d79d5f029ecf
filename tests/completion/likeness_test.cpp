// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "completion/likeness.hpp"

#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>

namespace rhizodont {
namespace {

const std::filesystem::path root = RHIZODONT_SOURCE_DIR;

const Atlas& atlas() {
  static const Atlas loaded = load_atlas(root / "models" / "atlas.safetensors");
  return loaded;
}

/// Traits around a place of the type's own; those of a wrong tooth lie elsewhere.
CrownTraits drawn(int type, bool own, std::mt19937& random) {
  std::normal_distribution<float> normal;
  CrownTraits t;
  for (std::size_t i = 0; i < t.agreement.size(); ++i)
    t.agreement[i] = 0.2F * normal(random) + (own ? 0.1F * static_cast<float>(type) : 2.0F);
  for (float& offset : t.offsets) offset = 0.1F * normal(random) + (own ? 0.0F : 0.3F);
  return t;
}

std::vector<LikenessSample> drawn_samples(int per_type) {
  std::mt19937 random(7);
  std::vector<LikenessSample> samples;
  for (int i = 0; i < per_type; ++i)
    for (int type = 0; type < tooth_type_count; ++type) {
      LikenessSample sample{type, {}};
      const auto left = static_cast<std::size_t>(2 * type);
      const auto other = static_cast<std::size_t>(2 * ((type + 1 + i % 15) % tooth_type_count));
      sample.traits.push_back({left, drawn(type, true, random)});
      sample.traits.push_back({left + 1, drawn(type, false, random)});
      sample.traits.push_back({other, drawn(type, false, random)});
      samples.push_back(std::move(sample));
    }
  return samples;
}

const LikenessModel& drawn_model() {
  static const LikenessModel model = fit_likeness(drawn_samples(90));
  return model;
}

TEST(Likeness, WhatLiesWhereATypeLiesIsOfThatType) {
  for (const LikenessSample& sample : drawn_samples(5)) {
    const Likeness judged = likeness(sample.traits, drawn_model());
    EXPECT_NEAR(std::accumulate(judged.probability.begin(), judged.probability.end(), 0.0), 1, 1e-9);
    EXPECT_GT(judged.probability.front(), 0.99);
    EXPECT_LT(judged.strangeness[0], drawn_model().strange_bound * 2);
    EXPECT_GT(judged.strangeness[1], drawn_model().refused_bound);
  }
}

TEST(Likeness, StatisticsGoThroughAFile) {
  const auto file = std::filesystem::path(testing::TempDir()) / "likeness.safetensors";
  save_likeness(drawn_model(), file);
  const LikenessModel loaded = load_likeness(file);
  EXPECT_NEAR(loaded.side_bound, drawn_model().side_bound, 1e-4);
  const LikenessSample sample = drawn_samples(1).front();
  const Likeness before = likeness(sample.traits, drawn_model()), after = likeness(sample.traits, loaded);
  for (std::size_t i = 0; i < before.strangeness.size(); ++i)
    EXPECT_NEAR(after.strangeness[i], before.strangeness[i], 1e-3 * before.strangeness[i]);
  std::ofstream(file) << "nothing of the kind";
  EXPECT_THROW(load_likeness(file), InputError);
  std::filesystem::remove(file);
  EXPECT_THROW(load_likeness(file), InputError);
}

TEST(Likeness, FewCrownsAreNoStatistics) { EXPECT_THROW(fit_likeness(drawn_samples(20)), UsageError); }

TEST(CrownTraits, TheToothThatWasAskedForComesFirstAndFits) {
  const TriangleMesh crown = load_mesh(root / "samples" / "crown_36.stl").mesh;
  const std::size_t said = 2 * static_cast<std::size_t>(tooth_type_of_fdi(36));
  const auto traits = crown_traits(crown, atlas(), said);
  ASSERT_EQ(traits.front().tooth, said);
  EXPECT_EQ(traits.size(), 12U);
  EXPECT_LT(traits.front().traits.distance_mm, 1);
  EXPECT_GT(traits.front().traits.seen, 0.8);
  const std::size_t incisor = 2 * static_cast<std::size_t>(tooth_type_of_fdi(11));
  EXPECT_GT(crown_traits(crown, atlas(), incisor).front().traits.distance_mm, traits.front().traits.distance_mm);
}

TEST(CrownTraits, AreTheSameForAnyNumberOfThreadsAndAnyPlace) {
  TriangleMesh crown = load_mesh(root / "samples" / "crown_34.ply").mesh;
  const auto many = crown_traits(crown, atlas());
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto single = crown_traits(crown, atlas());
    for (std::size_t i = 0; i < many.size(); ++i) {
      EXPECT_EQ(many[i].tooth, single[i].tooth);
      EXPECT_EQ(many[i].traits.agreement, single[i].traits.agreement);
      EXPECT_EQ(many[i].traits.offsets, single[i].traits.offsets);
    }
  }
  for (Point& p : crown.vertices) p = Point(p.y(), p.z(), p.x()) + Point(30, -8, 5);
  const auto moved = crown_traits(crown, atlas(), many.front().tooth);
  EXPECT_NEAR(moved.front().traits.distance_mm, many.front().traits.distance_mm, 0.05);
}

}  // namespace
}  // namespace rhizodont
