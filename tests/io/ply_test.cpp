// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "io/io_test_tools.hpp"
#include "mesh/test_meshes.hpp"

#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

using test::Bytes, test::cube, test::expect_refused, test::load_bytes, test::tetrahedron;

const std::string ascii_ply =
    "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info nothing\r\nelement vertex 4\r\n"
    "property float x\r\nproperty float y\r\nproperty float z\r\nproperty uchar source\r\nproperty list uchar int "
    "links\r\n"
    "property double depth\r\n"
    "element face 2\r\nproperty uchar flag\r\nproperty list uchar uint vertex_index\r\nproperty float area\r\n"
    "element edge 1\r\nproperty int a\r\nproperty int b\r\nend_header\r\n"
    "0 0 0 0 0 0.25\r\n1 0 0 1 2 5 6 0.5\r\n1 1 0 2 0 0.75\r\n0 1 0 2 0 0.1\r\n"
    "9 4 0 1 2 3 1.0\r\n9 3 0 3 1 0.5\r\n0 1\r\n";

std::string binary_ply(std::endian order) {
  Bytes bytes(
      std::string("ply\nformat ") + (order == std::endian::big ? "binary_big_endian" : "binary_little_endian") +
          " 1.0\nelement vertex 4\nproperty double x\nproperty int16 y\nproperty float32 z\nproperty list int8 float64 "
          "extra\n"
          "property ushort tag\nelement face 2\nproperty list uint int vertex_indices\nproperty short s\nend_header\n",
      order);
  const std::array<Point, 4> points{Point(0.1, 0, 0), Point(1, 0, 0.5), Point(1, 1, 0), Point(0, -300, 0)};
  for (std::size_t v = 0; v < 4; ++v) {
    bytes.add(points[v].x()).add(static_cast<std::int16_t>(points[v].y())).add(static_cast<float>(points[v].z()));
    bytes.add(static_cast<std::int8_t>(v));
    for (std::size_t k = 0; k < v; ++k) bytes.add(7.0);
    bytes.add(static_cast<std::uint16_t>(60000 + v));
  }
  bytes.add(std::uint32_t{4});
  for (const std::int32_t v : {0, 1, 2, 3}) bytes.add(v);
  bytes.add(std::int16_t{-1}).add(std::uint32_t{3});
  for (const std::int32_t v : {2, 1, 0}) bytes.add(v);
  bytes.add(std::int16_t{-2});
  return bytes.str();
}

TEST(Ply, AsciiWithPolygonsAndExtras) {
  const MeshFile file = load_bytes("a.ply", ascii_ply);
  EXPECT_EQ(file.mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}));
  EXPECT_EQ(file.comments, std::vector<std::string>{"made by hand"});
  ASSERT_EQ(file.vertex_attributes.size(), 2U);
  EXPECT_EQ(file.vertex_attributes.at("source").type, AttributeType::uint8);
  EXPECT_EQ(file.vertex_attributes.at("source").values, (std::vector<double>{0, 1, 2, 2}));
  EXPECT_EQ(file.vertex_attributes.at("depth").values, (std::vector<double>{0.25, 0.5, 0.75, 0.1}));
}

TEST(Ply, BinaryOfBothByteOrdersIsTheSame) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const MeshFile file = load_bytes("a.ply", binary_ply(order));
    EXPECT_EQ(file.mesh.vertices, (std::vector<Point>{{0.1, 0, 0}, {1, 0, 0.5}, {1, 1, 0}, {0, -300, 0}}));
    EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}));
    EXPECT_EQ(file.vertex_attributes.at("tag").values, (std::vector<double>{60000, 60001, 60002, 60003}));
    EXPECT_FALSE(file.coordinates_fit_float);
  }
}

TEST(Ply, FloatTextIsTheNearestFloatDoubleTextTheNearestDouble) {
  std::string text = ascii_ply;
  text.replace(text.find("1 0 0 1 2"), 5, "0.1 0 0");
  EXPECT_EQ(load_bytes("a.ply", text).mesh.vertices[1].x(), static_cast<double>(0.1F));
  text.replace(text.find("float x"), 7, "double x");
  EXPECT_EQ(load_bytes("a.ply", text).mesh.vertices[1].x(), 0.1);
}

TEST(Ply, RoundTripKeepsEverything) {
  const test::TemporaryFolder folder;
  for (const bool floats : {true, false}) {
    MeshFile file;
    file.mesh = test::torus(9, 7);
    if (floats)
      for (Point& p : file.mesh.vertices) p = nearest_float(p);
    file.mesh.vertices[5].x() = -0.0;
    file.mesh.vertices.emplace_back(3, 3, 3);  // unreferenced
    file.comments = {"first", "", "third one"};
    const std::size_t count = file.mesh.vertices.size();
    VertexAttribute &source = file.vertex_attributes["source"], &doubt = file.vertex_attributes["uncertainty"];
    source.type = AttributeType::uint8;
    for (std::size_t v = 0; v < count; ++v) {
      source.values.push_back(static_cast<double>(v % 3));
      doubt.values.push_back(static_cast<double>(static_cast<float>(v) / 7));
    }
    save_mesh(folder.path() / "a.ply", file);
    const MeshFile again = load_mesh(folder.path() / "a.ply");
    EXPECT_TRUE(test::same_bits(again.mesh, file.mesh));
    EXPECT_EQ(again.comments, file.comments);
    EXPECT_EQ(again.vertex_attributes.at("source").values, source.values);
    EXPECT_EQ(again.vertex_attributes.at("source").type, AttributeType::uint8);
    EXPECT_EQ(again.vertex_attributes.at("uncertainty").type, AttributeType::float32);
    for (std::size_t v = 0; v < count; ++v)
      EXPECT_EQ(static_cast<float>(again.vertex_attributes.at("uncertainty").values[v]),
                static_cast<float>(doubt.values[v]));
    EXPECT_EQ(again.coordinates_fit_float, floats);
    const std::string header = test::read_all(folder.path() / "a.ply").substr(0, 400);
    EXPECT_EQ(header.find("property float x") != std::string::npos, floats);
    EXPECT_EQ(header.find("property double x") == std::string::npos, floats);
  }
}

TEST(Ply, SavingTwiceGivesTheSameBytes) {
  const test::TemporaryFolder folder;
  save_mesh(folder.path() / "a.ply", {cube(), {}, {"c"}, true, {}});
  save_mesh(folder.path() / "b.ply", {cube(), {}, {"c"}, true, {}});
  EXPECT_EQ(test::read_all(folder.path() / "a.ply"), test::read_all(folder.path() / "b.ply"));
}

std::string changed_ply(const std::string& what, const std::string& by) {
  std::string text = ascii_ply;
  return text.replace(text.find(what), what.size(), by);
}

TEST(Ply, BadHeadersAreRefusedWithTheirLine) {
  expect_refused("a.ply", "", "empty");
  expect_refused("a.ply", "PLX\n", "does not begin with 'ply'");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "line 4: the file ends within its header");
  expect_refused("a.ply", changed_ply("format ascii 1.0", "format text 1.0"), "line 2: 'text' is no format");
  expect_refused("a.ply", changed_ply("format ascii 1.0", "comment none"), "does not say the file's format");
  expect_refused("a.ply", changed_ply("property float x", "property floot x"), "line 6: 'floot' is no type");
  expect_refused("a.ply", changed_ply("property float x", "property list float int q"), "line 6");
  expect_refused("a.ply", changed_ply("property float y", "property float x"),
                 "line 7: the property 'x' is there twice");
  expect_refused("a.ply", changed_ply("element face 2", "element vertex 2"),
                 "line 12: the element 'vertex' is there twice");
  expect_refused("a.ply", changed_ply("element face 2", "element face many"), "line 12");
  expect_refused("a.ply", changed_ply("element vertex 4", "element vertex -4"), "line 5");
  expect_refused("a.ply", changed_ply("element vertex 4", "nonsense"), "line 5: 'nonsense'");
  expect_refused("a.ply", changed_ply("property float z", "property float w"), "no x, y and z");
  expect_refused("a.ply", changed_ply("vertex_index", "corners"), "no list of vertices");
}

TEST(Ply, HeadersThatLieAllocateNothing) {
  expect_refused("a.ply", changed_ply("element vertex 4", "element vertex 4000000000000"),
                 "announces 4000000000000 elements 'vertex'");
  expect_refused("a.ply", changed_ply("element face 2", "element face 18446744073709551615"), "elements 'face'");
  std::string binary = binary_ply(std::endian::little);
  binary.replace(binary.find("element vertex 4"), 16, "element vertex 999999999999");
  expect_refused("a.ply", binary, "announces 999999999999 elements 'vertex'");
  // the list of the first face is said to be of 4 thousand million corners
  binary = binary_ply(std::endian::little);
  binary.replace(binary.size() - 2 * 6 - 7 * 4, 4, "\xff\xff\xff\xff");
  expect_refused("a.ply", binary, "ends in element 0 of the 2 'face'");
}

TEST(Ply, EveryTruncationIsRefused) {
  for (const std::string& whole : {binary_ply(std::endian::little), binary_ply(std::endian::big)})
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(test::parse(read_ply, whole.substr(0, size)), InputError) << size;
}

TEST(Ply, BadContentsAreRefused) {
  expect_refused("a.ply", changed_ply("1 1 0 2 0", "1 nan 0 2 0"), "not finite");
  expect_refused("a.ply", changed_ply("1 1 0 2 0", "1 oops 0 2 0"), "line 22: 'oops'");
  expect_refused("a.ply", changed_ply("1 1 0 2 0", "1 1 0 256 0"),
                 "line 22: '256' is not a number of the announced type");
  expect_refused("a.ply", changed_ply("9 3 0 3 1", "9 3 0 4 1"), "vertices that do not exist");
  expect_refused("a.ply", changed_ply("9 3 0 3 1", "9 3 0 -3 1"), "line 25");
  expect_refused("a.ply", ascii_ply.substr(0, ascii_ply.find("3 1.0\r\n") + 1), "ends in element 0 of the 2 'face'");
  std::string pointless = ascii_ply;
  pointless.replace(pointless.find("element face 2"), 14, "element face 0");
  EXPECT_THROW(load_bytes("a.ply", pointless), InputError);
  try {
    load_bytes("a.ply", changed_ply("9 3 0 3 1", "9 3 0 4 1"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), std::vector<std::int64_t>{2});  // the third triangle
  }
}

TEST(Ply, WhatFollowsTheAnnouncedIsSaid) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_TRUE(load_bytes("a.ply", text + " \r\n\x1a").notes.empty());
  EXPECT_TRUE(test::notes_hold(load_bytes("a.ply", text + "3 0 2 1\n"), "goes on for 8 bytes"));
  MeshFile file;
  file.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::string binary = mesh_file_bytes("a.ply", file);
  EXPECT_TRUE(load_bytes("a.ply", binary).notes.empty());
  EXPECT_TRUE(test::notes_hold(load_bytes("a.ply", binary + "rubbish"), "goes on for 7 bytes"));
  for (const auto& [from, to, words] :
       {std::array{"int vertex_indices", "float vertex_indices", "'vertex_indices' holds decimal numbers"},
        {"int vertex_indices", "int corners", "their list is named 'corners'"}}) {
    std::string other = text;
    other.replace(other.find(from), std::string(from).size(), to);
    expect_refused("a.ply", other, words);
  }
}

TEST(Ply, StripsMayBeginAgainAndTurnEverySecondTime) {
  const std::string head =
      "format ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement camera "
      "1\nproperty float focus\nelement tristrips 2\nproperty uchar flag\nproperty list int int "
      "vertex_indices\nend_header\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n50\n";
  const MeshFile file = load_bytes("a.ply", "ply\n" + head + "9 9 0 1 2 3 -1 -1 4 2 3\n9 4 0 2 2 4\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {4, 2, 3}}));
  EXPECT_TRUE(file.dropped_triangles.empty());  // a corner twice only leads on
  expect_refused("a.ply", "ply\n" + head + "9 4 0 1 2 5\n9 3 0 1 2\n", "strip 0 (counted from 0) refers to a vertex");
  expect_refused("a.ply", "ply\n" + head + "9 4 0 1 2 -2\n9 3 0 1 2\n", "strip 0 (counted from 0) refers to a vertex");
}

TEST(Ply, HeadersWithReturnsAloneMayPrecedeAnyByte) {
  for (const char first : {'\n', '\r', 'x'}) {
    Bytes bytes(
        "ply\rformat binary_little_endian 1.0\relement vertex 3\rproperty uchar tag\rproperty float x\rproperty float "
        "y\rproperty float z\relement face 1\rproperty list uchar uchar vertex_indices\rend_header\r");
    for (int v = 0; v < 3; ++v) bytes.add(first).add(v == 1 ? 1.0F : 0.0F).add(v == 2 ? 1.0F : 0.0F).add(0.0F);
    bytes.add(std::uint8_t{3}).add(std::uint8_t{0}).add(std::uint8_t{1}).add(std::uint8_t{2});
    const MeshFile file = load_bytes("a.ply", bytes.str());
    EXPECT_EQ(file.mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  }
}

TEST(Ply, RepeatedCornersAreTakenOutAndNoted) {
  const MeshFile file = load_bytes("a.ply", changed_ply("9 4 0 1 2 3", "9 4 0 1 1 3"));
  EXPECT_EQ(file.dropped_triangles, std::vector<std::int64_t>{0});
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {0, 3, 1}}));
}

}  // namespace
}  // namespace rhizodont
