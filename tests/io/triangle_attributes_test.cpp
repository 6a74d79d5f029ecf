// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Values of faces, in the formats that have them, and which vertex of the file became which.
#include "io/io_test_tools.hpp"

namespace rhizodont {
namespace {

using test::load_bytes, test::notes_hold;
using Values = std::vector<double>;

/// A square as a quad, a triangle without area, a triangle; numbered 7, 8, 9.
const std::string ply_faces =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
    "property int fdi\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 2 1\n"
    "7 4 0 1 2 3 0 255 0 1\n8 3 0 0 1 1 .5 1 2 3\n9 3 1 4 2 2 .5 .5 0 255 2\n";

TEST(TriangleAttributes, OfPlyFacesGoToTheirTriangles) {
  const MeshFile file = load_bytes("a.ply", ply_faces);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}));
  EXPECT_EQ(file.dropped_triangles, (std::vector<std::int64_t>{2}));
  EXPECT_EQ(file.triangle_attributes.at("fdi").values, (Values{7, 7, 9}));
  EXPECT_EQ(file.triangle_attributes.at("fdi").type, AttributeType::int32);
  EXPECT_EQ(file.triangle_attributes.at("red").values, (Values{255, 255, 0}));
  EXPECT_EQ(file.triangle_attributes.at("blue").values, (Values{1, 1, 2}));
  EXPECT_TRUE(notes_hold(file, "can serve as labels"));
  EXPECT_TRUE(file.vertex_attributes.empty());
}

TEST(TriangleAttributes, AreWrittenToPly) {
  MeshFile file = load_bytes("a.ply", ply_faces);
  const MeshFile again = read_mesh(mesh_file_bytes("a.ply", file), "ply");
  EXPECT_EQ(again.triangle_attributes.size(), 4U);
  for (const auto& [name, attribute] : file.triangle_attributes) {
    EXPECT_EQ(again.triangle_attributes.at(name).values, attribute.values) << name;
    EXPECT_EQ(again.triangle_attributes.at(name).type, attribute.type) << name;
  }
  file.triangle_attributes["fdi"].values.pop_back();
  EXPECT_THROW(mesh_file_bytes("a.ply", file), InputError);
}

TEST(TriangleAttributes, StripsBesidePlyFacesHaveNone) {
  std::string text = ply_faces;
  text.replace(text.find("end_header"), 10, "element tristrips 1\nproperty list int int vertex_indices\nend_header");
  const MeshFile file = load_bytes("a.ply", text + "3 2 4 3\n");
  EXPECT_EQ(file.mesh.triangles.size(), 4U);
  EXPECT_TRUE(file.triangle_attributes.empty());
  EXPECT_TRUE(notes_hold(file, "the strips beside them have none"));
}

/// Two single points, a line, two polygons, one strip: cells 0-5.
std::string vtk_cells(bool strips_first) {
  const std::string polygons = "POLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n", strips = "TRIANGLE_STRIPS 1 5\n4 0 1 3 4\n";
  return "# vtk DataFile Version 4.2\nt\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n0 0 0 1 0 0 1 1 0 0 1 0 2 2 1\n"
         "VERTICES 2 4\n1 0 1 1\nLINES 1 3\n2 0 1\n" +
         (strips_first ? strips + polygons : polygons + strips) +
         "CELL_DATA 6\nSCALARS Universal%5fID int\nLOOKUP_TABLE default\n33 33 33 8 9 10\nFIELD FieldData 2\n"
         "Label 1 6 long\n0 0 0 1 2 3\nwrong 1 3 int\n1 2 3\nCOLOR_SCALARS c 3\n" +
         "0 0 0 0 0 0 0 0 0 1 0 0 0 1 0 0 0 1\nPOINT_DATA 5\nSCALARS Label short 1\nLOOKUP_TABLE default\n1 2 3 4 5\n";
}

TEST(TriangleAttributes, OfLegacyVtkCellsCountThroughAllKinds) {
  const MeshFile file = load_bytes("a.vtk", vtk_cells(false));
  EXPECT_EQ(file.mesh.triangles.size(), 5U);
  EXPECT_EQ(file.triangle_attributes.at("Universal_ID").values, (Values{8, 8, 9, 10, 10}));
  EXPECT_EQ(file.triangle_attributes.at("Label").values, (Values{1, 1, 2, 3, 3}));
  EXPECT_EQ(file.triangle_attributes.at("green").values, (Values{0, 0, 255, 0, 0}));
  EXPECT_EQ(file.vertex_attributes.at("Label").values, (Values{1, 2, 3, 4, 5}));
  EXPECT_EQ(file.vertex_attributes.at("Label").type, AttributeType::int16);
  EXPECT_TRUE(notes_hold(file, "'wrong' has 3 values for 6 cells"));
  // the same cells, whichever kind stands first in the file
  const MeshFile turned = load_bytes("a.vtk", vtk_cells(true));
  EXPECT_EQ(turned.triangle_attributes.at("Label").values, (Values{3, 3, 1, 1, 2}));
}

TEST(TriangleAttributes, OfVtpCells) {
  const std::string text =
      "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>"
      "<Piece NumberOfPoints=\"4\" NumberOfVerts=\"1\" NumberOfPolys=\"1\" NumberOfStrips=\"1\">"
      "<CellData Scalars=\"Label\"><DataArray type=\"Float64\" Name=\"Label\">0 5 6</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"RGB\" NumberOfComponents=\"3\">0 0 0 9 8 7 6 5 4</DataArray>"
      "<DataArray type=\"Int32\" Name=\"short\">1 2</DataArray><DataArray type=\"Int32\" Name=\"none\"/></CellData>"
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 1 1 0 0 1 1</DataArray></Points>"
      "<Verts><DataArray type=\"Int32\" Name=\"connectivity\">0</DataArray><DataArray type=\"Int32\" "
      "Name=\"offsets\">1</DataArray></Verts>"
      "<Polys><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2</DataArray><DataArray type=\"Int32\" "
      "Name=\"offsets\">3</DataArray></Polys>"
      "<Strips><DataArray type=\"Int32\" Name=\"connectivity\">0 2 3 1</DataArray><DataArray type=\"Int32\" "
      "Name=\"offsets\">4</DataArray></Strips></Piece></PolyData></VTKFile>";
  const MeshFile file = load_bytes("a.vtp", text);
  EXPECT_EQ(file.triangle_attributes.at("Label").values, (Values{5, 6, 6}));
  EXPECT_EQ(file.triangle_attributes.at("green").values, (Values{8, 5, 5}));
  EXPECT_FALSE(file.triangle_attributes.contains("short"));
  EXPECT_TRUE(notes_hold(file, "'short' has 2 values for 3 cells"));
}

TEST(TriangleAttributes, ThereIsAVertexForEachOfTheFile) {
  const MeshFile soup =
      load_bytes("a.obj", "v 5 5 5\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4\nf 5 6 7\n");
  EXPECT_EQ(soup.file_vertices, (std::vector<int>{0, 1, 2, 3, 5}));
  EXPECT_EQ(soup.mesh_vertices, (std::vector<int>{0, 1, 2, 3, 2, 4, 3}));
  EXPECT_EQ(vertices_in_file(soup), 7U);
  EXPECT_TRUE(soup.file_numbers_vertices);
  const MeshFile plain = load_bytes("a.ply", ply_faces);
  EXPECT_TRUE(plain.mesh_vertices.empty());
  EXPECT_EQ(vertices_in_file(plain), 5U);
  const std::string stl = mesh_file_bytes("a.stl", plain);
  EXPECT_FALSE(read_mesh(stl, "stl").file_numbers_vertices);
}

}  // namespace
}  // namespace rhizodont
