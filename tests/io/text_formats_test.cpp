// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "io/io_test_tools.hpp"
#include "mesh/test_meshes.hpp"

#include <random>

namespace rhizodont {
namespace {

using test::cube, test::expect_refused, test::load_bytes;

const std::vector<Point> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}};

TEST(Obj, ReadsEveryKindOfFace) {
  const std::string vertices =
      "# square\r\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\n\tv  0\t1 0\nvt 0 0\nvn 0 0 1\ns off\n";
  for (const char* face : {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/1/1 4/1/1",
                           "f -4 -3 -2 -1", "f 1 2 \\\n 3 4", "f 1 2 3 4 # comment", "f 1 2 3\nf 1 3 4"}) {
    const MeshFile file = load_bytes("a.obj", vertices + face + "\n");
    EXPECT_EQ(file.mesh.vertices, square) << face;
    EXPECT_EQ(file.mesh.triangles, fan) << face;
  }
}

TEST(Off, FacesBeyondTheAnnouncedAreRead) {
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const MeshFile file = load_bytes("a.off", "OFF\n4 1 0\n" + vertices + "3 0 1 2\n3 0 2 3\n");
  EXPECT_EQ(file.mesh.triangles, fan);
  EXPECT_TRUE(test::notes_hold(file, "announces 1 faces and holds 2: all were read"));
  const MeshFile odd = load_bytes("a.off", "OFF\n4 2 0\n" + vertices + "3 0 1 2\n3 0 2 3\nthe end\n");
  EXPECT_EQ(odd.mesh.triangles, fan);
  EXPECT_TRUE(test::notes_hold(odd, "from line 9 on, is no face and was passed over"));
  EXPECT_TRUE(load_bytes("a.off", "OFF\n4 2 0\n" + vertices + "3 0 1 2\n3 0 2 3\n# end\n\n").notes.empty());
}

TEST(Off, OfAnyDimensionThreeIsRead) {
  const std::string rest = "4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
  for (const char* header : {"nOFF\n3\n", "nOFF 3\n", "nOFF 3 ", "nOFF\n# dimension\n3 # three\n"})
    EXPECT_EQ(load_bytes("a.off", header + rest).mesh.triangles, fan) << header;
  expect_refused("a.off", "nOFF\n4\n" + rest, "only three-dimensional");
  expect_refused("a.off", "4nOFF\n3\n" + rest, "only three-dimensional");
}

TEST(Obj, NumbersAreDoubles) {
  const MeshFile file = load_bytes("a.obj", "v 0.1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3");
  EXPECT_EQ(file.mesh.vertices[0].x(), 0.1);
  EXPECT_FALSE(file.coordinates_fit_float);
}

TEST(Obj, BadFilesAreRefusedWithTheirLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused("a.obj", "", "empty");
  expect_refused("a.obj", vertices, "no triangles");
  expect_refused("a.obj", "\x01\x02\x03", "no mesh in a format that is read");
  expect_refused("a.obj", vertices + "f 1 2 4\n", "line 4: vertex 4 does not exist, there are 3");
  expect_refused("a.obj", vertices + "f 1 2 99999999999\n", "line 4: vertex 99999999999 does not exist");
  expect_refused("a.obj", vertices + "f 0 1 2\n", "line 4: vertex 0 does not exist");
  expect_refused("a.obj", vertices + "f 1 2 -4\n", "line 4: vertex -4 does not exist");
  expect_refused("a.obj", vertices + "f 1 2\n", "line 4: a face needs three vertices");
  expect_refused("a.obj", vertices + "f 1 b 3\n", "line 4: 'b'");
  expect_refused("a.obj", "v 0 0\n" + vertices + "f 1 2 3\n", "line 1: a vertex needs three coordinates");
  expect_refused("a.obj", vertices + "v 0 nan 0\nf 1 2 3\n", "line 4: a coordinate is not a finite number");
  expect_refused("a.obj", vertices + "v 0 1e999 0\nf 1 2 3\n", "line 4: a coordinate is not a finite number");
  expect_refused("a.obj", vertices + "v 0 0,5 0\nf 1 2 3\n", "line 4: '0,5' is not a number: it has a decimal comma");
}

TEST(Obj, RoundTripKeepsDoublesAndFloatsToTheBit) {
  const test::TemporaryFolder folder;
  std::mt19937_64 engine(7);
  MeshFile file{test::sphere(2), {}, {"a comment"}, true, {}};
  for (std::size_t v = 0; v < file.mesh.vertices.size(); ++v)
    for (double& x : file.mesh.vertices[v]) {
      x *= std::ldexp(1.0 + static_cast<double>(engine() >> 12) * 0x1p-52, static_cast<int>(engine() % 40) - 20);
      if (v % 2 == 0) x = nearest_float(x);
    }
  save_mesh(folder.path() / "a.obj", file);
  EXPECT_TRUE(test::same_bits(load_mesh(folder.path() / "a.obj").mesh, file.mesh));
}

TEST(Obj, LinesPointsAndCurvesArePassedOver) {
  const MeshFile file = load_bytes(
      "a.obj", "g all\nvp 0.5\nv 0 0 0\nv 1 0 0\nl 1 2\np 1\nv 1 1 0\nv 0 1 0\nusemtl tooth\nf 1// 2// 3// 4//\n");
  EXPECT_EQ(file.mesh.vertices, square);
  EXPECT_EQ(file.mesh.triangles, fan);
}

TEST(Obj, ColoursOfEveryVertexAreRead) {
  const MeshFile unit =
      load_bytes("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 1 1 0 0 0 1 1\nv 0 1 0 0 0 0.2\nf 1 2 3 4\n");
  EXPECT_EQ(unit.vertex_attributes.at("red").values, (std::vector<double>{255, 0, 0, 0}));
  EXPECT_EQ(unit.vertex_attributes.at("green").values, (std::vector<double>{0, 128, 0, 0}));
  EXPECT_EQ(unit.vertex_attributes.at("blue").values, (std::vector<double>{0, 0, 255, 51}));
  EXPECT_EQ(unit.vertex_attributes.at("red").type, AttributeType::uint8);
  const MeshFile bytes =
      load_bytes("a.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 128 0\nv 1 1 0 0 0 300\nv 0 1 0 1 -1 51\nf 1 2 3 4\n");
  EXPECT_EQ(bytes.vertex_attributes.at("blue").values, (std::vector<double>{0, 0, 255, 51}));
  EXPECT_EQ(bytes.vertex_attributes.at("red").values, (std::vector<double>{255, 0, 0, 1}));
  EXPECT_EQ(bytes.vertex_attributes.at("green").values, (std::vector<double>{0, 128, 0, 0}));
  const MeshFile some = load_bytes("a.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0 1\nf 1 2 3\n");
  EXPECT_TRUE(some.vertex_attributes.empty());
  EXPECT_TRUE(test::notes_hold(some, "Not every vertex has a colour"));
}

TEST(Obj, TexturesAreSaid) {
  const std::string square_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
  EXPECT_TRUE(test::notes_hold(load_bytes("a.obj", "mtllib a.mtl\n" + square_text), "texture is not read"));
  EXPECT_TRUE(load_bytes("a.obj", square_text).notes.empty());
}

TEST(Off, ColoursOfVerticesAreRead) {
  const MeshFile file = load_bytes("a.off", "COFF\n3 1 0\n0 0 0 255 1 2 255\n1 0 0 3 4 5 255\n0 1 0 6 7 8\n3 0 1 2\n");
  EXPECT_EQ(file.vertex_attributes.at("red").values, (std::vector<double>{255, 3, 6}));
  EXPECT_EQ(file.vertex_attributes.at("blue").values, (std::vector<double>{2, 5, 8}));
}

TEST(Off, CountsMayHangOnTheHeaderOrStandAlone) {
  const std::string body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  for (const std::string head : {"OFF4 1 0\n", "off\n4 1 0\n", "4 1 0\n", "4 1\n", "# made by hand\n4 1 0\n"})
    for (const char* name : {"a.off", "a.txt", "a"}) {
      const MeshFile file = load_bytes(name, head + body);
      EXPECT_EQ(file.mesh.vertices, square) << head << name;
      EXPECT_EQ(file.mesh.triangles, fan) << head << name;
    }
  // numbers that do not fit their counts are no OFF file
  expect_refused("a.txt", "5 1 0\n" + body, "numbers only");
  expect_refused("a.xyz", "0 0 0\n1 0 0\n1 1 0\n", "numbers only");
  expect_refused("a.off", "5 1 0\n" + body, "damaged or cut off");
}

TEST(Off, ReadsItsRelatives) {
  const std::string faces = "4 0 1 2 3  255 0 0\n";
  const std::string plain = "0 0 0\n1 0 0\n\n# comment\n1 1 0\n0 1 0\n";
  const std::string coloured = "0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0 .5 .5 .5 1 # red\n0 1 0 0 0 0 0\n";
  for (const std::string& text :
       {"OFF\n4 1 0\n" + plain + faces, "OFF 4 1 0\n" + plain + faces, "# first\nOFF # second\n\n4 1\n" + plain + faces,
        "COFF\r\n4 1 0\r\n" + coloured + faces, "NOFF\n4 1 0\n" + coloured + faces, "STOFF\n4 1 4\n" + plain + faces}) {
    const MeshFile file = load_bytes("a.off", text);
    EXPECT_EQ(file.mesh.vertices, square) << text;
    EXPECT_EQ(file.mesh.triangles, fan) << text;
  }
}

TEST(Off, BadFilesAreRefusedWithTheirLine) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused("a.off", "", "empty");
  expect_refused("a.off", "hello\n", "does not begin with 'OFF'");
  expect_refused("a.off", "4OFF\n3 1 0\n" + vertices + "3 0 1 2\n", "three-dimensional");
  expect_refused("a.off", "OFF BINARY\n", "binary OFF");
  expect_refused("a.off", "OFF\n", "ends within its header");
  expect_refused("a.off", "OFF\n3\n" + vertices, "line 2: the number of faces is missing");
  expect_refused("a.off", "OFF\n-3 1 0\n" + vertices, "line 2");
  expect_refused("a.off", "OFF\n3000000000000 1 0\n" + vertices + "3 0 1 2\n", "announces 3000000000000 vertices");
  expect_refused("a.off", "OFF\n3 3000000000000 0\n" + vertices + "3 0 1 2\n", "announces 3000000000000 faces");
  expect_refused("a.off", "OFF\n4 0 0\n" + vertices + "         ", "ends before vertex 3 of 4");
  expect_refused("a.off", "OFF\n3 2 0\n" + vertices + "3 0 1 2\n", "ends before face 1 of 2");
  expect_refused("a.off", "OFF\n3 0 0\n" + vertices, "no triangles");
  expect_refused("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 3\n", "line 6: vertex 3 does not exist");
  expect_refused("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 -1\n", "line 6: vertex -1 does not exist");
  expect_refused("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1\n", "line 6: a face has fewer vertices");
  expect_refused("a.off", "OFF\n3 1 0\n0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n",
                 "line 3: a coordinate is not a finite number");
  expect_refused("a.off", "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "line 3: a vertex needs three coordinates");
}

}  // namespace
}  // namespace rhizodont
