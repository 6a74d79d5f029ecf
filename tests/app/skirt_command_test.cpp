// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Crowns with skirts as a user meets them.
#include "app/program.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/io.hpp"

#include <nlohmann/json.hpp>

#include <fstream>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class SkirtCommand : public test::Program {
 protected:
  const std::string crown = "'" RHIZODONT_SOURCE_DIR "/samples/skirt_36.ply'";
  fs::path file(const std::string& name) const { return folder.path() / name; }
};

TEST_F(SkirtCommand, AutoDropsTheSkirtAndSaysSo) {
  const Outcome outcome =
      run("complete " + crown + " --fdi 36 --skirt auto --skirt-confidence c.ply -o tooth.ply --report report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_EQ(run("check " + crown + " tooth.ply").code, 0);
  const MeshFile input = load_mesh(fs::path(RHIZODONT_SOURCE_DIR) / "samples/skirt_36.ply");
  const std::vector<double>& is_tooth = input.vertex_attributes.at("tooth").values;
  const auto report = nlohmann::json::parse(std::ifstream(file("report.json")));
  std::vector<int> told(is_tooth.size(), 0);
  for (const auto& [reason, vertices] : report["crown"]["dropped_vertices_by_reason"].items())
    for (const int v : vertices) ++told[static_cast<std::size_t>(v)];
  std::size_t both = 0, either = 0, dropped = 0;
  for (std::size_t v = 0; v < told.size(); ++v) {
    both += told[v] == 1 && is_tooth[v] == 0;
    either += told[v] == 1 || is_tooth[v] == 0;
    dropped += told[v] == 1;
  }
  EXPECT_GT(static_cast<double>(both), 0.8 * static_cast<double>(either));
  for (const int v : report["crown"]["kept_vertices"]) ++told[static_cast<std::size_t>(v)];
  EXPECT_EQ(std::count(told.begin(), told.end(), 1), static_cast<std::ptrdiff_t>(told.size()));
  EXPECT_EQ(report["options"]["skirt"], 0.5);
  EXPECT_FALSE(report["skirt_model"].empty());

  const MeshFile judged = load_mesh(file("c.ply"));
  EXPECT_EQ(judged.mesh.vertices, input.mesh.vertices);
  const auto& kept = judged.vertex_attributes.at("kept").values;
  EXPECT_EQ(std::count(kept.begin(), kept.end(), 0), static_cast<std::ptrdiff_t>(dropped));
  for (const double c : judged.vertex_attributes.at("confidence").values) EXPECT_TRUE(c == -1 || (c >= 0 && c <= 1));
}

TEST_F(SkirtCommand, BadOptionsAreRefused) {
  expect_error("complete " + crown + " --fdi 36 --skirt 1.5 -o tooth.ply", 2, "between 0 and 1");
  expect_error("complete " + crown + " --fdi 36 --skirt off -o tooth.ply", 2, "keep, auto");
  expect_error("complete " + crown + " --fdi 36 --skirt-confidence c.ply -o tooth.ply", 2, "--skirt auto");
  EXPECT_FALSE(fs::exists(file("tooth.ply")));
}

TEST_F(SkirtCommand, LabelsByTheRestoredModel) {
  MeshFile restored, cut;
  restored.mesh = test::sphere(3, 4);
  cut.mesh = restored.mesh;
  std::size_t moved = 0;
  for (Point& p : cut.mesh.vertices) {
    if (p.z() > -1) continue;
    p *= 1.2;
    ++moved;
  }
  save_mesh(file("restored.ply"), restored);
  save_mesh(file("cut.ply"), cut);
  ASSERT_EQ(run("label-skirt cut.ply restored.ply -o labelled.ply").code, 0);
  const auto labels = load_mesh(file("labelled.ply")).vertex_attributes.at("tooth").values;
  EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), static_cast<std::ptrdiff_t>(moved));
  expect_error("label-skirt cut.ply restored.ply --tolerance 0 -o labelled.ply", 2, "tolerance");
}

}  // namespace
}  // namespace rhizodont
