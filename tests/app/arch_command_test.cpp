// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "mesh/append_mesh.hpp"
#include "program.hpp"
#include "rhizodont/io.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <utility>

namespace rhizodont::test {
namespace {

/// Two sample crowns side by side in a folder.
class Arch : public Program {
 protected:
  void SetUp() override {
    fs::create_directory(folder.path() / "crowns");
    place("crown_34.ply", "crown_34.ply", -7);
    place("crown_36.stl", "LL6.ply", 7);
  }

  void place(const char* sample, const char* name, double x) const {
    MeshFile crown;
    crown.mesh = load_mesh(fs::path(RHIZODONT_SOURCE_DIR) / "samples" / sample).mesh;
    Point low = crown.mesh.vertices.front(), high = low;
    for (const Point& p : crown.mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Point to = Point(x, 0, 0) - 0.5 * (low + high);
    for (Point& p : crown.mesh.vertices) p = nearest_float(p + to);
    save_mesh(folder.path() / "crowns" / name, crown);
  }

  /// Both crowns in one scan, labelled by a file beside it.
  void write_scan(const char* name) const {
    MeshFile scan;
    nlohmann::json labels{{"id_patient", ""}, {"jaw", "lower"}, {"labels", nlohmann::json::array()}};
    for (const auto& [file, fdi] : {std::pair("crowns/crown_34.ply", 34), std::pair("crowns/LL6.ply", 36)}) {
      append_mesh(scan.mesh, load_mesh(folder.path() / file).mesh);
      while (labels["labels"].size() < scan.mesh.vertices.size()) labels["labels"].push_back(fdi);
    }
    labels["instances"] = labels["labels"];
    save_mesh(folder.path() / name, scan);
    std::ofstream(fs::path(folder.path() / name).replace_extension(".json")) << labels;
  }

  void expect_same_teeth(const std::string& first, const std::string& second) const {
    for (const char* tooth : {"tooth_34.ply", "tooth_36.ply"}) {
      const TriangleMesh a = load_mesh(folder.path() / first / tooth).mesh,
                         b = load_mesh(folder.path() / second / tooth).mesh;
      EXPECT_EQ(a.vertices, b.vertices) << second << " " << tooth;
      EXPECT_EQ(a.triangles, b.triangles) << second << " " << tooth;
    }
  }

  nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(folder.path() / name));
  }
};

TEST_F(Arch, GivesEveryFileAndTeethThatCheck) {
  const Outcome done = run("arch crowns -o out --e 1");
  ASSERT_EQ(done.code, 0) << done.error << done.out;
  EXPECT_NE(done.out.find("2 of 2 teeth have roots"), std::string::npos) << done.out;
  for (const char* name : {"tooth_34.ply", "tooth_34.json", "crown_34.ply", "tooth_36.ply", "crown_36.ply", "arch.glb",
                           "arch.ply", "arch.json", "axes.json", "axes.mrk.json"})
    EXPECT_TRUE(fs::exists(folder.path() / "out" / name)) << name;
  for (const char* fdi : {"34", "36"}) {
    const std::string tooth = std::string("out/tooth_") + fdi, crown = std::string("out/crown_") + fdi + ".ply";
    const Outcome checked = run("check " + crown + " " + tooth + ".ply --report " + tooth + ".json");
    EXPECT_EQ(checked.code, 0) << checked.out << checked.error;
  }
  const nlohmann::json report = json("out/arch.json"), axes = json("out/axes.json");
  EXPECT_EQ(report["rooted"], 2);
  EXPECT_TRUE(report["input"]["file"].is_null());
  EXPECT_EQ(report["clearances"].size(), 1U);
  EXPECT_EQ(axes["teeth"].size(), 2U);
  EXPECT_EQ(json("out/axes.mrk.json")["markups"].size(), 4U);
  EXPECT_FALSE(fs::exists(folder.path() / "out/labels.json"));  // there is no scan whose vertices they would be of
  const MeshFile all = load_mesh(folder.path() / "out" / "arch.ply");
  for (const char* name : {"fdi", "source", "uncertainty", "clearance"})
    EXPECT_EQ(all.vertex_attributes.at(name).values.size(), all.mesh.vertices.size()) << name;
  // A folder with results is not written over unasked.
  expect_error("arch crowns -o out --e 1", 2, "--overwrite");
}

TEST_F(Arch, GivesTheSameTeethInEveryDialectOfLabels) {
  write_scan("scan.ply");
  const Outcome done = run("arch scan.ply -o out --e 1 --labels-vtp --labels-vtk");
  ASSERT_EQ(done.code, 0) << done.error << done.out;
  EXPECT_EQ(json("out/labels.json")["labels"], json("scan.json")["labels"]);
  EXPECT_EQ(json("out/labels.json")["jaw"], "lower");
  for (const char* labels : {"out/labels.vtp", "out/labels.vtk"}) {
    const std::string other = fs::path(labels).extension().string().substr(1);
    const Outcome again = run(std::string("arch ") + labels + " -o " + other + " --e 1");
    ASSERT_EQ(again.code, 0) << again.error << again.out;
    EXPECT_NE(again.out.find(other == "vtk" ? "niversal" : "FDI"), std::string::npos) << again.out;
    expect_same_teeth("out", other);
  }
}

TEST_F(Arch, OneToothWithoutAResultDoesNotStopTheOthers) {
  fs::copy_file(folder.path() / "crowns/crown_34.ply", folder.path() / "crowns/crown_75.ply");
  const Outcome done = run("arch crowns -o out --e 1 --root-length 36=15 --resolve-collisions");
  EXPECT_EQ(done.code, 6) << done.error << done.out;
  const nlohmann::json report = json("out/arch.json");
  EXPECT_EQ(report["rooted"], 2);
  for (const auto& tooth : report["teeth"]) {
    if (tooth["fdi"] == 75) {
      EXPECT_NE(tooth["refusal"].get<std::string>().find("milk"), std::string::npos);
    } else {
      EXPECT_TRUE(tooth["refusal"].is_null());
    }
    if (tooth["fdi"] == 36) {
      EXPECT_NEAR(tooth["root_length_mm"].get<double>(), 15, 0.3);
    }
  }
}

TEST_F(Arch, WrongUseAndBadInputAreSaidInOneLine) {
  expect_error("arch crowns -o out --root-length 36", 2, "36=14.2");
  expect_error("arch crowns -o out --root-length 47=14", 2, "47");
  expect_error("arch crowns -o out --labels-are roman", 2, "roman");
  expect_error("arch crowns -o out --clearance 0.3", 2, "--resolve-collisions");
  expect_error("arch crowns/LL6.ply -o out", 3, "A single crown goes to complete");
  expect_error("arch missing.ply -o out", 3, "missing.ply");
  expect_error("arch crowns/LL6.ply --labels none.json -o out", 3, "none.json");
  folder.write("list.json", "[1, 2, 3]");
  expect_error("arch crowns/LL6.ply --labels list.json -o out", 3, "list");
  expect_error("arch crowns -o out --unit m", 3, "mm across");
  // An STL file has no vertices that labels could be of, but where their number tells.
  write_scan("scan.stl");
  nlohmann::json fewer = json("scan.json");
  for (const char* list : {"labels", "instances"}) fewer[list].erase(0);
  std::ofstream(folder.path() / "scan.json") << fewer;
  expect_error("arch scan.stl -o out", 3, "STL");
  folder.write(
      "scan.dcm",
      "<?xml version=\"1.0\"?><HPS version=\"1.1\"><Packed_geometry><Schema>CE</Schema></Packed_geometry></HPS>");
  expect_error("arch scan.dcm -o out", 3, "3Shape");
  folder.write("slice.dcm", std::string(128, '\0') + "DICM");
  expect_error("arch slice.dcm -o out", 3, "DICOM");
  folder.write("empty.json", "");
  expect_error("arch crowns/LL6.ply --labels empty.json -o out", 3, "empty.json");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
}  // namespace rhizodont::test
