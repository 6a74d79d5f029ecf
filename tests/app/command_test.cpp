// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// The program as a user meets it: exit codes, what is said where, and what is written.
#include "app/program.hpp"
#include "base/float_bits.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class PairOfFiles : public test::Program {
 protected:
  void write_pair() const {
    TriangleMesh tooth = test::sphere(2, 4);
    for (Point& p : tooth.vertices) p = nearest_float(p);
    std::vector<bool> above;
    for (const Triangle& t : tooth.triangles)
      above.push_back(
          std::all_of(t.begin(), t.end(), [&](int v) { return tooth.vertices[static_cast<std::size_t>(v)].z() > 0; }));
    save_mesh(folder.path() / "crown.stl", {submesh(tooth, above).mesh, {}, {}, true, {}});
    MeshFile whole{tooth, {}, {}, true, {}};
    VertexAttribute& source = whole.vertex_attributes["source"];
    source.type = AttributeType::uint8;
    for (const Point& p : tooth.vertices) source.values.push_back(p.z() > 0 ? 0 : p.z() > -1.5 ? 1 : 2);
    save_mesh(folder.path() / "tooth.ply", whole);
    whole.mesh.triangles.pop_back();
    save_mesh(folder.path() / "open.ply", whole);
  }
};

TEST_F(PairOfFiles, HelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.code, 0);
  for (const char* command : {"check", "measure", "render"}) EXPECT_NE(help.out.find(command), std::string::npos);
  const Outcome of_check = run("check --help");
  EXPECT_EQ(of_check.code, 0);
  EXPECT_NE(of_check.out.find("Usage"), std::string::npos);
  const Outcome version = run("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("rhizodont ", 0), 0U);
}

TEST_F(PairOfFiles, WrongUsageIs2) {
  write_pair();
  expect_error("", 2, "subcommand");
  expect_error("frobnicate", 2, "");
  expect_error("check crown.stl", 2, "TOOTH");
  expect_error("check crown.stl tooth.ply --frobnicate", 2, "--frobnicate");
  expect_error("check crown.stl tooth.ply --least-kept 3", 2, "least_kept_share of the check is 3, out of its range");
  expect_error("render tooth.ply -o a.png --views behind", 2, "'behind'");
  expect_error("render tooth.ply -o a.png --color-by colour", 2, "'colour'");
  EXPECT_EQ(folder.file_count(), 3U);
}

TEST_F(PairOfFiles, UnusableInputIs3) {
  write_pair();
  expect_error("measure none.ply", 3, "none.ply");
  expect_error("measure tooth.xyz", 3, "tooth.xyz");
  folder.write("empty.stl", "");
  expect_error("measure empty.stl", 3, "empty");
  const std::string whole = test::read_all(folder.path() / "tooth.ply");
  folder.write("cut.ply", whole.substr(0, whole.size() / 2));
  expect_error("check crown.stl cut.ply", 3, "cut.ply");
  expect_error("check cut.ply tooth.ply", 3, "cut.ply");
  folder.write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_error("measure nan.obj", 3, "line 1");
  folder.write("nothing.obj", "v 0 0 0\n");
  expect_error("render nothing.obj -o a.png", 3, "no triangles");
  EXPECT_FALSE(fs::exists(folder.path() / "a.png"));
}

TEST_F(PairOfFiles, CheckSaysWhetherThePromisesHold) {
  write_pair();
  const Outcome good = run("check crown.stl tooth.ply");
  EXPECT_EQ(good.code, 0);
  EXPECT_NE(good.out.find("Promise 1, the crown is exact: kept"), std::string::npos) << good.out;
  EXPECT_NE(good.out.find("Promise 2, the tooth is a solid: kept"), std::string::npos);
  EXPECT_EQ(good.error, "");
  const Outcome bad = run("check crown.stl open.ply");
  EXPECT_EQ(bad.code, 4);
  EXPECT_NE(bad.out.find("the tooth is open: 3 border edges"), std::string::npos) << bad.out;
}

TEST_F(PairOfFiles, JsonToStandardOutputOrAFile) {
  write_pair();
  const Outcome printed = run("check crown.stl open.ply --json");
  EXPECT_EQ(printed.code, 4);
  const auto json = nlohmann::json::parse(printed.out);
  EXPECT_FALSE(json["holds"].get<bool>());
  EXPECT_TRUE(json["crown"]["holds"].get<bool>());
  EXPECT_EQ(json["solid"]["border_edges"], 3);
  const Outcome filed = run("measure tooth.ply --json figures.json");
  EXPECT_EQ(filed.code, 0);
  EXPECT_NE(filed.out.find("Topology"), std::string::npos);
  const auto figures = nlohmann::json::parse(test::read_all(folder.path() / "figures.json"));
  EXPECT_EQ(figures["topology"]["euler_number"], 2);
  EXPECT_EQ(figures["topology"]["triangles"], 128);
}

TEST_F(PairOfFiles, RenderWritesAPicture) {
  write_pair();
  const Outcome outcome =
      run("render crown.stl tooth.ply -o sheet.png --width 40 --height 50 --views front,top,oblique --wireframe");
  EXPECT_EQ(outcome.code, 0) << outcome.error;
  const std::string png = test::read_all(folder.path() / "sheet.png");
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(static_cast<unsigned char>(png[19]), 120);  // width: three tiles
  EXPECT_EQ(static_cast<unsigned char>(png[23]), 100);  // height: two meshes
  ASSERT_EQ(
      run("render crown.stl tooth.ply crown.stl -o row.png --width 40 --height 50 --views front --per-row 2").code, 0);
  const std::string row = test::read_all(folder.path() / "row.png");
  EXPECT_EQ(static_cast<unsigned char>(row[19]), 80);
  EXPECT_EQ(static_cast<unsigned char>(row[23]), 100);
  EXPECT_EQ(run("render crown.stl -o alone.png --width 40 --height 50 --per-row 64").code, 0);
  // Numbers of teeth, also of milk teeth and wrong ones.
  for (const char* number : {"36", "75", "33", "0"}) {
    folder.write("labels.ply",
                 std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                             "property float z\nproperty uchar fdi\nelement face 1\nproperty list uchar int "
                             "vertex_indices\nend_header\n0 0 0 ") +
                     number + "\n1 0 0 36\n0 1 0 36\n3 0 1 2\n");
    EXPECT_EQ(run("render labels.ply -o labels.png --width 40 --height 50").code, 0) << number;
  }
}

}  // namespace
}  // namespace rhizodont
