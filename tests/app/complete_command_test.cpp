// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// `rhizodont complete` as a user meets it: files in, files out, exit codes for input that cannot be used.
#include "app/program.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/io.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <vector>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class Complete : public test::Program {
 protected:
  static fs::path sample(const std::string& name) { return fs::path(RHIZODONT_SOURCE_DIR) / "samples" / name; }

  fs::path file(const std::string& name) const { return folder.path() / name; }

  void write(const std::string& name, const TriangleMesh& mesh) const {
    MeshFile contents;
    contents.mesh = mesh;
    save_mesh(file(name), contents);
  }

  void write_bytes(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
  }

  /// The GLB file, read as its specification says, holds this mesh: header, chunks, accessors, positions, indices.
  void expect_in_glb(const std::string& name, const TriangleMesh& mesh) const {
    const std::string bytes = test::read_all(file(name));
    const auto number = [&](std::size_t place) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + place, 4);
      return std::size_t{value};
    };
    ASSERT_GT(bytes.size(), 28U);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number(4), 2U);
    EXPECT_EQ(number(8), bytes.size());
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    const auto json = nlohmann::json::parse(bytes.substr(20, number(12)));
    const std::size_t data = 28 + number(12);
    EXPECT_EQ(bytes.substr(data - 4, 4), std::string("BIN\0", 4));
    ASSERT_EQ(number(data - 8), bytes.size() - data);
    const auto& primitive = json["meshes"][0]["primitives"][0];
    const auto place_of = [&](const nlohmann::json& accessor, std::size_t count, int component_type) {
      const auto& described = json["accessors"][accessor.get<std::size_t>()];
      EXPECT_EQ(described["count"], count);
      EXPECT_EQ(described["componentType"], component_type);
      const auto& view = json["bufferViews"][described["bufferView"].get<std::size_t>()];
      return data + view.value("byteOffset", std::size_t{0}) + described.value("byteOffset", std::size_t{0});
    };
    const std::size_t positions = place_of(primitive["attributes"]["POSITION"], mesh.vertices.size(), 5126);
    const std::size_t indices = place_of(primitive["indices"], 3 * mesh.triangles.size(), 5125);
    ASSERT_LE(positions + 12 * mesh.vertices.size(), bytes.size());
    ASSERT_LE(indices + 12 * mesh.triangles.size(), bytes.size());
    // STL, which the mesh comes from, has no numbers of vertices: triangles are compared by their places, in order.
    for (std::size_t k = 0; k < 3 * mesh.triangles.size(); ++k) {
      const Point& p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[k / 3][k % 3])];
      std::array<float, 3> found{};
      ASSERT_LT(number(indices + 4 * k), mesh.vertices.size());
      std::memcpy(found.data(), bytes.data() + positions + 12 * number(indices + 4 * k), 12);
      for (std::size_t i = 0; i < 3; ++i) ASSERT_EQ(found[i], static_cast<float>(p[static_cast<Eigen::Index>(i)])) << k;
    }
  }

  /// Ends with exit 3, says `words` in one line and in the report, and writes no tooth.
  void expect_refused(const std::string& name, const std::string& words) const {
    expect_error("complete " + name + " --fdi 36 -o tooth.ply --report tooth.json", 3, words);
    EXPECT_FALSE(fs::exists(file("tooth.ply"))) << name;
    const auto report = nlohmann::json::parse(std::ifstream(file("tooth.json")));
    EXPECT_EQ(report["refused"]["exit_code"], 3);
    EXPECT_NE(report["refused"]["sentence"].get<std::string>().find(words), std::string::npos) << report;
    EXPECT_EQ(report["input"]["sha256"].is_null(), !fs::exists(file(name)));
    fs::remove(file("tooth.json"));
  }
};

TEST_F(Complete, WritesToothAndReportAndCheckHolds) {
  const std::string crown = "'" + sample("crown_36.stl").string() + "'";
  const Outcome outcome = run("complete " + crown + " --fdi 36 -o tooth.ply --report report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_TRUE(outcome.error.empty()) << "quiet in a pipe: " << outcome.error;
  EXPECT_EQ(run("check " + crown + " tooth.ply").code, 0);
  const auto report = nlohmann::json::parse(std::ifstream(file("report.json")));
  EXPECT_EQ(report["fdi"]["number"], 36);
  EXPECT_EQ(report["crown"]["kept_triangles"], report["crown"]["triangles"]);
  const MeshFile tooth = load_mesh(file("tooth.ply"));
  ASSERT_TRUE(tooth.vertex_attributes.contains("source"));
  const auto& source = tooth.vertex_attributes.at("source").values;
  for (const double value : {0.0, 1.0, 2.0}) EXPECT_GT(std::count(source.begin(), source.end(), value), 20) << value;
}

TEST_F(Complete, OtherFormatsKeepTheCrownToo) {
  const std::string crown = "'" + sample("crown_34.ply").string() + "'";
  for (const std::string name : {"tooth.stl", "tooth.obj"}) {
    ASSERT_EQ(run("complete " + crown + " --fdi 34 --quiet -o " + name).code, 0) << name;
    EXPECT_EQ(run("check " + crown + " " + name).code, 0) << name;
  }
  ASSERT_EQ(run("complete " + crown + " --fdi 34 --quiet -o tooth.glb").code, 0);
  expect_in_glb("tooth.glb", load_mesh(file("tooth.stl")).mesh);
}

TEST_F(Complete, CandidatesDifferInTheirRootsAndKeepTheCrown) {
  const std::string crown = "'" + sample("crown_34.ply").string() + "'";
  const Outcome outcome = run("complete " + crown + " --fdi 34 --e 1 --candidates 3 -o tooth.ply --report report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  std::vector<double> lengths;
  for (const std::string name : {"", "_2", "_3"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(run("check " + crown + " tooth" + name + ".ply").code, 0);
    const auto report = nlohmann::json::parse(std::ifstream(file("report" + name + ".json")));
    lengths.push_back(report["root"]["length_mm"]);
    EXPECT_EQ(report["fdi"]["number"], 34);
  }
  EXPECT_FALSE(fs::exists(file("tooth_4.ply")));
  const auto first = nlohmann::json::parse(std::ifstream(file("report.json")));
  const auto& interval = first["root"]["interval"];
  // The second and third have the ends of the first one's interval, as near as a mesh of this size ends where it
  // should.
  EXPECT_LT(lengths[1], lengths[0]);
  EXPECT_GT(lengths[2], lengths[0]);
  EXPECT_NEAR(lengths[1], interval["length_low_mm"].get<double>(), 0.2);
  EXPECT_NEAR(lengths[2], interval["length_high_mm"].get<double>(), 0.2);
  // Alone, the expected one is the same.
  ASSERT_EQ(run("complete " + crown + " --fdi 34 --e 1 -o alone.ply").code, 0);
  EXPECT_TRUE(test::read_all(file("alone.ply")) == test::read_all(file("tooth.ply")));
}

TEST_F(Complete, CandidatesThatCannotBeAreRefused) {
  const std::string crown = "complete '" + sample("crown_34.ply").string() + "' --fdi 34 -o tooth.ply --candidates ";
  expect_error(crown + "0", 2, "1 to 9");
  expect_error(crown + "10", 2, "1 to 9");
  expect_error(crown + "2 --root-length 14", 2, "ask for one of the two");
  EXPECT_FALSE(fs::exists(file("tooth.ply")));
}

TEST_F(Complete, UnusableFilesAreRefused) {
  expect_refused("missing.ply", "cannot be opened");
  write_bytes("empty.stl", "");
  expect_refused("empty.stl", "empty");
  write_bytes("none.ply",
              "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 0\nproperty list uchar int vertex_indices\nend_header\n");
  expect_refused("none.ply", "no triangle");
  const std::string whole = test::read_all(sample("crown_36.stl"));
  write_bytes("cut.stl", whole.substr(0, whole.size() / 2));
  expect_refused("cut.stl", "damaged or cut off");
  write_bytes("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_refused("nan.obj", "not a finite number");
}

TEST_F(Complete, MeshesThatAreNoCrownAreRefused) {
  const TriangleMesh crown = load_mesh(sample("crown_34.ply")).mesh;
  write("ball.ply", test::sphere(4, 4));
  expect_refused("ball.ply", "no cap");
  write("pieces.ply", test::together(crown, crown, Point(20, 0, 0)));
  expect_refused("pieces.ply", "2 crowns");
  write("inside_out.ply", flipped(crown));
  expect_refused("inside_out.ply", "inside out");
  TriangleMesh damaged = crown;
  std::swap(damaged.triangles[50][0], damaged.triangles[50][1]);
  write("flipped.ply", damaged);
  expect_refused("flipped.ply", "flipped against their neighbours");
  damaged = crown;
  damaged.vertices.push_back(damaged.vertices[0] + Point(1, 1, 1));
  const Triangle& t = damaged.triangles[100];
  damaged.triangles.push_back({t[0], t[1], static_cast<std::int32_t>(damaged.vertices.size()) - 1});
  write("fin.ply", damaged);
  expect_refused("fin.ply", "more than two triangles");
  TriangleMesh metres = crown;
  for (Point& p : metres.vertices) p *= 1e-3;
  write("metres.obj", metres);
  expect_refused("metres.obj", "metres (--unit m)");
}

TEST_F(Complete, RepairsOnRequestAndCheckProvesItByTheReport) {
  TriangleMesh crown = load_mesh(sample("crown_34.ply")).mesh;
  const Triangle t = crown.triangles[100];
  crown.vertices.push_back(crown.vertices[0] + Point(1, 1, 1));
  crown.triangles.push_back({t[0], t[1], static_cast<std::int32_t>(crown.vertices.size()) - 1});
  std::swap(crown.triangles[50][0], crown.triangles[50][1]);
  crown.triangles.push_back(crown.triangles[60]);
  write("bad.ply", crown);
  expect_refused("bad.ply", "--repair may help");
  const Outcome outcome = run("complete bad.ply --fdi 34 --repair -o tooth.ply --report report.json");
  ASSERT_EQ(outcome.code, 0) << outcome.error;
  EXPECT_NE(outcome.out.find("repaired: triangle turned over (0 vertices, 1 triangles)"), std::string::npos);
  const Outcome plain = run("check bad.ply tooth.ply");
  EXPECT_EQ(plain.code, 4) << "a turned triangle is not the crown's";
  EXPECT_NE(plain.out.find("--report FILE"), std::string::npos) << "what helps is said: " << plain.out;
  EXPECT_EQ(run("check bad.ply tooth.ply --report report.json").code, 0);
  auto report = nlohmann::json::parse(std::ifstream(file("report.json")));
  EXPECT_EQ(report["repairs"].size(), 3U);
  expect_error("check '" + sample("crown_34.ply").string() + "' tooth.ply --report report.json", 3, "another crown");
  write_bytes("other.json", "{}");
  expect_error("check bad.ply tooth.ply --report other.json", 3, "not a report");
}

TEST_F(Complete, SaysWhatItDroppedAndHowCheckHearsOfIt) {
  const TriangleMesh crown = load_mesh(sample("crown_34.ply")).mesh;
  // a speck: a triangle of its own on every other neighbour of a vertex with six of them
  TriangleMesh bad = crown;
  for (int v = 0; bad.triangles.size() == crown.triangles.size(); ++v) {
    std::map<int, int> around;  // from neighbour to neighbour
    for (const Triangle& t : crown.triangles)
      for (std::size_t i = 0; i < 3; ++i)
        if (t[i] == v) around[t[(i + 1) % 3]] = t[(i + 2) % 3];
    std::vector<int> ring;
    for (int at = around.begin()->first; around.contains(at) && ring.size() < 6; at = around[at]) ring.push_back(at);
    if (around.size() == 6 && ring.size() == 6) bad.triangles.push_back({ring[0], ring[2], ring[4]});
  }
  write("speck.ply", bad);
  const Outcome done = run("complete speck.ply --fdi 34 --e 2 -o tooth.ply --report report.json");
  ASSERT_EQ(done.code, 0) << done.error;
  EXPECT_NE(done.out.find("repaired: "), std::string::npos) << done.out;
  const Outcome plain = run("check speck.ply tooth.ply");
  EXPECT_EQ(plain.code, 4) << plain.out;
  EXPECT_NE(plain.out.find("--report FILE"), std::string::npos) << plain.out;
  EXPECT_EQ(run("check speck.ply tooth.ply --report report.json").code, 0);

  // a triangle is gone that touched the border with one corner, so that the border passes it twice
  std::vector<bool> at_border(crown.vertices.size(), false);
  const EdgeTable edges = edge_table(crown);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.triangle_count(e) == 1)
      for (const int v : edges.vertices[e]) at_border[static_cast<std::size_t>(v)] = true;
  TriangleMesh pinched = crown;
  const auto touches = [&](const Triangle& one) {
    return std::count_if(one.begin(), one.end(), [&](int v) { return at_border[static_cast<std::size_t>(v)]; }) == 1;
  };
  pinched.triangles.erase(std::find_if(pinched.triangles.begin(), pinched.triangles.end(), touches));
  write("pinched.ply", pinched);
  const Outcome told = run("complete pinched.ply --fdi 34 --e 2 -o tooth.ply");
  ASSERT_EQ(told.code, 0) << told.error;
  EXPECT_NE(told.out.find("1 vertex dropped as pinched border"), std::string::npos) << told.out;
}

TEST_F(Complete, TheSameBytesForAnyNumberOfThreads) {
  const std::string crown = "'" + sample("crown_36.stl").string() + "'";
  std::string first;
  for (const std::string threads : {"1", "2", "4", "2"}) {
    ASSERT_EQ(run("complete " + crown + " --fdi 36 --e 0.8 --quiet --threads " + threads + " -o tooth.ply").code, 0);
    const std::string bytes = test::read_all(file("tooth.ply"));
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads << " threads";
  }
}

TEST_F(Complete, WrongUsage) {
  const std::string crown = "'" + sample("crown_34.ply").string() + "'";
  expect_error("complete " + crown, 2, "--output");
  expect_error("complete " + crown + " --fdi 39 -o tooth.ply", 2, "39");
  expect_error("complete " + crown + " --fdi 34 --e 9 -o tooth.ply", 2, "out of its range");
  expect_error("complete " + crown + " --fdi 34 --cap cut -o tooth.ply", 2, "cut");
  expect_error("complete " + crown + " --fdi 34 -o tooth.doc", 2, "doc");
  expect_error("complete missing.ply --fdi 34 -o tooth.doc", 2, "doc");  // before any work
  expect_error("complete missing.ply --fdi 34 -o /proc/nowhere/tooth.ply", 7, "nowhere");
  expect_error("complete missing.ply --fdi 34 -o tooth.ply --report /proc/nowhere/report.json", 7, "nowhere");
  EXPECT_FALSE(fs::exists(file("tooth.ply")));
}

}  // namespace
}  // namespace rhizodont
