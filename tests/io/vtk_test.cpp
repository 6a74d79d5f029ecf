// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/io_test_tools.hpp"

namespace rhizodont {
namespace {

using test::Bytes, test::expect_refused, test::load_bytes;

const std::vector<Point> uneven_square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1F}};

/// A uneven_square as a polygon and as a strip beside lines and values of every kind, as version 4 writes it.
const std::string text_4 =
    "# vtk DataFile Version 4.2\nvtk output\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nTimeValue 1 1 double\n0\n"
    "POINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0.1\n\nMETADATA\nINFORMATION 1\nNAME L2_NORM LOCATION vtkDataArray\nDATA 2 "
    "0 1\n\n"
    "VERTICES 1 2\n1 0\nLINES 1 4\n3 0 1 2\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 3 2 0 1\n"
    "CELL_DATA 4\nSCALARS Label int 1\nLOOKUP_TABLE default\n1 2 3 4\nPOINT_DATA 4\n"
    "SCALARS Universal%5fID%20a unsigned_char\nLOOKUP_TABLE mine\n1 2 3 4\nLOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\n"
    "NORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1\nVECTORS v double\n1 2 3 4 5 6 7 8 9 10 11 12\n"
    "TEXTURE_COORDINATES t 2 float\n0 0 0 1 1 0 1 1\nCOLOR_SCALARS c 3\n1 0 0 0 1 0 0 0 1 0.2 0.2 0.2\n"
    "FIELD FieldData 3\nheight 1 4 double\n0.1 0.2 0.3 0.4\nMETADATA\nINFORMATION 0\n\npair 2 4 short\n1 2 3 4 5 6 7 "
    "8\n"
    "names 1 2 string\nfirst name\nsecond\n";

void expect_square(const MeshFile& file) {
  EXPECT_EQ(file.mesh.vertices, uneven_square);
  EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 0}, {0, 2, 1}}));
  EXPECT_EQ(file.vertex_attributes.at("height").values, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(file.vertex_attributes.at("Universal_ID a").values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(file.vertex_attributes.at("Universal_ID a").type, AttributeType::uint8);
  EXPECT_EQ(file.vertex_attributes.at("red").values, (std::vector<double>{255, 0, 0, 51}));
  EXPECT_EQ(file.vertex_attributes.size(), 5U);
  EXPECT_TRUE(file.notes.empty());
}

/// The same, in bytes, as version 5 writes it.
std::string binary_5() {
  Bytes b("# vtk DataFile Version 5.1\nvtk output\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n", std::endian::big);
  for (const Point& p : uneven_square)
    for (const double x : p) b.add(static_cast<float>(x));
  const auto add_cells = [&](const std::vector<std::int64_t>& offsets, const std::vector<std::int64_t>& corners) {
    b.add_text("OFFSETS vtktypeint64\n");
    for (const std::int64_t o : offsets) b.add(o);
    b.add_text("\nCONNECTIVITY vtktypeint64\n");
    for (const std::int64_t c : corners) b.add(c);
  };
  b.add_text("\nMETADATA\nINFORMATION 0\n\nLINES 2 3\n");
  add_cells({0, 3}, {0, 1, 2});
  b.add_text("\nPOLYGONS 2 4\n");
  add_cells({0, 4}, {0, 1, 2, 3});
  b.add_text("\nTRIANGLE_STRIPS 2 4\n");
  add_cells({0, 4}, {3, 2, 0, 1});
  b.add_text("\nPOINT_DATA 4\nSCALARS Universal%5fID%20a unsigned_char\nLOOKUP_TABLE default\n");
  for (const int k : {1, 2, 3, 4}) b.add(static_cast<std::uint8_t>(k));
  b.add_text("\nSCALARS flags bit\nLOOKUP_TABLE default\n\x0a\nCOLOR_SCALARS c 4\n");
  for (const int k : {255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 51, 51, 51, 9}) b.add(static_cast<std::uint8_t>(k));
  b.add_text("\nFIELD FieldData 2\nnames 1 2 string\n");
  b.add_text(
      "\xc5"
      "first"
      "\x80\x46" +
      std::string(70, 'x') + "\nheight 1 4 double\n");
  for (const double h : {0.1, 0.2, 0.3, 0.4}) b.add(h);
  return b.add_text("\n").str();
}

TEST(Vtk, TextWithValuesOfEveryKind) {
  const MeshFile file = load_bytes("a.vtk", text_4);
  expect_square(file);
  EXPECT_EQ(file.triangle_attributes.at("Label").values, (std::vector<double>{3, 3, 4, 4}));
  EXPECT_EQ(file.triangle_attributes.size(), 1U);
}

TEST(Vtk, BytesOfVersion5) {
  const std::string bytes = binary_5();
  // the second text's length stands in two bytes
  expect_square(load_bytes("a.vtk", bytes));
}

TEST(Vtk, EveryTruncationOfBytesIsRefused) {
  const std::string whole = binary_5();
  const std::size_t mesh_end = whole.find("POINT_DATA"), polygons_end = whole.find("\nTRIANGLE_STRIPS");
  for (std::size_t size = 0; size < mesh_end - 2; ++size) {
    if (size == polygons_end || size == polygons_end + 1) continue;  // there the file is whole, without its strips
    EXPECT_THROW(test::parse(read_vtk, whole.substr(0, size)), InputError) << size;
  }
}

std::string changed_vtk(const std::string& what, const std::string& by) {
  std::string text = text_4;
  return text.replace(text.find(what), what.size(), by);
}

TEST(Vtk, ValuesThatDoNotFitAreNoted) {
  const MeshFile file =
      load_bytes("a.vtk", changed_vtk("height 1 4 double\n0.1 0.2 0.3 0.4", "height 1 3 double\n0.1 0.2 0.3"));
  EXPECT_EQ(file.mesh.vertices, uneven_square);
  EXPECT_FALSE(file.vertex_attributes.contains("height"));
  EXPECT_TRUE(test::notes_hold(file, "'height' has 3 values for 4 points"));
}

TEST(Vtk, KeywordsMayBeWrittenInAnyCase) {
  std::string text = text_4;
  for (const char* keyword : {"NORMALS", "VECTORS", "TEXTURE_COORDINATES", "COLOR_SCALARS", "POINT_DATA", "POLYGONS"}) {
    std::string lower = keyword;
    for (char& c : lower) c = c == '_' ? c : static_cast<char>(c - 'A' + 'a');
    text.replace(text.find(keyword), lower.size(), lower);
  }
  expect_square(load_bytes("a.vtk", text));
}

TEST(Vtk, WhatIsNotKnownAfterTheMeshIsPassedOver) {
  const MeshFile file = load_bytes("a.vtk", changed_vtk("VECTORS", "ARROWS"));
  EXPECT_EQ(file.mesh.vertices, uneven_square);
  EXPECT_TRUE(test::notes_hold(file, "'ARROWS' is not known in a VTK file"));
}

TEST(Vtk, BitsNeedABytePerEight) {
  const std::string whole = binary_5();
  const std::string mesh = whole.substr(0, whole.find("\nPOINT_DATA"));
  EXPECT_EQ(load_bytes("a.vtk", mesh + "\nFIELD F 1\nflag 1 17 bit\nabc").mesh.vertices, uneven_square);
  for (const char* cut : {"\nFIELD F 1\nflag 1 1 bit\n", "\nFIELD F 1\nflag 1 1 bit", "\nFIELD F 1\nflag 1 17 bit\nab",
                          "\nFIELD F 1\nflag 4294967296 4294967296 bit\nab"})
    expect_refused("a.vtk", mesh + cut, "cut off");
}

TEST(Vtk, NotesQuoteNothingThatATerminalObeys) {
  const MeshFile file =
      load_bytes("a.vtk", changed_vtk("height 1 4 double\n0.1 0.2 0.3 0.4", "h%1b[2J 1 3 double\n0.1 0.2 0.3"));
  EXPECT_TRUE(test::notes_hold(file, "'h?[2J' has 3 values"));
}

TEST(Vtk, BadFilesAreRefused) {
  expect_refused("a.vtk", changed_vtk("ASCII", "TEXT"), "'TEXT' is no encoding");
  expect_refused("a.vtk", changed_vtk("DATASET POLYDATA", "DATASET STRUCTURED_POINTS"),
                 "'STRUCTURED_POINTS', no surface");
  expect_refused("a.vtk", changed_vtk("POINTS 4 float", "POINTS 4 number"), "'number' is no type of number");
  expect_refused("a.vtk", changed_vtk("POINTS 4 float", "POINTS float"), "the number of points is missing");
  expect_refused("a.vtk", changed_vtk("POINTS 4 float", "POINTS 4000000000000 float"), "no room for all");
  expect_refused("a.vtk", changed_vtk("POINTS 4 float", "POINTS 9223372036854775807 float"), "no room for all");
  expect_refused("a.vtk", changed_vtk("POLYGONS 1 5", "POLYGONS 1 4000000000"), "no room for all");
  expect_refused("a.vtk", changed_vtk("POLYGONS 1 5\n4 0", "POLYGONS 1 5\n5 0"),
                 "polygon 0 (counted from 0) lies outside");
  expect_refused("a.vtk", changed_vtk("POLYGONS 1 5\n4 0", "POLYGONS 1 5\n-4 0"),
                 "polygon 0 (counted from 0) lies outside");
  expect_refused("a.vtk", changed_vtk("4 0 1 2 3", "4 0 1 2 4"), "polygon 0 (counted from 0) refers to a vertex");
  expect_refused("a.vtk", changed_vtk("0 0 0 1 0 0", "0 0 0 1 0 x"), "'x' is not a number");
  expect_refused("a.vtk", changed_vtk("0 0 0 1 0 0", "0 0 nan 1 0 0"), "not finite");
  expect_refused("a.vtk", changed_vtk("POINTS 4", "PLACES 4"), "'PLACES' is not known in a VTK file");
  expect_refused("a.vtk", text_4.substr(0, text_4.find("0 1 0.1")), "cut off");
  expect_refused("a.vtk", "# vtk DataFile Version 3.0\n", "no encoding");
}

}  // namespace
}  // namespace rhizodont
