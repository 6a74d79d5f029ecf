// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/weld.hpp"

#include "io/io_test_tools.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/test_meshes.hpp"

namespace rhizodont {
namespace {

MeshFile file_of(TriangleMesh mesh) {
  MeshFile file;
  file.mesh = std::move(mesh);
  return file;
}

/// Every triangle with vertices of its own.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::int32_t>(soup.vertices.size());
    for (const std::int32_t v : t) soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Weld, ASoupBecomesTheMeshItWas) {
  const TriangleMesh dome = test::dome(2);
  MeshFile file = file_of(soup_of(dome));
  VertexAttribute& number = file.vertex_attributes["number"];
  for (std::size_t v = 0; v < file.mesh.vertices.size(); ++v) number.values.push_back(static_cast<double>(v));
  const std::vector<Point> before = file.mesh.vertices;
  weld_seams(file);
  ASSERT_EQ(file.mesh.vertices.size(), dome.vertices.size());
  EXPECT_EQ(border_loops(file.mesh).size(), 1U);
  EXPECT_EQ(connected_components(file.mesh).count, 1);
  for (std::size_t t = 0; t < dome.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(file.mesh.vertices[static_cast<std::size_t>(file.mesh.triangles[t][i])],
                dome.vertices[static_cast<std::size_t>(dome.triangles[t][i])]);
  // numbers and attributes are those of the first in the file, in its order
  ASSERT_EQ(file.file_vertices.size(), dome.vertices.size());
  EXPECT_TRUE(std::is_sorted(file.file_vertices.begin(), file.file_vertices.end()));
  for (std::size_t v = 0; v < file.file_vertices.size(); ++v) {
    const auto in_file = static_cast<std::size_t>(file.file_vertices[v]);
    EXPECT_EQ(file.mesh.vertices[v], before[in_file]);
    EXPECT_EQ(number.values[v], static_cast<double>(in_file));
    for (std::size_t earlier = 0; earlier < in_file; ++earlier) EXPECT_NE(before[earlier], before[in_file]);
  }
  EXPECT_TRUE(test::notes_hold(file, "merged"));
}

TEST(Weld, NothingToWeldChangesNothing) {
  MeshFile file = file_of(test::torus(7, 5));
  file.mesh.vertices.push_back(file.mesh.vertices[3]);  // used by no triangle
  const TriangleMesh before = file.mesh;
  weld_seams(file);
  EXPECT_TRUE(test::same_bits(file.mesh, before));
  EXPECT_TRUE(file.file_vertices.empty());
  EXPECT_TRUE(file.notes.empty());
}

TEST(Weld, ASeamIsClosedAndZerosOfBothSignsAreEqual) {
  // two squares side by side that share no vertex; a slit whose end is one vertex
  MeshFile file =
      file_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, -0.0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, -0.0}},
               {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}});
  weld_seams(file);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}));
  EXPECT_EQ(file.file_vertices, (std::vector<int>{0, 1, 2, 3, 5, 6}));
  MeshFile slit = file_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 3, 4}}});
  weld_seams(slit);
  EXPECT_EQ(slit.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Weld, SheetsThatTouchInAPointStayApart) {
  TriangleMesh mesh = test::together(test::grid(2), test::grid(2), {2, 2, 0});
  MeshFile file = file_of(mesh);
  weld_seams(file);
  EXPECT_TRUE(test::same_bits(file.mesh, mesh));
}

TEST(Weld, EdgesThatHaveTheirTwoTrianglesAreLeftAlone) {
  // two tetrahedra with one edge at the same place: closed as they are, four triangles at an edge if welded
  TriangleMesh mesh = test::tetrahedron();
  for (const Point& p : test::tetrahedron().vertices) mesh.vertices.emplace_back(-p.x(), -p.y(), p.z());
  for (const auto& [a, b, c] : test::tetrahedron().triangles) mesh.triangles.push_back({a + 4, b + 4, c + 4});
  MeshFile file = file_of(mesh);
  weld_seams(file);
  EXPECT_TRUE(test::same_bits(file.mesh, mesh));
}

TEST(Weld, ASurfaceGivenTwiceIsSeenAsThat) {
  const TriangleMesh dome = test::dome(1);
  MeshFile file = file_of(test::together(dome, flipped(dome), {0, 0, 0}));
  weld_seams(file);
  EXPECT_EQ(file.mesh.vertices.size(), dome.vertices.size());
}

TEST(Weld, AnEdgeWithoutLengthIsOneVertex) {
  // triangle 1 has two vertices at one place: it goes, and its neighbours meet
  const test::TemporaryFolder folder;
  const MeshFile file =
      test::load_bytes("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nv -1 0 0\nf 1 2 3\nf 1 3 4\nf 1 4 5\n");
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(file.dropped_triangles, std::vector<std::int64_t>{1});
  EXPECT_TRUE(test::notes_hold(file, "1 vertex was merged"));
  EXPECT_TRUE(test::notes_hold(file, "1 facet without area was left out"));
}

}  // namespace
}  // namespace rhizodont
