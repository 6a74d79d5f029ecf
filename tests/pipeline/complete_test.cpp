// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/complete.hpp"

#include "base/float_bits.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::for_tooth;
using test::models;
using test::sample;
using test::source_folder;

const std::filesystem::path shared_data = source_folder / "../shared/data";

/// Vertex i of the tooth is vertex kept_vertices[i] of the crown, bit for bit, and so are the first triangles.
void expect_crown_first(const TriangleMesh& crown, const CompletedTooth& tooth) {
  const CompletionRecord& record = tooth.record;
  std::vector<int> number(crown.vertices.size(), -1);
  for (std::size_t i = 0; i < record.crown.kept_vertices.size(); ++i) {
    const Point& original = crown.vertices[static_cast<std::size_t>(record.crown.kept_vertices[i])];
    ASSERT_EQ(std::memcmp(original.data(), tooth.mesh.vertices[i].data(), sizeof(double) * 3), 0) << i;
    ASSERT_EQ(tooth.source[i], VertexSource::scan);
    number[static_cast<std::size_t>(record.crown.kept_vertices[i])] = static_cast<int>(i);
  }
  std::size_t next = 0;
  for (const Triangle& t : crown.triangles) {
    const Triangle mapped{number[static_cast<std::size_t>(t[0])], number[static_cast<std::size_t>(t[1])],
                          number[static_cast<std::size_t>(t[2])]};
    if (mapped[0] < 0 || mapped[1] < 0 || mapped[2] < 0) continue;
    ASSERT_EQ(tooth.mesh.triangles[next], mapped) << next;
    ++next;
  }
  EXPECT_EQ(static_cast<int>(next), record.crown.kept_triangles);
}

class SampleCrowns : public testing::TestWithParam<std::pair<const char*, int>> {};

TEST_P(SampleCrowns, BecomeWholeTeeth) {
  const auto [file, fdi] = GetParam();
  const TriangleMesh crown = sample(file);
  const CompletedTooth tooth = complete_tooth(crown, models(), for_tooth(fdi));
  expect_crown_first(crown, tooth);
  CheckOptions exact;
  exact.compare_as_float = false;
  const CheckReport report = check(crown, tooth.mesh, exact);
  EXPECT_TRUE(report.holds());
  EXPECT_EQ(report.crown.kept_triangles, static_cast<std::int64_t>(crown.triangles.size()));
  EXPECT_TRUE(coordinates_fit_float(tooth.mesh));
  EXPECT_GT(tooth.record.root.length_mm, 7);
  EXPECT_LT(tooth.record.root.length_mm, 22);
  EXPECT_GT(tooth.record.frame.growth_axis.dot(area_vector(crown).normalized()), 0.999);
  EXPECT_EQ(std::count(tooth.source.begin(), tooth.source.end(), VertexSource::transition),
            tooth.record.joining.transition_vertices);
}

INSTANTIATE_TEST_SUITE_P(All, SampleCrowns,
                         testing::Values(std::pair("crown_11.stl", 11), std::pair("crown_34.ply", 34),
                                         std::pair("crown_36.stl", 36), std::pair("crown_16.ply", 16)));

TEST(CompleteTooth, SameBytesForAnyNumberOfThreads) {
  const TriangleMesh crown = sample("crown_23.ply");
  // More threads than a small machine has, so that each limit is one.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  tbb::task_arena wide(8);
  const auto with = [&](int threads) {
    CompleteOptions options = for_tooth(23);
    options.threads = threads;
    int used = 0;
    const CompletedTooth tooth = wide.execute([&] {
      return complete_tooth(crown, models(), options,
                            [&](std::string_view) { used = tbb::this_task_arena::max_concurrency(); });
    });
    EXPECT_EQ(used, threads == 0 ? 8 : threads);
    return tooth;
  };
  const CompletedTooth one = with(1);
  for (const int threads : {3, 0}) {
    const CompletedTooth more = with(threads);
    EXPECT_EQ(one.mesh.triangles, more.mesh.triangles);
    EXPECT_EQ(one.mesh.vertices, more.mesh.vertices);
  }
}

TEST(CompleteTooth, TheUnitOfTheInputIsThatOfTheOutput) {
  TriangleMesh crown = sample("crown_34.ply");
  for (Point& p : crown.vertices) p *= 1e-3;
  EXPECT_THROW(complete_tooth(crown, models(), for_tooth(34)), InputError);
  CompleteOptions options = for_tooth(34);
  options.millimetres_per_unit = 1000;
  const CompletedTooth tooth = complete_tooth(crown, models(), options);
  expect_crown_first(crown, tooth);
  EXPECT_LT(bounding_box(tooth.mesh.vertices).sizes().maxCoeff(), 0.03);
  EXPECT_GT(tooth.record.root.length_mm, 7) << "the report is in millimetres";
}

TEST(CompleteTooth, FarFromTheOriginTheToothIsTheSame) {
  const TriangleMesh crown = sample("crown_34.ply");
  const CompletedTooth near = complete_tooth(crown, models(), for_tooth(34));
  for (const Point& away : {Point(8e4, -3e4, 5e4), Point(1e6, 0, 0), Point(-2e8, 1e8, 7)}) {
    TriangleMesh moved = crown;
    for (Point& p : moved.vertices) p += away;
    const CompletedTooth tooth = complete_tooth(moved, models(), for_tooth(34));
    expect_crown_first(moved, tooth);
    EXPECT_TRUE(check(moved, tooth.mesh).holds());
    EXPECT_NEAR(tooth.record.root.length_mm, near.record.root.length_mm, 0.2) << away.transpose();
    EXPECT_LT((tooth.record.frame.centre - near.record.frame.centre - away).norm(), 1e-2);
  }
}

TEST(CompleteTooth, FarFromTheOriginSinglePrecisionStays) {
  // Floats are 0.06 and 8 micrometres apart there: enough for triangles of half a millimetre.
  for (const Point& away : {Point(700, -200, 600), Point(1e4, 8e4, -8e4)}) {
    SCOPED_TRACE(away.transpose());
    TriangleMesh crown = sample("crown_34.ply");
    for (Point& p : crown.vertices) p = nearest_float(Point(p + away));
    ASSERT_TRUE(coordinates_fit_float(crown));
    const CompletedTooth tooth = complete_tooth(crown, models(), for_tooth(34));
    expect_crown_first(crown, tooth);
    EXPECT_TRUE(coordinates_fit_float(tooth.mesh));
    for (const std::string& warning : tooth.record.warnings)
      EXPECT_EQ(warning.find("double precision"), std::string::npos) << warning;
  }
}

TEST(CompleteTooth, FarFromTheOriginWhatKeepsNoPromiseIsRefused) {
  // Doubles are an eighth of a millimetre apart there: the crown still is a surface, but new triangles of a quarter of
  // a millimetre come to cross each other.
  TriangleMesh crown = sample("crown_34.ply");
  for (Point& p : crown.vertices) p += Point(1e15, 1e15, 1e15);
  try {
    complete_tooth(crown, models(), for_tooth(34));
    ADD_FAILURE() << "not refused";
  } catch (const NoResultError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("No tooth was found that keeps the promises: "))
        << error.what();
  }
}

TEST(CompleteTooth, MicrometresFarFromTheOrigin) {
  TriangleMesh crown = sample("crown_34.ply");
  for (Point& p : crown.vertices) p = 1e3 * p + Point(3e6, 0, -4e6);
  CompleteOptions options = for_tooth(34);
  options.millimetres_per_unit = 1e-3;
  const CompletedTooth tooth = complete_tooth(crown, models(), options);
  expect_crown_first(crown, tooth);
  EXPECT_GT(tooth.record.root.length_mm, 7);
  EXPECT_GT(bounding_box(tooth.mesh.vertices).sizes().maxCoeff(), 1e4) << "in micrometres as the input";
}

TEST(CompleteTooth, WithoutANumberTheTypeIsGuessedAndSaid) {
  const CompletedTooth tooth = complete_tooth(sample("crown_36.stl"), models());
  EXPECT_TRUE(tooth.record.fdi_guessed);
  EXPECT_GE(tooth.record.fdi % 10, 6) << "a molar";
  ASSERT_FALSE(tooth.record.warnings.empty());
  EXPECT_NE(tooth.record.warnings.front().find(std::to_string(tooth.record.fdi)), std::string::npos);
}

TEST(CompleteTooth, ClosedMeshesWithoutACapAreRefused) {
  EXPECT_THROW(complete_tooth(test::sphere(4, 4), models(), for_tooth(36)), InputError);
  CompleteOptions keep = for_tooth(36);
  keep.cap = CapHandling::keep;
  EXPECT_THROW(complete_tooth(test::sphere(4, 4), models(), keep), InputError);
  const CompletedTooth tooth = complete_tooth(sample("crown_34.ply"), models(), for_tooth(34));
  EXPECT_THROW(complete_tooth(tooth.mesh, models(), for_tooth(34)), InputError) << "a whole tooth";
}

TEST(CompleteTooth, CallsSideBySideKeepTheirOwnLimits) {
  const TriangleMesh crown = sample("crown_34.ply");
  const auto process_wide = [] {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  };
  const std::size_t before = process_wide();
  const int all = tbb::this_task_arena::max_concurrency();
  const std::vector<int> limits{1, 2, 0};
  std::barrier meet(static_cast<std::ptrdiff_t>(limits.size()));
  const auto run = [&](int limit) {
    CompleteOptions options = for_tooth(34);
    options.e = 1;
    options.threads = limit;
    const int expected = limit == 0 ? all : std::min(limit, all);
    return complete_tooth(crown, models(), options, [&, first = true](std::string_view stage) mutable {
      if (std::exchange(first, false)) meet.arrive_and_wait();  // all are under way
      EXPECT_EQ(tbb::this_task_arena::max_concurrency(), expected) << stage;
      EXPECT_EQ(process_wide(), before) << stage;
    });
  };
  std::vector<std::future<CompletedTooth>> calls;
  for (const int limit : limits) calls.push_back(std::async(std::launch::async, run, limit));
  const CompletedTooth one = calls[0].get();
  for (std::size_t i = 1; i < calls.size(); ++i) {
    const CompletedTooth other = calls[i].get();
    EXPECT_EQ(other.mesh.vertices, one.mesh.vertices) << limits[i];
    EXPECT_EQ(other.mesh.triangles, one.mesh.triangles) << limits[i];
  }
}

TEST(CompleteTooth, OptionsOutOfRange) {
  const TriangleMesh crown = sample("crown_34.ply");
  CompleteOptions options = for_tooth(34);
  options.e = 0.01;
  EXPECT_THROW(complete_tooth(crown, models(), options), UsageError);
  EXPECT_THROW(complete_tooth(crown, models(), for_tooth(39)), UsageError);
  EXPECT_THROW(complete_tooth(crown, models(), for_tooth(51)), UsageError);
  options = for_tooth(34);
  options.threads = -1;
  EXPECT_THROW(complete_tooth(crown, models(), options), UsageError);
}

TEST(CompleteTooth, OptionsAreCheckedBeforeTheFirstStage) {
  const TriangleMesh crown = sample("crown_34.ply");
  const ProgressCallback no_stage = [](std::string_view stage) { FAIL() << stage; };
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const std::vector<std::function<void(CompleteOptions&)>> faults{
      [](CompleteOptions& o) { o.skirt = 0.0; },
      [](CompleteOptions& o) { o.skirt = 1.0; },
      [&](CompleteOptions& o) { o.skirt = nan; },
      [](CompleteOptions& o) { o.e = 2.1; },
      [&](CompleteOptions& o) { o.e = nan; },
      [](CompleteOptions& o) { o.transition = 5.1; },
      [](CompleteOptions& o) { o.millimetres_per_unit = 0; },
      [&](CompleteOptions& o) { o.millimetres_per_unit = infinite; },
      [](CompleteOptions& o) { o.threads = -1; },
      [](CompleteOptions& o) { o.steering.length_mm = 31; },
      [&](CompleteOptions& o) { o.steering.length_mm = nan; },
      [](CompleteOptions& o) { o.steering.tip_degrees = -31; },
      [](CompleteOptions& o) { o.steering.torque_degrees = 31; },
      [](CompleteOptions& o) { o.steering.bend_degrees = 46; },
      [](CompleteOptions& o) { o.fdi = 19; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    CompleteOptions options = for_tooth(34);
    faults[i](options);
    EXPECT_THROW(complete_tooth(crown, models(), options, no_stage), UsageError) << i;
  }
  CompleteOptions steered = for_tooth(34);
  steered.steering.length_mm = 14;
  EXPECT_THROW(complete_candidates(crown, models(), 2, steered, no_stage), UsageError);
}

TEST(CompleteTooth, AnExceptionFromTheProgressCallbackCancelsItAtEveryStage) {
  struct Cancelled {
    std::string at;
  };
  const TriangleMesh crown = sample("crown_34.ply");
  CompleteOptions options = for_tooth(34);
  options.e = 2;
  std::vector<std::string> stages;
  const CompletedTooth whole =
      complete_tooth(crown, models(), options, [&](std::string_view stage) { stages.emplace_back(stage); });
  ASSERT_GT(stages.size(), 5U);
  for (std::size_t last = 0; last < stages.size(); ++last) {
    std::size_t begun = 0;
    try {
      complete_tooth(crown, models(), options, [&](std::string_view stage) {
        if (begun++ == last) throw Cancelled{std::string(stage)};
      });
      ADD_FAILURE() << "not cancelled at " << stages[last];
    } catch (const Cancelled& cancelled) {
      EXPECT_EQ(cancelled.at, stages[last]);
      EXPECT_EQ(begun, last + 1) << "no stage begins after the call is cancelled";
    }
  }
  EXPECT_EQ(complete_tooth(crown, models(), options).mesh.vertices, whole.mesh.vertices);
}

TEST(CompleteTooth, AnErrorFromTheProgressCallbackIsNotTakenForTheWorksOwn) {
  const TriangleMesh crown = sample("crown_34.ply");
  CompleteOptions options = for_tooth(34);
  options.e = 2;
  // More vertices and triangles than the crown has: numbers that a part of it would translate or leave out.
  const std::vector<std::int64_t> ids{3, 1'000'000};
  for (const char* at : {"crown", "orientation", "joining", "check"}) {
    SCOPED_TRACE(at);
    const auto refuse = [&](std::string_view stage) {
      if (stage == at) throw InputError("Refused by the caller.", ids, ElementKind::vertices);
    };
    const auto give_up = [&](std::string_view stage) {
      if (stage == at) throw NoResultError("Given up by the caller.", ids, ElementKind::triangles);
    };
    try {
      complete_tooth(crown, models(), options, refuse);
      ADD_FAILURE() << "not cancelled";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "Refused by the caller.");
      EXPECT_EQ(error.elements(), ids);
    }
    try {
      complete_tooth(crown, models(), options, give_up);
      ADD_FAILURE() << "not cancelled";
    } catch (const NoResultError& error) {
      EXPECT_STREQ(error.what(), "Given up by the caller.");
      EXPECT_EQ(error.elements(), ids);
    }
  }
}

TEST(CompleteTooth, ARealCappedCrownIsOpenedAndCompleted) {
  const auto file = shared_data / "crowns/patient0/crown_16.ply";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real crowns at " << file;
  const TriangleMesh crown = load_mesh(file).mesh;
  const CompletedTooth tooth = complete_tooth(crown, models(), for_tooth(16));
  EXPECT_TRUE(tooth.record.crown.cap_dropped);
  expect_crown_first(crown, tooth);
  EXPECT_TRUE(check(crown, tooth.mesh).holds());
  EXPECT_GT(tooth.record.crown.kept_triangles, 0.55 * tooth.record.crown.triangles);
  EXPECT_LT(tooth.record.frame.growth_axis.y(), -0.9) << "upper teeth of this scan hang from above";
}

}  // namespace
}  // namespace rhizodont
