// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/arch.hpp"

#include "arch/arch_memory.hpp"
#include "common/temporary_folder.hpp"
#include "mesh/closest_point.hpp"
#include "pipeline/report_parts.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

const std::filesystem::path samples = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "samples";

const CompletionModels& models() {
  static const CompletionModels shipped =
      CompletionModels::load(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models");
  return shipped;
}

/// Some crowns side by side in one scan, with a patch of gum. `apart`: their middles, mm
LabelledScan row_of(const std::vector<std::pair<const char*, int>>& crowns, double apart = 14) {
  LabelledScan scan;
  double x = 0;
  for (const auto& [file, fdi] : crowns) {
    const TriangleMesh crown = load_mesh(samples / file).mesh;
    const auto before = static_cast<std::int32_t>(scan.mesh.vertices.size());
    Eigen::AlignedBox3d box;
    for (const Point& p : crown.vertices) box.extend(p);
    for (const Point& p : crown.vertices) scan.mesh.vertices.push_back(p - box.center() + Point(x, 0, 0));
    for (Triangle t : crown.triangles) {
      for (std::int32_t& v : t) v += before;
      scan.mesh.triangles.push_back(t);
    }
    scan.fdi.resize(scan.mesh.vertices.size(), fdi);
    x += apart;
  }
  const auto n = static_cast<std::int32_t>(scan.mesh.vertices.size());
  for (const Point& p : {Point(0, 20, 0), Point(1, 20, 0), Point(0, 21, 0)}) scan.mesh.vertices.push_back(p);
  scan.mesh.triangles.push_back({n, n + 1, n + 2});
  scan.fdi.resize(scan.mesh.vertices.size(), 0);
  return scan;
}

TEST(CompleteArch, EveryToothKeepsThePromisesAndRefersToItsCrown) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}, {"crown_36.stl", 75}});
  std::vector<int> told;
  const CompletedArch arch = complete_arch(scan, models(), {}, [&](int done, int teeth, int fdi) {
    EXPECT_EQ(teeth, 3);
    EXPECT_EQ(done, static_cast<int>(told.size()) + 1);
    told.push_back(fdi);
  });
  EXPECT_EQ(told.size(), 3U);
  EXPECT_EQ(arch.gum.triangles.size(), 1U);
  ASSERT_EQ(arch.teeth.size(), 3U);
  for (const ToothOfArch& tooth : arch.teeth) {
    for (std::size_t v = 0; v < tooth.crown.vertices.size(); ++v)
      EXPECT_EQ(tooth.crown.vertices[v], scan.mesh.vertices[static_cast<std::size_t>(tooth.scan_vertices[v])]);
    if (tooth.fdi == 75) {
      EXPECT_FALSE(tooth.tooth);
      EXPECT_NE(tooth.refusal.find("milk"), std::string::npos) << tooth.refusal;
      continue;
    }
    ASSERT_TRUE(tooth.tooth) << tooth.fdi << ": " << tooth.refusal;
    EXPECT_TRUE(tooth.tooth->record.promises.holds());
    EXPECT_TRUE(tooth.tooth->options.directions);
    EXPECT_GT(tooth.tooth->record.root.length_mm, 5);
    const LongAxes axes = long_axes(*tooth.tooth);
    EXPECT_NEAR(axes.root.direction.norm(), 1, 1e-9);
    EXPECT_GT(axes.root.direction.dot(axes.crown.direction), 0.8) << tooth.fdi;
    EXPECT_GT((axes.root.to - axes.root.from).norm(), 4) << tooth.fdi;
  }
}

void expect_same(const CompletedArch& a, const CompletedArch& b) {
  ASSERT_EQ(a.teeth.size(), b.teeth.size());
  for (std::size_t i = 0; i < a.teeth.size(); ++i) {
    ASSERT_EQ(a.teeth[i].tooth.has_value(), b.teeth[i].tooth.has_value());
    EXPECT_EQ(a.teeth[i].refusal, b.teeth[i].refusal);
    if (!a.teeth[i].tooth) continue;
    EXPECT_EQ(a.teeth[i].tooth->mesh.vertices, b.teeth[i].tooth->mesh.vertices) << a.teeth[i].fdi;
    EXPECT_EQ(a.teeth[i].tooth->mesh.triangles, b.teeth[i].tooth->mesh.triangles);
    EXPECT_EQ(a.teeth[i].clearance, b.teeth[i].clearance);
  }
}

TEST(CompleteArch, MemoryGivesTheVerySame) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}, {"crown_36.stl", 75}});
  ArchMemory memory;
  ArchOptions options;
  options.tooth.e = 1;
  const CompletedArch first = complete_arch(scan, models(), options, {}, memory);
  EXPECT_EQ(memory.teeth.size(), 3U);
  expect_same(complete_arch(scan, models(), options, {}, memory), first);
  options.root_lengths[36] = 11;
  expect_same(complete_arch(scan, models(), options, {}, memory), complete_arch(scan, models(), options));
  LabelledScan other = scan;
  for (int& label : other.fdi) label = label == 34 ? 35 : label;
  expect_same(complete_arch(other, models(), options, {}, memory), complete_arch(other, models(), options));
  options.root_lengths = {};
  options.tooth.e = 0.8;
  expect_same(complete_arch(other, models(), options, {}, memory), complete_arch(other, models(), options));
}

TEST(CompleteArch, MemoryKeepsTeethAsTheyWereBeforeTheyGaveWay) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}}, 7.5);
  ArchMemory memory;
  ArchOptions options;
  options.tooth.e = 1;
  const CompletedArch before = complete_arch(scan, models(), options, {}, memory);
  options.resolve_collisions = true;
  const CompletedArch resolved = complete_arch(scan, models(), options, {}, memory);
  expect_same(resolved, complete_arch(scan, models(), options));
  for (std::size_t i = 0; i < 2; ++i) {
    const ToothOfArch& tooth = resolved.teeth[i];
    ASSERT_TRUE(tooth.tooth && before.teeth[i].tooth) << tooth.fdi << ": " << tooth.refusal;
    const CompletionRecord& record = tooth.tooth->record;
    EXPECT_TRUE(std::any_of(record.warnings.begin(), record.warnings.end(), [](const std::string& warning) {
      return warning.find("gave way") != std::string::npos;
    })) << tooth.fdi;
    EXPECT_FALSE(tooth.tooth->mesh.vertices == before.teeth[i].tooth->mesh.vertices);
    CheckOptions exact;
    exact.compare_as_float = false;
    exact.dropped_vertices = vertices_not_of_tooth(record);
    EXPECT_TRUE(check(tooth.crown, tooth.tooth->mesh, exact).holds());
  }
  options.resolve_collisions = false;
  expect_same(complete_arch(scan, models(), options, {}, memory), before);
}

TEST(CompleteArch, AToothThatWouldStandUpsideDownIsRefused) {
  LabelledScan scan = row_of({{"crown_36.stl", 37}, {"crown_36.stl", 36}, {"crown_34.ply", 35}, {"crown_34.ply", 34}});
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < scan.fdi.size(); ++v)
    if (scan.fdi[v] == 36) box.extend(scan.mesh.vertices[v]);
  for (std::size_t v = 0; v < scan.fdi.size(); ++v)  // half a turn about x
    if (scan.fdi[v] == 36)
      scan.mesh.vertices[v].tail<2>() = 2 * box.center().tail<2>() - scan.mesh.vertices[v].tail<2>();
  ArchOptions options;
  options.tooth.e = 1.5;
  const CompletedArch arch = complete_arch(scan, models(), options);
  for (const ToothOfArch& tooth : arch.teeth) {
    EXPECT_EQ(tooth.tooth.has_value(), tooth.fdi != 36) << tooth.refusal;
    if (tooth.fdi == 36) {
      EXPECT_NE(tooth.refusal.find("degrees off"), std::string::npos) << tooth.refusal;
    }
  }
}

TEST(CompleteArch, IsCancelledByWhatTheCallbackThrows) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}, {"crown_36.stl", 75}});
  ArchOptions options;
  options.tooth.e = 1.5;
  ArchMemory memory;
  struct Cancelled {};
  for (int after = 1; after <= 3; ++after)
    EXPECT_THROW(complete_arch(
                     scan, models(), options,
                     [&](int done, int, int) {
                       if (done >= after) throw Cancelled{};
                     },
                     memory),
                 Cancelled);
  EXPECT_TRUE(memory.teeth.empty());
}

TEST(CompleteArch, IsTheSameForAnyNumberOfThreads) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}});
  ArchOptions one;
  one.tooth.threads = 1;
  const CompletedArch a = complete_arch(scan, models(), one), b = complete_arch(scan, models());
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(a.teeth[i].tooth && b.teeth[i].tooth);
    EXPECT_EQ(a.teeth[i].tooth->mesh.vertices, b.teeth[i].tooth->mesh.vertices);
    EXPECT_EQ(a.teeth[i].tooth->mesh.triangles, b.teeth[i].tooth->mesh.triangles);
  }
}

/// The same scan with its elements the other way round, and triangles beginning elsewhere.
LabelledScan reversed(const LabelledScan& scan) {
  LabelledScan result = scan;
  std::reverse(result.mesh.vertices.begin(), result.mesh.vertices.end());
  std::reverse(result.fdi.begin(), result.fdi.end());
  std::reverse(result.mesh.triangles.begin(), result.mesh.triangles.end());
  const auto last = static_cast<std::int32_t>(scan.mesh.vertices.size()) - 1;
  for (Triangle& t : result.mesh.triangles) t = {last - t[1], last - t[2], last - t[0]};
  return result;
}

using CornerPlaces = std::array<std::array<double, 3>, 3>;

std::multiset<CornerPlaces> triangles_of(const TriangleMesh& mesh) {
  std::multiset<CornerPlaces> triangles;
  for (const Triangle& t : mesh.triangles) {
    CornerPlaces corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& p = mesh.vertices[static_cast<std::size_t>(t[i])];
      corners[i] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.insert(corners);
  }
  return triangles;
}

TEST(CompleteArch, TheOrderOfAScansElementsHasNoSay) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}});
  const CompletedArch a = complete_arch(scan, models()), b = complete_arch(reversed(scan), models());
  ASSERT_EQ(b.teeth.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const ToothOfArch &first = a.teeth[i], &second = b.teeth[i];
    ASSERT_TRUE(first.tooth && second.tooth);
    ASSERT_TRUE(first.tooth->options.directions);
    EXPECT_EQ(triangles_of(first.tooth->mesh), triangles_of(second.tooth->mesh)) << first.fdi;
    // Each as its own scan has it: vertices and triangles of the crown in its order, beginning with the same corner.
    for (const ToothOfArch* tooth : {&first, &second}) {
      const std::vector<int>& kept = tooth->tooth->record.crown.kept_vertices;
      EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
      std::vector<Triangle> of_crown;
      for (Triangle t : tooth->tooth->mesh.triangles) {
        if (std::any_of(t.begin(), t.end(), [&](int v) { return static_cast<std::size_t>(v) >= kept.size(); }))
          continue;
        for (std::int32_t& v : t) v = kept[static_cast<std::size_t>(v)];
        of_crown.push_back(t);
      }
      auto next = tooth->crown.triangles.begin();
      bool in_order = of_crown.size() > 500;
      for (const Triangle& t : of_crown) {
        next = std::find(next, tooth->crown.triangles.end(), t);
        in_order = in_order && next != tooth->crown.triangles.end();
        if (!in_order) break;
        ++next;
      }
      EXPECT_TRUE(in_order);
    }
  }
}

TEST(CompleteArch, TheScansPoseHasNoSay) {
  LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}});
  const Eigen::Isometry3d move =
      Eigen::Translation3d(40, -700, 9) * Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -1).normalized());
  const CompletedArch a = complete_arch(scan, models());
  for (Point& p : scan.mesh.vertices) p = move * p;
  const CompletedArch b = complete_arch(scan, models());
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(a.teeth[i].tooth && b.teeth[i].tooth);
    const CompletedTooth &first = *a.teeth[i].tooth, &second = *b.teeth[i].tooth;
    EXPECT_NEAR(first.record.root.length_mm, second.record.root.length_mm, 0.02);
    EXPECT_NEAR((move.linear() * first.record.frame.growth_axis - second.record.frame.growth_axis).norm(), 0, 1e-4);
    EXPECT_NEAR((move * first.record.frame.centre - second.record.frame.centre).norm(), 0, 1e-3);
    EXPECT_NEAR((first.record.frame.rotation - second.record.frame.rotation * move.linear()).norm(), 0, 1e-4);
    const ClosestPointIndex index(first.mesh);
    double sum = 0;
    for (const Point& p : second.mesh.vertices) sum += index.closest(move.inverse() * p).distance;
    EXPECT_LT(sum / static_cast<double>(second.mesh.vertices.size()), 0.01) << a.teeth[i].fdi;
  }
}

TEST(CompleteArch, AMeasuredLengthIsKeptAndMovesTheOthers) {
  const LabelledScan scan = row_of({{"crown_36.stl", 36}, {"crown_34.ply", 34}});
  const CompletedArch alone = complete_arch(scan, models());
  ASSERT_TRUE(alone.teeth[0].tooth && alone.teeth[1].tooth);
  const double other = alone.teeth[0].tooth->record.root.length_mm,
               measured = alone.teeth[1].tooth->record.root.length_mm + 2;
  ArchOptions options;
  options.root_lengths[36] = measured;
  const CompletedArch arch = complete_arch(scan, models(), options);
  ASSERT_TRUE(arch.teeth[0].tooth && arch.teeth[1].tooth);
  EXPECT_NEAR(arch.teeth[1].tooth->record.root.length_mm, measured, 0.3);
  EXPECT_GT(arch.teeth[0].tooth->record.root.length_mm, other + 0.1);
  const auto &before = alone.teeth[0].tooth->record.root.interval, &after = arch.teeth[0].tooth->record.root.interval;
  ASSERT_TRUE(before && after);
  EXPECT_LT(after->length_high_mm - after->length_low_mm, before->length_high_mm - before->length_low_mm);
  EXPECT_FALSE(arch.teeth[1].tooth->record.root.interval);
  options.root_lengths = {{47, 14.0}};
  EXPECT_THROW(complete_arch(scan, models(), options), UsageError);
}

TEST(CompleteArch, RefusesWhatIsNoArch) {
  LabelledScan scan = row_of({{"crown_34.ply", 34}});
  LabelledScan none = scan;
  std::fill(none.fdi.begin(), none.fdi.end(), 0);
  EXPECT_THROW(complete_arch(none, models()), InputError);
  LabelledScan metres = scan;
  for (Point& p : metres.mesh.vertices) p /= 1000;
  EXPECT_THROW(complete_arch(metres, models()), InputError);
  LabelledScan shorter = scan;
  shorter.fdi.pop_back();
  EXPECT_THROW(complete_arch(shorter, models()), InputError);
  ArchOptions options;
  options.tooth.fdi = 36;
  EXPECT_THROW(complete_arch(scan, models(), options), UsageError);
  options = {};
  options.root_lengths[34] = 99;
  EXPECT_THROW(complete_arch(scan, models(), options), UsageError);
}

TEST(CompleteArch, ModelsWithoutASkirtNetworkAreSaidAtOnce) {
  const test::TemporaryFolder folder;
  for (const char* name : {"completion.safetensors", "atlas.safetensors", "arch.safetensors"})
    std::filesystem::create_symlink(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / name,
                                    folder.path() / name);
  const LabelledScan scan = row_of({{"crown_34.ply", 74}});
  EXPECT_THROW(complete_arch(scan, CompletionModels::load(folder.path())), InputError);
  std::filesystem::remove(folder.path() / "arch.safetensors");
  ArchOptions options;
  options.tooth.skirt.reset();
  EXPECT_THROW(complete_arch(scan, CompletionModels::load(folder.path()), options), InputError);
}

TEST(CompleteArch, SizesOfArchesDependOnTheirTeeth) {
  EXPECT_TRUE(has_size_of_arch(70, 14));
  EXPECT_TRUE(has_size_of_arch(8, 1));
  EXPECT_FALSE(has_size_of_arch(7, 14));  // centimetres
  EXPECT_FALSE(has_size_of_arch(0.07, 14));
  EXPECT_FALSE(has_size_of_arch(700, 14));
}

TEST(CompleteArch, WhatProgressThrowsComesThrough) {
  const LabelledScan scan = row_of({{"crown_34.ply", 74}, {"crown_34.ply", 84}});
  EXPECT_THROW(complete_arch(scan, models(), {}, [](int, int, int) { throw std::runtime_error("stop"); }),
               std::runtime_error);
}

}  // namespace
}  // namespace rhizodont
