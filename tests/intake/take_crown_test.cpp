// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/take_crown.hpp"

#include "common/closed_bases.hpp"
#include "common/hostile_crowns.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/repair.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "pipeline/models.hpp"
#include "pipeline/product_models.hpp"
#include "pipeline/report_parts.hpp"
#include "pipeline/way_out.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

using test::models;
using test::source_folder;

TakenCrown taken(const TriangleMesh& crown, const CompleteOptions& options) {
  return take_crown(crown, content_of(models())->atlas, content_of(models())->skirt, options);
}

/// A crown closed by a fan from one corner of its border, which is no plane: the fan meets the crown.
TriangleMesh crown_with_cutting_cap(const char* name) {
  TriangleMesh closed = test::closed_base(load_mesh(source_folder / "samples" / name).mesh, "corner fan").mesh;
  EXPECT_FALSE(self_intersecting_triangles(closed).empty());
  return closed;
}

TEST(MadeCap, GoesBeforeItsCutsAreTakenOut) {
  for (const auto& [name, fdi] : {std::pair{"crown_11.stl", 11}, std::pair{"crown_34.ply", 34}}) {
    SCOPED_TRACE(name);
    const TriangleMesh closed = crown_with_cutting_cap(name);
    const TakenCrown as_it_is = taken(closed, test::for_tooth(fdi));
    for (const bool skirt : {false, true}) {
      CompleteOptions options = test::for_tooth(fdi);
      options.repair = !skirt;
      if (skirt) options.skirt = 0.5;
      const auto [kept, record] = taken(closed, options);
      EXPECT_EQ(kept.old_vertices, as_it_is.kept.old_vertices);
      EXPECT_EQ(kept.old_triangles, as_it_is.kept.old_triangles);
      EXPECT_TRUE(record.cap_dropped);
      ASSERT_EQ(record.repairs.size(), 1U);
      EXPECT_EQ(record.repairs.front().triangles, as_it_is.record.repairs.front().triangles);
    }
  }
}

TEST(MadeCap, IsKnownOnceTheTrianglesHangTogether) {
  TriangleMesh crown = crown_with_cutting_cap("crown_11.stl");
  const TakenCrown whole = taken(crown, test::for_tooth(11));
  // Turned over in places, one triangle twice, and a vertex that stands beside its twin.
  for (std::size_t t = 0; t < 300; ++t) std::swap(crown.triangles[t][1], crown.triangles[t][2]);
  crown.triangles.push_back(crown.triangles[1000]);
  const std::int32_t split = crown.triangles[2000][0];
  crown.vertices.push_back(crown.vertices[static_cast<std::size_t>(split)]);
  crown.triangles[2000][0] = static_cast<std::int32_t>(crown.vertices.size()) - 1;

  CompleteOptions options = test::for_tooth(11);
  options.repair = true;
  options.e = 1;
  const CompletedTooth tooth = complete_tooth(crown, models(), options);
  EXPECT_EQ(tooth.record.crown.kept_vertices, whole.kept.old_vertices);
  EXPECT_TRUE(tooth.record.crown.cap_dropped);
  EXPECT_EQ(tooth.record.repairs.back().triangles, whole.record.repairs.front().triangles);
  std::size_t turned = 0;
  for (const RepairStep& step : tooth.record.repairs)
    if (step.action == RepairAction::turned_over) turned += step.triangles.size();
  EXPECT_EQ(turned, 300U);
  CheckOptions exact = allowing_for(tooth.record.repairs);
  exact.compare_as_float = false;
  exact.dropped_vertices = vertices_not_of_tooth(tooth.record);
  const CheckReport report = check(crown, tooth.mesh, exact);
  EXPECT_TRUE(report.holds()) << (report.failures.empty() ? "" : report.failures.front());
}

TEST(ClosedCrown, ThatIsSoundIsNotOpenedByItsRepair) {
  const std::filesystem::path folder = source_folder / "../shared/data/lower_scan";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real crowns at " << folder;
  for (const int fdi : {31, 46}) {
    const TriangleMesh closed = load_mesh(folder / fmt::format("crown_{}.ply", fdi)).mesh;
    ASSERT_TRUE(diagnose(closed).border_edges.empty());
    // What it takes for a spike is none of the base's.
    EXPECT_FALSE(diagnose(repair(closed).mesh).border_edges.empty());
    CompleteOptions options = test::for_tooth(fdi);
    const TakenCrown as_it_is = taken(closed, options);
    options.repair = true;
    const TakenCrown repaired = taken(closed, options);
    EXPECT_TRUE(repaired.record.cap_dropped);
    EXPECT_EQ(repaired.kept.old_vertices, as_it_is.kept.old_vertices);
  }
}

/// The options that a refusal of the crown names.
std::string hint_at(const TriangleMesh& crown, const CompleteOptions& options, ErrorCode code) {
  try {
    complete_tooth(crown, models(), options);
    ADD_FAILURE() << "was not refused";
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    const std::string said = error.what();
    const std::size_t hint = said.find(" The option ");
    return hint == std::string::npos ? std::string{} : said.substr(hint + 1);
  }
}

TEST(WayOut, IsNamedAlsoWhereTheRootCannotBeJoined) {
  TriangleMesh crown = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 600);
  const Eigen::Vector3d up = area_vector(crown).normalized();
  const auto highest = std::max_element(crown.vertices.begin(), crown.vertices.end(),
                                        [&](const Point& a, const Point& b) { return a.dot(up) < b.dot(up); });
  *highest -= 14 * up;  // through the base
  CompleteOptions options = test::for_tooth(36);
  options.e = 1;
  EXPECT_EQ(hint_at(crown, options, ErrorCode::no_result), "The option --repair may help; so may --skirt auto.");
  options.repair = true;
  EXPECT_NO_THROW(complete_tooth(crown, models(), options));
}

TEST(WayOut, IsNotNamedWhereThereIsNone) {
  const TriangleMesh half_ball = test::dome(4, 0.8);
  EXPECT_EQ(hint_at(half_ball, test::for_tooth(36), ErrorCode::unusable_input), "") << "too small";
}

TEST(WayOut, NamesWhatIsNotSetYetAndWouldBeTaken) {
  CompleteOptions options;
  const auto always = [](const CompleteOptions&) { return true; };
  EXPECT_EQ(way_out(options, true, always), " The option --repair may help; so may --skirt auto.");
  EXPECT_EQ(way_out(options, false, always), " The option --repair may help.");
  EXPECT_EQ(way_out(options, true, [](const CompleteOptions& o) { return o.skirt.has_value(); }),
            " The option --skirt auto may help.");
  EXPECT_EQ(way_out(options, true, [](const CompleteOptions&) { return false; }), "");
  options.repair = true;
  EXPECT_EQ(way_out(options, true, [](const CompleteOptions& o) { return o.repair && o.skirt; }),
            " The option --skirt auto may help.");
}

}  // namespace
}  // namespace rhizodont
