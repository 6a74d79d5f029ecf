// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "io/io_test_tools.hpp"
#include "mesh/test_meshes.hpp"

#include <cmath>
#include <fstream>
#include <limits>

namespace rhizodont {
namespace {

using test::Bytes, test::cube, test::expect_refused, test::load_bytes, test::tetrahedron;

std::string binary_stl(const std::string& title, const std::vector<std::array<std::array<float, 3>, 3>>& facets) {
  std::string header = title;
  header.resize(80, '\0');
  Bytes bytes(header);
  bytes.add(static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    for (int i = 0; i < 3; ++i) bytes.add(std::numeric_limits<float>::quiet_NaN());  // normals are not looked at
    for (const auto& corner : facet)
      for (const float x : corner) bytes.add(x);
    bytes.add(std::uint16_t{7});
  }
  return bytes.str();
}

const std::vector<std::array<std::array<float, 3>, 3>> two_facets{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                                                  {{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};

const std::string ascii_square =
    "solid two triangles\n"
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\n"
    " FACET NORMAL nan nan nan\n  OUTER LOOP\n   VERTEX +1.0e0 0 0\n   VERTEX 1 1 0\n   VERTEX 0 1 -0\n  ENDLOOP\n "
    "ENDFACET\n"
    "endsolid two triangles\n";

TEST(Stl, BinaryIsWeldedInOrderOfFirstAppearance) {
  const MeshFile file = load_bytes("a.stl", binary_stl("made by hand", two_facets));
  EXPECT_EQ(file.mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_TRUE(file.coordinates_fit_float);
}

TEST(Stl, BinaryThatBeginsWithSolidIsBinary) {
  const MeshFile expected = load_bytes("a.stl", binary_stl("x", two_facets));
  for (const char* title : {"solid", "solid facet normal", "solid \nfacet normal 0 0 1"})
    EXPECT_TRUE(test::same_bits(load_bytes("a.stl", binary_stl(title, two_facets)).mesh, expected.mesh)) << title;
}

TEST(Stl, AsciiIsTheSameMesh) {
  const MeshFile file = load_bytes("a.STL", ascii_square);
  EXPECT_TRUE(test::same_bits(file.mesh, load_bytes("a.stl", binary_stl("x", two_facets)).mesh));
}

TEST(Stl, AsciiNumbersBecomeTheNearestFloat) {
  std::string text = ascii_square;
  text.replace(text.find("vertex 0 0 0"), 12, "vertex 0.1 0.2 1e-60");
  const MeshFile file = load_bytes("a.stl", text);
  EXPECT_EQ(file.mesh.vertices[0], Point(0.1F, 0.2F, 0));
  EXPECT_TRUE(file.coordinates_fit_float);
}

TEST(Stl, ZerosOfBothSignsAreOneVertexNeighbouringFloatsAreNot) {
  auto facets = two_facets;
  facets[1][0][1] = -0.0F;
  facets[1][2][0] = std::nextafter(0.0F, 1.0F);
  EXPECT_EQ(load_bytes("a.stl", binary_stl("x", facets)).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 4}}));
}

TEST(Stl, FlatFacetsAreTakenOutAndNoted) {
  auto facets = two_facets;
  facets.insert(facets.begin() + 1, {{{5, 5, 5}, {5, 5, 5}, {6, 5, 5}}});
  const MeshFile file = load_bytes("a.stl", binary_stl("x", facets));
  EXPECT_EQ(file.dropped_triangles, std::vector<std::int64_t>{1});
  EXPECT_EQ(file.mesh.triangles.size(), 2U);
}

TEST(Stl, RoundTripKeepsBitsAndOrder) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh = test::sphere(2);
  for (Point& p : mesh.vertices) p = nearest_float(p);
  // STL numbers vertices by first appearance: once through the format, it stays as it is
  save_mesh(folder.path() / "a.stl", {mesh, {}, {}, true, {}});
  const MeshFile once = load_mesh(folder.path() / "a.stl");
  save_mesh(folder.path() / "b.stl", once);
  EXPECT_TRUE(test::same_bits(load_mesh(folder.path() / "b.stl").mesh, once.mesh));
  ASSERT_EQ(once.mesh.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(once.mesh.vertices[static_cast<std::size_t>(once.mesh.triangles[t][i])],
                mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])]);
}

TEST(Stl, TheHeaderNamesTheUnit) {
  const test::TemporaryFolder folder;
  MeshFile file;
  file.mesh = cube();
  const auto header = [&] {
    save_mesh(folder.path() / "a.stl", file);
    std::string start(30, ' ');
    std::ifstream(folder.path() / "a.stl", std::ios::binary).read(start.data(), 30);
    return start;
  };
  EXPECT_EQ(header().find("Rhizodont, millimetres "), 0U);
  file.comments = {"a tooth", "unit: micrometres"};
  EXPECT_EQ(header().find("Rhizodont, micrometres "), 0U);
}

TEST(Stl, DoubleCoordinatesAreNotSquashedSilently) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh = cube();
  mesh.vertices[3].x() = 0.1;
  EXPECT_THROW(save_mesh(folder.path() / "a.stl", {mesh, {}, {}, true, {}}), UsageError);
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Stl, BadFilesAreRefused) {
  const std::string good = binary_stl("x", two_facets);
  expect_refused("a.stl", "", "empty");
  expect_refused("a.stl", "hello", "does not begin with 'solid' and 'facet'");
  expect_refused("a.stl", good.substr(0, 83), "too short");
  expect_refused("a.stl", good.substr(0, good.size() - 1), "announces 2 triangles and has room for 1");
  expect_refused("a.stl", binary_stl("x", {}), "no triangles");
  Bytes absurd(std::string(80, 'x'));
  absurd.add(std::uint32_t{0xffffffffU}).add(1.0F);
  expect_refused("a.stl", absurd.str(), "has room for 0 triangles only");
  auto facets = two_facets;
  facets[1][2][0] = std::numeric_limits<float>::quiet_NaN();
  expect_refused("a.stl", binary_stl("x", facets), "triangle 1");
  facets = {{{{1, 1, 1}, {1, 1, 1}, {2, 1, 1}}}};
  expect_refused("a.stl", binary_stl("x", facets), "three different corners");
}

TEST(Stl, WhateverFollowsTheEndOfATextIsPassedOver) {
  const MeshFile whole = load_bytes("a.stl", ascii_square);
  for (const char* junk : {"end of file\n", "facets: 2\n", "facet count 2\n", "end\n", "-- made by a program\n"}) {
    const MeshFile file = load_bytes("a.stl", ascii_square + junk);
    EXPECT_EQ(file.mesh.triangles, whole.mesh.triangles) << junk;
    EXPECT_TRUE(test::notes_hold(file, "after the end of the mesh was passed over")) << junk;
  }
  const std::string second = ascii_square.substr(ascii_square.find(" facet"));
  for (const std::string& more : {ascii_square, "solid\n" + second, second, "end of file\n" + ascii_square})
    EXPECT_EQ(load_bytes("a.stl", ascii_square + more).mesh.triangles.size(), 4U) << more;
  expect_refused("a.stl", "solid s\n" + std::string("end of file\n"), "'solid' is expected");
}

TEST(Stl, BadTextIsRefusedWithItsLine) {
  const auto changed = [](const std::string& what, const std::string& by) {
    std::string text = ascii_square;
    return text.replace(text.find(what), what.size(), by);
  };
  expect_refused("a.stl", "solid nothing\nendsolid nothing\n", "no triangles");
  expect_refused("a.stl", changed("vertex 1 0 0", "vertex 1 x 0"), "line 5");
  expect_refused("a.stl", changed("vertex 1 0 0", "vertex 1 nan 0"), "line 5: a coordinate is not a finite number");
  expect_refused("a.stl", changed("vertex 1 0 0", "vertex 1 1e99 0"), "line 5: a coordinate is not a finite number");
  expect_refused("a.stl", changed("endloop", "vertex 2 2 2\n  endloop"), "'endloop' is expected, 'vertex' was found");
  expect_refused("a.stl", changed("endsolid", "nonsense"), "line 16");
  expect_refused("a.stl", ascii_square.substr(0, ascii_square.find("endloop")), "line 7: the file ends in the middle");
}

}  // namespace
}  // namespace rhizodont
