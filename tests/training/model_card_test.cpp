// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/model_card.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

WeightFile weights() {
  return {"some.safetensors",
          10'240'000,
          {{"shape.input_points", "1024"},
           {"shape.queries", "256"},
           {"shape.patch_points", "12"},
           {"shape.blocks", "4"},
           {"shape.width", "64"},
           {"shape.eigenvectors", "48"},
           {"training.seed", "7"},
           {"training.samples", "38224"},
           {"training.steps", "2389"},
           {"training.pool", "1800"},
           {"training.date", "2026-01-31"},
           {"validation.samples", "60"},
           {"validation.tooth_chamfer_l1_mm", "0.401"},
           {"validation.root_chamfer_l1_mm", "0.402"},
           {"validation.depth_error_mm", "0.403"},
           {"validation.normal_error_degrees", "0.404"},
           {"validation.accuracy", "0.995"},
           {"validation.intersection_over_union", "0.932"}}};
}

void expect_words(const std::string& card, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(card.find(word), std::string::npos) << word;
  EXPECT_EQ(card.find('{'), std::string::npos);
  EXPECT_EQ(card.find('}'), std::string::npos);
  EXPECT_TRUE(card.starts_with("<!--\nSPDX-FileCopyrightText"));
}

TEST(ModelCard, EveryPlaceIsFilled) {
  expect_words(completion_card(weights()),
               {"`some.safetensors`", "10.2 MB", "in go 1024 crown points", "out come 3072 points", "--seed 7",
                "38224 samples in 2389 steps", "exported on 2026-01-31", "On 60 generated teeth", "| 0.401 mm |",
                "| 0.402 mm |", "| 0.403 mm |", "| 0.404 degrees |", "`src/families`"});
  expect_words(skirt_card(weights()),
               {"`some.safetensors`", "10.2 MB", "4 blocks of width 64, 48 eigenvectors", "--pool 1800 --seed 7",
                "from a pool of 1800 crowns", "| 0.995 |", "| 0.932 |", "`src/training/skirt_sample.hpp`"});
}

TEST(ModelCard, FiguresOfWeightsThatWereNeverValidatedAreNotMeasured) {
  WeightFile never = weights();
  std::erase_if(never.metadata, [](const auto& note) { return note.first.starts_with("validation."); });
  expect_words(completion_card(never), {"| not measured mm |"});
  expect_words(skirt_card(never), {"| not measured |"});
}

TEST(ModelCard, WhatTheWeightsMustSayIsAskedFor) {
  for (const char* name : {"training.seed", "shape.queries", "shape.input_points", "training.date"}) {
    WeightFile silent = weights();
    silent.metadata.erase(name);
    EXPECT_THROW(completion_card(silent), InputError) << name;
  }
  WeightFile odd = weights();
  odd.metadata["shape.queries"] = "many";
  EXPECT_THROW(completion_card(odd), InputError);
}

TEST(ModelCard, TextsAreFilledAsTheyStand) {
  EXPECT_EQ(model_card("{a} and {b.c}, {a}", {{"a", "{b.c}"}, {"b.c", "2"}}), "{b.c} and 2, {b.c}");
  EXPECT_EQ(model_card("nothing", {}), "nothing");
  EXPECT_THROW(model_card("{unknown}", {{"a", "1"}}), InputError);
  EXPECT_THROW(model_card("open {a", {{"a", "1"}}), InputError);
}

}  // namespace
}  // namespace rhizodont
