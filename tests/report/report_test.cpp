// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/report.hpp"

#include "common/temporary_folder.hpp"
#include "pipeline/product_models.hpp"
#include "pipeline/report_parts.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/tooth_file.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numeric>

namespace rhizodont {
namespace {

using nlohmann::json;
using test::for_tooth, test::models, test::source_folder;

json schema() { return json::parse(std::ifstream(source_folder / "docs/report.schema.json")); }

/// All that a part of the schema asks for is there.
void expect_required(const json& report, const json& names, const json& properties) {
  for (const auto& name : names) {
    ASSERT_TRUE(report.contains(name)) << name;
    const json& part = properties[name.get<std::string>()];
    if (!part.contains("required")) continue;
    for (const auto& inner : part["required"])
      EXPECT_TRUE(report[name.get<std::string>()].contains(inner.get<std::string>())) << name << " " << inner;
  }
}

TEST(Report, HasWhatTheSchemaAsksFor) {
  const auto file = source_folder / "samples/crown_34.ply";
  const MeshFile crown = load_mesh(file);
  const CompletedTooth tooth = complete_tooth(crown.mesh, models(), for_tooth(34));
  ReportedInput input;
  input.sha256 = sha256_of_bytes(read_file_bytes(file));
  auto report = json::parse(completion_report(tooth, input));
  const json wanted = schema();
  expect_required(report, wanted["else"]["required"], wanted["properties"]);
  EXPECT_EQ(report.size(), wanted["else"]["required"].size());
  EXPECT_EQ(report["report_version"], wanted["properties"]["report_version"]["const"]);
  EXPECT_EQ(report["input"]["sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(report["crown"]["kept_vertices"].size(), tooth.record.crown.kept_vertices.size());
  EXPECT_GT(report["stages"].size(), 4U);
  EXPECT_TRUE(report["input"]["file"].is_null()) << "names of files tell of patients";
  input.file_name = "caf\xe9_34.ply";  // Latin-1, no UTF-8
  report = json::parse(completion_report(tooth, input));
  EXPECT_EQ(report["input"]["file"], "caf\xef\xbf\xbd_34.ply");
}

TEST(Report, OfARefusedCrownSaysWhyAndWhere) {
  std::vector<std::int64_t> ids(210);
  std::iota(ids.begin(), ids.end(), 0);
  const ReportedInput input;
  const auto report = json::parse(completion_refusal_report(InputError("This is wrong.", ids, ElementKind::vertices),
                                                            for_tooth(34), input, {"welded"}));
  const json wanted = schema();
  expect_required(report, wanted["then"]["required"], wanted["properties"]);
  const json& refused = report["refused"];
  EXPECT_EQ(refused["exit_code"], 3);
  EXPECT_EQ(refused["sentence"], "This is wrong.");
  EXPECT_EQ(refused["ids_are"], "vertices");
  ASSERT_EQ(refused["ids"].size(), 210U);
  EXPECT_EQ(refused["ids"][209], 209);
  EXPECT_EQ(report["warnings"], json({"welded"}));
  EXPECT_TRUE(report["input"]["sha256"].is_null());
  const auto triangles = json::parse(completion_refusal_report(
      InputError("The surface cuts itself.", {4, 5}, ElementKind::triangle_pairs), for_tooth(34), input));
  EXPECT_EQ(triangles["refused"]["ids_are"], "pairs of triangles");
  EXPECT_EQ(triangles["refused"]["ids"], json({4, 5}));
  // the words of a sentence say nothing of its ids
  const auto lines = json::parse(completion_refusal_report(
      InputError("line 9: a triangle names vertices that do not exist", {9}), for_tooth(34), input));
  EXPECT_TRUE(lines["refused"]["ids_are"].is_null());
}

TEST(Report, WhatItExcusesIsReadBackInTheMeshsNumbers) {
  CompletedTooth tooth;
  tooth.record.crown.dropped_vertices = {{1, DropReason::cap}, {2, DropReason::repair}, {3, DropReason::skirt}};
  tooth.record.repairs = {{RepairAction::seam_merged, {2}, {}, {0}, 0.002}, {RepairAction::turned_over, {}, {7, 8}}};
  EXPECT_EQ(vertices_not_of_tooth(tooth.record), (std::vector<int>{1, 3}));
  ReportedInput input;
  input.sha256 = std::string(64, 'a');
  // as a file numbers them in which vertices were split
  MeshFile crown;
  crown.file_vertices = {0, 4, 5, 9};
  refer_to_file(tooth.record, crown, "tooth.ply");
  const test::TemporaryFolder folder;
  const std::string written = completion_report(tooth, input);
  EXPECT_EQ(json::parse(written)["crown"]["dropped_vertices_by_reason"],
            json({{"cap", {4}}, {"merged across a seam, the farthest 0.002 mm apart", {5}}, {"skirt", {9}}}));
  const auto file = folder.write("report.json", written);
  const ExcusedByReport excused = excused_by_report(file, input.sha256, crown.file_vertices);
  EXPECT_EQ(excused.dropped_vertices, (std::vector<int>{1, 3}));
  ASSERT_EQ(excused.repairs.size(), 2U);
  EXPECT_EQ(excused.repairs[0].action, RepairAction::seam_merged);
  EXPECT_EQ(excused.repairs[1].action, RepairAction::turned_over);
  EXPECT_EQ(excused.repairs[0].vertices, std::vector<int>{2});
  EXPECT_EQ(excused.repairs[0].merged_into, std::vector<int>{0});
  EXPECT_EQ(excused.repairs[1].triangles, (std::vector<int>{7, 8}));
  const CheckOptions options = allowing_for(excused);
  EXPECT_EQ(options.dropped_vertices, excused.dropped_vertices);
  EXPECT_EQ(options.repaired_triangles, (std::vector<int>{7, 8}));
  EXPECT_EQ(options.merged_vertices, (std::vector<std::array<int, 2>>{{2, 0}}));
  EXPECT_THROW(excused_by_report(file, std::string(64, 'b'), crown.file_vertices), InputError);
  EXPECT_THROW(excused_by_report(file, input.sha256, {0, 1}), InputError);
  EXPECT_THROW(excused_by_report(folder.write("other.json", "{}"), input.sha256, {}), InputError);
  EXPECT_THROW(excused_by_report(folder.path() / "none.json", input.sha256, {}), InputError);
  const auto refused =
      folder.write("refused.json", completion_refusal_report(NoResultError("No."), for_tooth(34), input));
  EXPECT_THROW(excused_by_report(refused, input.sha256, {}), InputError);
}

}  // namespace
}  // namespace rhizodont
