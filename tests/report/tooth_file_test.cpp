// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "rhizodont/tooth_file.hpp"

#include "pipeline/product_models.hpp"
#include "rhizodont/report.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>

namespace rhizodont {
namespace {

/// A tooth of four vertices of which two are the crown's vertices 2 and 0.
CompletedTooth small_tooth() {
  CompletedTooth tooth;
  tooth.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  tooth.source = {VertexSource::scan, VertexSource::scan, VertexSource::transition, VertexSource::predicted};
  tooth.uncertainty = {0, 0, 0.1, 0.2};
  CompletionRecord& record = tooth.record;
  record.crown.kept_vertices = {0, 2};
  record.crown.dropped_vertices = {{1, DropReason::cap}, {3, DropReason::skirt}};
  record.repairs = {{RepairAction::seam_merged, {1}, {5}, {3}}};
  record.promises.crown.dropped_vertices = {1, 3};
  record.warnings = {"first"};
  record.missed_places = {{"A sharp angle.", {1, 2}}};
  return tooth;
}

MeshFile crown_with(const std::map<std::string, VertexAttribute>& attributes) {
  MeshFile crown;
  crown.mesh.vertices.resize(4, Point::Zero());
  crown.vertex_attributes = attributes;
  return crown;
}

TEST(ToothFile, ColoursOfTheScanAreCarried) {
  using enum AttributeType;
  const MeshFile crown = crown_with({{"red", {uint8, {10, 20, 31, 40}}},
                                     {"green", {float32, {0, 0.5, 1, 1}}},
                                     {"blue", {uint8, {255, 0, 255, 0}}},
                                     {"label", {int32, {1, 2, 3, 4}}}});
  const MeshFile file = tooth_file(small_tooth(), crown);
  EXPECT_EQ(file.vertex_attributes.at("red").values, (std::vector<double>{10, 31, 21, 21}));
  EXPECT_EQ(file.vertex_attributes.at("green").values, (std::vector<double>{0, 255, 128, 128}));
  EXPECT_EQ(file.vertex_attributes.at("blue").values, (std::vector<double>{255, 255, 255, 255}));
  EXPECT_EQ(file.vertex_attributes.at("green").type, uint8);
  EXPECT_EQ(file.vertex_attributes.at("source").values, (std::vector<double>{0, 0, 1, 2}));
  EXPECT_FALSE(file.vertex_attributes.contains("label"));
  EXPECT_EQ(file.vertex_attributes.size(), 5U);
}

TEST(ToothFile, ColoursAsFloatsGoTo1OrTo255) {
  using enum AttributeType;
  const auto red_of = [](double green) {
    const MeshFile crown = crown_with(
        {{"red", {float32, {0, 1, 1, 0}}}, {"green", {float32, {0, 0, green, 0}}}, {"blue", {float32, {0, 0, 0, 0}}}});
    return tooth_file(small_tooth(), crown).vertex_attributes.at("red").values[1];
  };
  EXPECT_EQ(red_of(1), 255);
  EXPECT_EQ(red_of(200), 1) << "no channel is a share of 255 if one of them is none";
}

TEST(ToothFile, StlThatCannotHoldItIsRefused) {
  CompletedTooth tooth = small_tooth();
  EXPECT_NO_THROW(require_format_holds(tooth, "a.stl"));
  tooth.mesh.vertices[3].x() = 8e4 + 1e-7;
  EXPECT_NO_THROW(require_format_holds(tooth, "a.ply"));
  for (const char* name : {"a.stl", "a.GLB"}) {
    try {
      require_format_holds(tooth, name);
      ADD_FAILURE() << name << " holds floats only";
    } catch (const NoResultError& error) {
      EXPECT_NE(std::string(error.what()).find("Move the scan to the origin"), std::string::npos);
    }
  }
  tooth = small_tooth();
  ASSERT_EQ(tooth.source[0], VertexSource::scan);
  tooth.mesh.vertices[0].x() = 0.1;
  try {
    require_format_holds(tooth, "a.stl");
    ADD_FAILURE() << "the crown itself is no float";
  } catch (const NoResultError& error) {
    EXPECT_NE(std::string(error.what()).find("more digits than single precision"), std::string::npos);
  }
}

TEST(ToothFile, WithoutColoursThereAreNone) {
  using enum AttributeType;
  for (const MeshFile& crown :
       {crown_with({}), crown_with({{"red", {uint8, {1, 2, 3, 4}}}}),
        crown_with(
            {{"red", {float64, {900, 2, 3, 4}}}, {"green", {uint8, {1, 2, 3, 4}}}, {"blue", {uint8, {1, 2, 3, 4}}}})}) {
    const MeshFile file = tooth_file(small_tooth(), crown);
    EXPECT_EQ(file.vertex_attributes.size(), 2U);
    EXPECT_EQ(file.comments.size(), 3U);
  }
}

TEST(ToothFile, RecordsNameTheFilesOwnVertices) {
  MeshFile crown = crown_with({});
  crown.notes = {"welded"};
  CompletionRecord record = small_tooth().record;
  refer_to_file(record, crown, "a.ply");
  EXPECT_EQ(record.crown.kept_vertices, (std::vector<int>{0, 2}));  // the same numbers in mesh and file
  EXPECT_EQ(all_warnings(record),
            (std::vector<std::string>{"welded", "first", "A sharp angle. It is beside the crown's vertices 1, 2."}));
  crown.file_vertices = {0, 10, 20, 30};
  record = small_tooth().record;
  refer_to_file(record, crown, "a.ply");
  EXPECT_EQ(record.crown.kept_vertices, (std::vector<int>{0, 20}));
  EXPECT_EQ(all_warnings(record).back(), "A sharp angle. It is beside the crown's vertices 10, 20.");
  EXPECT_EQ(record.crown.dropped_vertices[0].vertex, 10);
  EXPECT_EQ(record.crown.dropped_vertices[1].vertex, 30);
  EXPECT_EQ(record.repairs[0].vertices, std::vector<int>{10});
  EXPECT_EQ(record.repairs[0].merged_into, std::vector<int>{30});
  EXPECT_EQ(record.repairs[0].triangles, std::vector<int>{5});
  EXPECT_EQ(record.promises.crown.dropped_vertices, (std::vector<int>{10, 30}));
  EXPECT_EQ(in_terms_of_file(InputError("What is wrong.", {1, 3}, ElementKind::vertex_pairs), crown).elements(),
            (std::vector<std::int64_t>{10, 30}));
  EXPECT_EQ(in_terms_of_file(InputError("What is wrong.", {2}, ElementKind::vertices), crown).elements(),
            (std::vector<std::int64_t>{20}));
  EXPECT_EQ(in_terms_of_file(InputError("What is wrong.", {1, 3}, ElementKind::triangle_pairs), crown).elements(),
            (std::vector<std::int64_t>{1, 3}));
}

TEST(ToothFile, LostColoursAreSaid) {
  using enum AttributeType;
  const VertexAttribute part{uint8, {1, 2, 3, 4}};
  const MeshFile crown = crown_with({{"red", part}, {"green", part}, {"blue", part}});
  for (const auto& [output, said] : {std::pair("a.ply", false), {"a.PLY", false}, {"a.stl", true}, {"a.glb", true}}) {
    CompletionRecord record;
    refer_to_file(record, crown, output);
    EXPECT_EQ(record.warnings.size(), said ? 1U : 0U) << output;
  }
  CompletionRecord record;
  refer_to_file(record, crown_with({{"red", {int32, {1, 2, 3, 400}}}, {"green", part}, {"blue", part}}), "a.ply");
  ASSERT_EQ(record.warnings.size(), 1U);
  EXPECT_NE(record.warnings[0].find("not between 0 and 255"), std::string::npos);
}

TEST(ToothFile, ACrownOfLooseTrianglesIsTheSameTooth) {
  const MeshFile crown = load_mesh(test::source_folder / "samples" / "crown_34.ply");
  std::string soup;
  std::vector<Point> written;
  for (const Triangle& t : crown.mesh.triangles)
    for (const std::int32_t v : t) {
      const Point& p = written.emplace_back(crown.mesh.vertices[static_cast<std::size_t>(v)]);
      soup += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    }
  for (std::size_t t = 0; t < crown.mesh.triangles.size(); ++t)
    soup += fmt::format("f {} {} {}\n", 3 * t + 1, 3 * t + 2, 3 * t + 3);
  const MeshFile welded = read_mesh(soup, "crown.obj");
  ASSERT_EQ(welded.mesh.vertices.size(), crown.mesh.vertices.size());
  CompletedTooth tooth = complete_tooth(welded.mesh, test::models(), test::for_tooth(34));
  refer_to_file(tooth.record, welded, "tooth.ply");
  ASSERT_EQ(tooth.record.crown.kept_vertices.size(), crown.mesh.vertices.size());
  EXPECT_TRUE(std::is_sorted(tooth.record.crown.kept_vertices.begin(), tooth.record.crown.kept_vertices.end()));
  for (std::size_t v = 0; v < tooth.record.crown.kept_vertices.size(); ++v)
    EXPECT_EQ(tooth.mesh.vertices[v], written[static_cast<std::size_t>(tooth.record.crown.kept_vertices[v])]);
}

TEST(ToothFile, ACrownWithMoreDigitsThanTheFormatIsRefusedOrRounded) {
  MeshFile crown;
  crown.mesh = {{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  crown.coordinates_fit_float = false;
  EXPECT_NO_THROW(require_format_holds_crown(crown, "crown.ply", "folder", "folder.ply"));
  try {
    require_format_holds_crown(crown, "crown.ply", "folder", "folder.stl");
    ADD_FAILURE() << "was not refused";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "crown.ply has coordinates with more digits than folder can hold: give the tooth a name in .ply or "
                 ".obj, or have the crown rounded (--as-float).");
  }
  ReportedInput input;
  CompletionRecord record;
  input.rounded_mm = round_coordinates(crown, 1000);
  ASSERT_TRUE(input.rounded_mm);
  EXPECT_NEAR(*input.rounded_mm, 1000 * (static_cast<double>(0.1F) - 0.1), 1e-12);
  warn_of_rounding(input, record);
  ASSERT_EQ(record.warnings.size(), 1U);
  input.rounded_mm = round_coordinates(crown, 1000);
  EXPECT_FALSE(input.rounded_mm) << "all are floats by now";
  warn_of_rounding(input, record);
  EXPECT_EQ(record.warnings.size(), 1U);
  crown.coordinates_fit_float = true;
  EXPECT_NO_THROW(require_format_holds_crown(crown, "crown.ply", "tooth.stl", "tooth.stl"));
}

TEST(ToothFile, ConfidencesSayWhatIsKept) {
  const MeshFile crown = crown_with({});
  CompletionRecord record = small_tooth().record;
  record.crown.tooth_confidence = {1, 0.25, -1, 0};
  const MeshFile file = confidence_file(crown, record);
  EXPECT_EQ(file.mesh.vertices, crown.mesh.vertices);
  EXPECT_EQ(file.vertex_attributes.at("confidence").values, (std::vector<double>{1, 0.25, -1, 0}));
  EXPECT_EQ(file.vertex_attributes.at("kept").values, (std::vector<double>{1, 0, 1, 0}));
}

}  // namespace
}  // namespace rhizodont
