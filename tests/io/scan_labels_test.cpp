// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scan_labels.hpp"
#include "io/io_test_tools.hpp"
#include "io/write_labels.hpp"
#include "mesh/test_meshes.hpp"

#include <fmt/format.h>

#include <functional>

namespace rhizodont {
namespace {

void expect_label_error(const std::function<void()>& call, const std::string& words) {
  try {
    call();
    FAIL() << "accepted, expected: " << words;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what() << "\nshould hold: " << words;
  }
}

/// Two triangles that share an edge, six vertices in the file and an unreferenced one before them.
MeshFile soup() {
  return test::load_bytes("a.obj", "v 5 5 5\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 2 3 4\nf 5 6 7\n");
}

MeshFile tetrahedron_file() {
  MeshFile file;
  file.mesh = test::tetrahedron();
  return file;
}

TEST(Teeth3ds, LabelsStandInTheFilesOwnOrder) {
  const RawLabels labels = labels_from_teeth3ds(
      R"({"id_patient": "Name", "jaw": "upper", "labels": [0, 11, 12, 13, 12, 21, 11], "instances": []})", soup());
  // of the file's vertices 3 (13) and 6 (11) that are one, the first counts
  EXPECT_EQ(labels.per_vertex, (std::vector<int>{0, 11, 12, 13, 21}));
  EXPECT_EQ(labels.stated_jaw, Jaw::upper);
  EXPECT_EQ(labels.stated_numbers, LabelNumbers::fdi);
  EXPECT_EQ(labels.origin.find("Name"), std::string::npos);
  const RawLabels bare = labels_from_teeth3ds(R"({"labels": [0, 36.0, 0, 36], "jaw": ""})", tetrahedron_file());
  EXPECT_EQ(bare.per_vertex, (std::vector<int>{0, 36, 0, 36}));
  EXPECT_FALSE(bare.stated_jaw);
}

TEST(Teeth3ds, WhatIsWrongIsSaid) {
  const auto expect = [](const std::string& json, const std::string& words) {
    expect_label_error([&] { labels_from_teeth3ds(json, tetrahedron_file()); }, words);
  };
  expect("", "the label file is empty");
  expect(" \n", "the label file is empty");
  expect("[1, 2, 3, 4]", "is a list");
  expect("5", "is a single value");
  expect("{\"labels\": [1, 2", "is no JSON");
  expect("solid x", "is no JSON");
  expect("{}", "has no 'labels'");
  expect(R"({"labels": []})", "has no labels");
  expect(R"({"labels": 3})", "no list of numbers");
  expect(R"({"labels": [1, 2, 3.5, 4]})", "label 2 (counted from 0) of the label file is no whole number");
  expect(R"({"labels": [1, 2, 3, "4"]})", "label 3");
  expect(R"({"labels": [1, 2, null, 4]})", "label 2");
  expect(R"({"labels": [1, 1e300, 2, 4]})", "label 1");
  expect(R"({"labels": [1, 2, -3, 4]})", "label 2 (counted from 0) of the label file is negative (-3)");
  expect(R"({"labels": [1, 2, 3, 4, 5]})", "there are 5 labels for 4 vertices");
  expect(R"({"labels": [1, 2, 3, 4], "jaw": "both"})", "neither \"upper\" nor \"lower\"");
  expect_label_error([] { labels_from_teeth3ds(R"({"labels": [0, 11, 12, 13, 21]})", soup()); },
                     "there are 5 labels for 7 vertices");
}

TEST(Teeth3ds, StlHasCornersOrWeldedVertices) {
  // a square, and a triangle without area between its halves
  std::string text = "solid\n";
  for (const char* triangle :
       {"vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n", "vertex 0 0 0\nvertex 0 0 0\nvertex 1 1 0\n",
        "vertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\n"})
    text += std::string("facet normal 0 0 1\nouter loop\n") + triangle + "endloop\nendfacet\n";
  const MeshFile stl = test::load_bytes("a.stl", text + "endsolid\n");
  ASSERT_EQ(stl.mesh.triangles.size(), 2U);
  EXPECT_EQ(labels_from_teeth3ds(R"({"labels": [1, 2, 3, 4]})", stl).per_vertex, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(labels_from_teeth3ds(R"({"labels": [1, 2, 3, 9, 9, 9, 5, 3, 4]})", stl).per_vertex,
            (std::vector<int>{1, 2, 3, 4}));
  expect_label_error([&] { labels_from_teeth3ds(R"({"labels": [1, 2, 3, 4, 5, 6]})", stl); },
                     "an STL file does not number its vertices: labels could only be for its 4 vertices at different "
                     "places or for its 9 corners");
}

VertexAttribute whole(std::vector<double> values) { return {AttributeType::int32, std::move(values)}; }

TEST(LabelArrays, AreFoundByTheirUsualNames) {
  for (const char* name : {"Label", "label", "Universal_ID", "UniversalID", "PredictedID", "predictedId", "MaterialIds",
                           "GroupIds", "fdi", "scalar", "scalar_Label", "tooth", "ToothNumber"}) {
    MeshFile file = tetrahedron_file();
    file.vertex_attributes["curvature"] = {AttributeType::float32, {0.5, 1, 2, 3}};
    EXPECT_FALSE(has_label_array(file));
    file.vertex_attributes[name] = whole({1, 0, 3, 4});
    EXPECT_TRUE(has_label_array(file));
    const RawLabels labels = labels_from_array(file);
    EXPECT_EQ(labels.per_vertex, (std::vector<int>{1, 0, 3, 4}));
    EXPECT_EQ(labels.origin, fmt::format("the point array {}", name));
  }
}

TEST(LabelArrays, NamesTellWhatTheNumbersMayBe) {
  MeshFile file = tetrahedron_file();
  file.vertex_attributes["Universal_ID"] = whole({1, 0, 3, 33});
  EXPECT_EQ(labels_from_array(file).stated_numbers, LabelNumbers::universal);
  EXPECT_FALSE(labels_from_array(file).stated_jaw);
  file.vertex_attributes = {{"FDI", whole({11, 0, 0, 33})}};
  EXPECT_EQ(labels_from_array(file).stated_numbers, LabelNumbers::fdi);
  file.vertex_attributes = {{"Label", whole({11, 0, 0, 33})}};
  EXPECT_FALSE(labels_from_array(file).stated_numbers);
}

TEST(LabelArrays, MoreThanOneIsAskedFor) {
  MeshFile file = tetrahedron_file();
  expect_label_error([&] { labels_from_array(file); }, "it has none");
  file.vertex_attributes["Label"] = whole({1, 2, 3, 4});
  file.vertex_attributes["scalar_curvature"] = {AttributeType::float32, {0.5, 1, 2, 3}};
  file.vertex_attributes["mine"] = whole({4, 3, 2, 1});
  EXPECT_EQ(labels_from_array(file).origin, "the point array Label");
  file.triangle_attributes["Label"] = whole({1, 1, 1, 1});
  expect_label_error([&] { labels_from_array(file); }, "the point array Label, the cell array Label");
  EXPECT_EQ(labels_from_array(file, "CELL:label").origin, "the cell array Label");
  EXPECT_EQ(labels_from_array(file, "point:Label").per_vertex, (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(labels_from_array(file, "MINE").per_vertex, (std::vector<int>{4, 3, 2, 1}));
  expect_label_error([&] { labels_from_array(file, "label"); }, "more than one");
  expect_label_error([&] { labels_from_array(file, "other"); }, "no array 'other': it has the point array Label");
  expect_label_error([&] { labels_from_array(file, "scalar_curvature"); }, "holds other numbers than whole ones");
}

TEST(LabelArrays, CellsVoteForTheirVertices) {
  // a fan of four triangles around vertex 0, of different sizes
  MeshFile file;
  file.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}, {0, -1, 0}, {9, 9, 9}},
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
  file.triangle_attributes["Label"] = whole({5, 5, 7, 6});
  const std::vector<int> labels = labels_from_array(file).per_vertex;
  EXPECT_EQ(labels[0], 5);  // two of four
  EXPECT_EQ(labels[1], 5);  // one each, of the same area: the lower number
  EXPECT_EQ(labels[3], 5);
  EXPECT_EQ(labels[4], 7);  // one each: the larger area
  EXPECT_EQ(labels[5], 0);  // no triangle
  EXPECT_EQ(triangle_labels_from_vertices(file.mesh, {5, 5, 3, 3, 0, 0}), (std::vector<int>{5, 3, 3, 5}));
  EXPECT_EQ(triangle_labels_from_vertices(file.mesh, {5, 6, 0, 33, 33, 0}, 33), (std::vector<int>{0, 0, 33, 5}));
}

TEST(Palettes, AreTextOrJson) {
  const auto expect = [](const std::string& text) {
    const std::vector<PaletteEntry> palette = read_palette(text);
    ASSERT_EQ(palette.size(), 2U) << text;
    EXPECT_EQ(palette[0].colour, (std::array<std::uint8_t, 3>{0, 0x80, 255}));
    EXPECT_EQ(palette[0].number, 36);
    EXPECT_EQ(palette[1].number, 0);
  };
  expect("# teeth\n0080ff 36\r\n\nFF0000\t0\n");
  expect("#0080FF 36\n#ff0000 0\n#a remark\nff0000 0");
  expect(R"({"0080FF": 36, "#FF0000": 0})");
  expect(R"([["FF0000", 0], ["0080ff", 36]])");
  expect_label_error([] { read_palette(""); }, "no entry");
  expect_label_error([] { read_palette("0080FF 36\n0080FF\n"); }, "line 2: 'RRGGBB number' is expected");
  expect_label_error([] { read_palette("0080F 36\n"); }, "line 1");
  expect_label_error([] { read_palette("0080FG 36\n"); }, "line 1");
  expect_label_error([] { read_palette("0080FF 36 37\n"); }, "line 1");
  expect_label_error([] { read_palette("0080FF 36\n0080ff 37\n"); }, "line 2: the colour 0080FF has two numbers");
  expect_label_error([] { read_palette("{\"0080FF\": "); }, "damaged or cut off");
  expect_label_error([] { read_palette("[1, 2]"); }, "entry 1");
  expect_label_error([] { read_palette(R"({"0080FF": "36"})"); }, "entry 1");
}

void colour(std::map<std::string, VertexAttribute>& attributes, const std::vector<int>& shades) {
  for (const char* name : {"red", "green", "blue"})
    attributes[name] = {AttributeType::uint8, {shades.begin(), shades.end()}};
}

TEST(Palettes, BlendedColoursTakeTheirNeighboursNumber) {
  MeshFile file;
  file.mesh = test::sphere(4);
  const auto upper = [&](const Triangle& t) { return file.mesh.vertices[static_cast<std::size_t>(t[0])].z() > 0; };
  std::vector<int> shades;
  for (const Triangle& t : file.mesh.triangles) shades.push_back(upper(t) ? 200 : 100);
  const std::size_t count = shades.size();
  colour(file.triangle_attributes, shades);
  const std::vector<PaletteEntry> palette{{{200, 200, 200}, 11}, {{100, 100, 100}, 0}};
  const RawLabels clean = labels_from_colours(file, palette);
  EXPECT_EQ(clean.origin, "the colours of the triangles");
  for (std::size_t t = 0; t < count; t += 40) shades[t] = 150;
  colour(file.triangle_attributes, shades);
  const RawLabels blended = labels_from_colours(file, palette);
  EXPECT_NE(blended.origin.find("took their neighbours'"), std::string::npos);
  EXPECT_EQ(std::count(blended.per_vertex.begin(), blended.per_vertex.end(), 150), 0);
  std::size_t different = 0;
  for (std::size_t v = 0; v < clean.per_vertex.size(); ++v) different += clean.per_vertex[v] != blended.per_vertex[v];
  EXPECT_LT(different, clean.per_vertex.size() / 50);
  for (std::size_t t = 0; t < count; t += 15) shades[t] = t % 2 == 0 ? 150 : 151;
  colour(file.triangle_attributes, shades);
  expect_label_error([&] { labels_from_colours(file, palette); }, "not in the palette; the commonest are 969696 (");
}

TEST(Palettes, ThoseOfVerticesServeToo) {
  MeshFile file = tetrahedron_file();
  const std::vector<PaletteEntry> palette{{{200, 200, 200}, 11}, {{100, 100, 100}, 0}};
  expect_label_error([&] { labels_from_colours(file, palette); }, "has no colours");
  colour(file.vertex_attributes, {200, 100, 200, 100});
  EXPECT_EQ(labels_from_colours(file, palette).per_vertex, (std::vector<int>{11, 0, 11, 0}));
  colour(file.triangle_attributes, {1, 2, 3, 4});  // a picture, not labels
  EXPECT_EQ(labels_from_colours(file, palette).origin, "the colours of the vertices");
  for (auto& [name, attribute] : file.vertex_attributes) attribute.type = AttributeType::float32;
  for (auto& [name, attribute] : file.vertex_attributes)
    for (double& value : attribute.values) value /= 255;
  EXPECT_EQ(labels_from_colours(file, palette).per_vertex, (std::vector<int>{11, 0, 11, 0}));
}

TEST(WrittenLabels, Teeth3dsHasTheFilesOwnVertices) {
  const std::string json = teeth3ds_json({0, 36, 36, 37, 0}, Jaw::lower, soup());
  EXPECT_EQ(json,
            "{\"id_patient\": \"\", \"jaw\": \"lower\", \"labels\": [0, 36, 36, 37, 36, 0, 37], "
            "\"instances\": [0, 1, 1, 2, 1, 0, 2]}\n");
  EXPECT_EQ(labels_from_teeth3ds(json, soup()).per_vertex, (std::vector<int>{0, 36, 36, 37, 0}));
}

TEST(WrittenLabels, AJawIsStatedOnlyWhereThereIsOne) {
  const std::vector<int> both{16, 36, 0, 0};
  EXPECT_THROW(teeth3ds_json(both, Jaw::lower, tetrahedron_file()), UsageError);
  const std::string json = teeth3ds_json(both, std::nullopt, tetrahedron_file());
  EXPECT_EQ(json.find("jaw"), std::string::npos);
  EXPECT_EQ(labels_from_teeth3ds(json, tetrahedron_file()).per_vertex, both);
  EXPECT_THROW(teeth3ds_json({0, 0, 0, 9}, std::nullopt, tetrahedron_file()), UsageError);
  EXPECT_THROW(teeth3ds_json({0, 0, 0}, std::nullopt, tetrahedron_file()), UsageError);
  EXPECT_NO_THROW(teeth3ds_json({55, 65, 0, 0}, Jaw::upper, tetrahedron_file()));
}

TEST(WrittenLabels, VtkAndVtpComeBack) {
  for (const double size : {1.0, 0.1}) {  // as float, as double
    TriangleMesh mesh = test::tetrahedron();
    for (Point& p : mesh.vertices) p *= size;
    for (const VtkEncoding encoding : {VtkEncoding::ascii, VtkEncoding::binary}) {
      const std::string bytes = vtk_with_point_labels(mesh, {33, 1, 2, 32}, encoding);
      EXPECT_TRUE(bytes.starts_with("# vtk DataFile Version 4.2\n"));
      const MeshFile vtk = read_mesh(bytes, "vtk");
      EXPECT_TRUE(test::same_bits(vtk.mesh, mesh));
      EXPECT_EQ(vtk.vertex_attributes.at("Universal_ID").values, (std::vector<double>{33, 1, 2, 32}));
      EXPECT_TRUE(vtk.notes.empty());
    }
    const MeshFile vtp = read_mesh(vtp_with_cell_labels(mesh, {0, 1, 2, 14}), "vtp");
    EXPECT_TRUE(test::same_bits(vtp.mesh, mesh));
    EXPECT_EQ(vtp.triangle_attributes.at("Label").values, (std::vector<double>{0, 1, 2, 14}));
    EXPECT_TRUE(vtp.notes.empty());
  }
  EXPECT_THROW(vtk_with_point_labels(test::tetrahedron(), {1}), UsageError);
  EXPECT_THROW(vtp_with_cell_labels(test::tetrahedron(), {1}), UsageError);
}

TEST(WrittenLabels, BytesOfVtkAreBigEndian) {
  const std::string bytes = vtk_with_point_labels(test::tetrahedron(), {33, 1, 2, 32});
  EXPECT_NE(bytes.find(std::string("LOOKUP_TABLE default\n") + std::string("\0\0\0\x21\0\0\0\x01", 8)),
            std::string::npos);
  EXPECT_NE(bytes.find("POLYGONS 4 16\n" + std::string("\0\0\0\x03", 4)), std::string::npos);
}

}  // namespace
}  // namespace rhizodont
