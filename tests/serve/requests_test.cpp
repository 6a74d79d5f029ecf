// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/requests.hpp"

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace rhizodont::serve {
namespace {

TEST(SentJob, HasTheOptionsOfAReport) {
  const SentJob job = read_sent_job(
      R"({"scan": "ab", "options": {"fdi": 36, "e_mm": 0.7, "skirt": 0.6, "steering": {"tip_degrees": 4}}})");
  EXPECT_EQ(job.scan, "ab");
  EXPECT_EQ(job.request.kind, JobKind::tooth);
  EXPECT_EQ(job.request.tooth.fdi, 36);
  EXPECT_EQ(job.request.tooth.e, 0.7);
  EXPECT_EQ(job.request.tooth.skirt, 0.6);
  EXPECT_EQ(job.request.tooth.steering.tip_degrees, 4);
}

TEST(SentJob, OfAnArchMendsAndDropsSkirtsUnlessSaidOtherwise) {
  const ArchOptions usual = read_sent_job(R"({"scan": "ab", "kind": "arch"})").request.arch;
  EXPECT_EQ(usual.tooth.skirt, ArchOptions::skirt_and_repair().skirt);
  EXPECT_TRUE(usual.tooth.repair);
  const JobRequest other =
      read_sent_job(R"({"scan": "ab", "kind": "arch", "options": {"skirt": "keep", "repair": false},
      "root_lengths_mm": {"11": 13.5}, "resolve_collisions": true, "clearance_mm": 0.25, "labels_are": "universal",
      "jaw": "upper", "first_label": "left", "label_array": "Label"})")
          .request;
  EXPECT_FALSE(other.arch.tooth.skirt);
  EXPECT_FALSE(other.arch.tooth.repair);
  EXPECT_EQ(other.arch.root_lengths.at(11), 13.5);
  EXPECT_TRUE(other.arch.resolve_collisions);
  EXPECT_EQ(other.arch.clearance_mm, 0.25);
  EXPECT_EQ(other.labels.numbers, LabelNumbers::universal);
  EXPECT_EQ(other.labels.jaw, Jaw::upper);
  EXPECT_EQ(other.labels.first_is_patients_right, false);
  EXPECT_EQ(other.labels.array, "Label");
}

TEST(SentJob, TakesWhatIsKnownOfTeethThatAreSearchedFor) {
  const SegmentOptions found =
      read_sent_job(R"({"scan": "ab", "kind": "arch", "missing": [14, 24], "teeth": {"36": [1, -2.5, 3]}})")
          .request.found;
  EXPECT_EQ(found.missing, (std::set<int>{14, 24}));
  EXPECT_EQ(found.teeth.at(36), Point(1, -2.5, 3));
}

TEST(SentJob, TakesWhatAPersonSaysOfLabels) {
  const std::vector<LabelCorrection> corrections =
      read_sent_job(R"({"scan": "ab", "kind": "arch", "corrections": [{"number": 36, "at": [1, -2.5, 3]},
                       {"merge": [46, 45]}, {"split": 37, "at": [0, 0, 0]}, {"remove": 18}]})")
          .request.corrections;
  using Kind = LabelCorrection::Kind;
  ASSERT_EQ(corrections.size(), 4U);
  EXPECT_EQ(corrections[0].kind, Kind::number);
  EXPECT_EQ(corrections[0].at, Point(1, -2.5, 3));
  EXPECT_EQ(corrections[1].kind, Kind::merge);
  EXPECT_EQ(corrections[1].fdi, 46);
  EXPECT_EQ(corrections[1].other, 45);
  EXPECT_EQ(corrections[2].kind, Kind::split);
  EXPECT_EQ(corrections[3].kind, Kind::remove);
  EXPECT_EQ(corrections[3].fdi, 18);
}

TEST(SentJob, WhatIsNoneIsNamed) {
  const auto expect_named = [](const char* text, const char* words) {
    try {
      read_sent_job(text);
      ADD_FAILURE() << text;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  expect_named("", "no JSON");
  expect_named("7", "must be a JSON object");
  expect_named(R"({"scan": "ab", "option": {}})", "\"option\"");
  expect_named(R"({"scan": "ab", "options": []})", "must be a JSON object");
  expect_named(R"({"scan": "ab", "options": {"e": 1}})", "\"e\"");
  expect_named(R"({"scan": "ab", "kind": "arch", "root_lengths_mm": {"19": 12}})", "19");
  expect_named(R"({"scan": "ab", "kind": "arch", "jaw": "left"})", "upper or lower");
  expect_named(R"({"scan": "ab", "kind": "arch", "missing": [19]})", "19");
  expect_named(R"({"scan": "ab", "kind": "arch", "teeth": {"36": [1, 2]}})", "teeth");
  const std::string arch = R"({"scan": "ab", "kind": "arch", "corrections": )";
  expect_named((arch + R"({"remove": 18}})").c_str(), "a list");
  expect_named((arch + R"([{"remove": 18, "at": [0, 0, 0]}]})").c_str(), "with a place");
  expect_named((arch + R"([{"split": 18}]})").c_str(), "with a place");
  expect_named((arch + R"([{"remove": 18, "merge": [36, 37]}]})").c_str(), "is one of");
  expect_named((arch + R"([{"remove": 99}]})").c_str(), "99");
  expect_named((arch + R"([7]})").c_str(), "must be a JSON object");
  expect_named(R"([[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]])", "nested too deeply");
}

TEST(SentSteering, IsReadWithItsTransition) {
  const SentSteering sent = read_sent_steering(R"({"root_length_mm": 14.5, "bend_degrees": -3, "transition_mm": 1})");
  EXPECT_EQ(sent.steering.length_mm, 14.5);
  EXPECT_EQ(sent.steering.bend_degrees, -3);
  EXPECT_EQ(sent.transition, 1);
  EXPECT_FALSE(read_sent_steering("{}").steering.any());
}

}  // namespace
}  // namespace rhizodont::serve
