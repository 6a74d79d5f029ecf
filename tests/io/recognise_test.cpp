// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/recognise.hpp"

#include "io/io_test_tools.hpp"

#include <cctype>

namespace rhizodont {
namespace {

using test::expect_refused;
using namespace std::string_literals;

std::string padded(std::string start, std::size_t size = 2000) {
  std::uint32_t state = 1;
  while (start.size() < size) {
    state = state * 1664525U + 1013904223U;
    start.push_back(static_cast<char>(state >> 24));
  }
  return start;
}

TEST(Recognise, OtherThingsAreCalledByTheirName) {
  std::string dicom(128, '\0'), tar(257, 'n');
  const std::vector<std::pair<std::string, const char*>> things{
      {padded("\x89PNG\r\n\x1a\n"s), "a PNG picture, not a mesh"},
      {padded("\xff\xd8\xff\xe0"s), "a JPEG picture, not a mesh"},
      {padded("GIF89a"s), "a GIF picture"},
      {padded("II*\0"s), "a TIFF picture"},
      {"%PDF-1.7\n1 0 obj\n", "a PDF document"},
      {padded(dicom + "DICM"), "a DICOM file"},
      {padded("glTF\2\0\0\0"s), "a glTF scene (GLB), which is not read: save it as STL, PLY or OBJ"},
      {"{\"asset\": {\"version\": \"2.0\"}}", "a glTF scene"},
      {"{\"labels\": [0, 0, 34]}", "a JSON file, not a mesh"},
      {"ISO-10303-21;\nHEADER;\n", "a STEP model"},
      {padded("PK\3\4"s), "a ZIP archive: unpack it"},
      {padded("PK\3\4"s + std::string(26, 'x') + "3D/3dmodel.model"), "a 3MF model"},
      {padded("PK\3\4"s + std::string(26, 'x') + "word/document.xml"), "an Office document"},
      {padded(tar + "ustar"), "a TAR archive"},
      {padded("7z\xbc\xaf\x27\x1c"s), "a 7z archive"},
      {padded("BZh9"s), "bzip2"},
      {padded("\xfd"
              "7zXZ\0"s),
       "xz"},
      {padded("\xd0\xcf\x11\xe0"s), "an Office document"},
      {padded("Kaydara FBX Binary  \0"s), "an FBX scene"},
      {"#VRML V2.0 utf8\nShape {}\n", "a VRML scene"},
      {"0\nSECTION\n2\nENTITIES\n", "a DXF drawing"},
      {"<!DOCTYPE html>\n<html><head></head></html>", "a web page (HTML), not a mesh"},
      {"\n <HTML><body>404 not found</body></HTML>", "a web page (HTML)"},
      {"<head><title>Sign in</title></head>", "a web page (HTML)"},
      {"<?xml version=\"1.0\"?>\n<!-- scan -->\n<HPS version=\"1.1\"></HPS>", "a 3Shape scan (DCM)"},
      {"<?xml version=\"1.0\"?><svg:svg xmlns:svg=\"x\"/>", "an SVG picture"},
      {"<COLLADA/>", "a COLLADA scene"},
      {"<gpx></gpx>", "an XML file"},
      {"# made by a program\nnewmtl enamel\nKd 1 1 1\n", "a list of materials (MTL)"},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:00\n", "a pointer of Git LFS"},
      {"1 2 3\n4 5 6\n7 8 9\n1 1 1\n", "numbers only"},
      {std::string(5000, '\0'), "nothing but zeros"},
      {" \n\r\n\t\n", "nothing but blanks"},
      {"\xff\xfe\0\0v\0\0\0"s, "UTF-32"},
      {"Dear Sir or Madam,\nyour order\n", "no mesh in a format that is read"},
  };
  for (const auto& [bytes, words] : things) {
    expect_refused("a.xyz", bytes, words);
    // whatever it is called; readers asked by name have sentences of their own for what has no name
    if (std::string_view(words).starts_with("a")) {
      for (const char* name : {"a.stl", "a.ply", "a.obj", "a.off", "a.vtp", "a.vtk", "a"}) {
        if (name == "a.vtp"s && std::string_view(words) == "an XML file") continue;
        expect_refused(name, bytes, words);
      }
    }
  }
}

TEST(Recognise, NoSentenceHoldsANonsenseNumber) {
  const std::vector<std::string> things{padded("\x01\x02\x03\x04"),
                                        padded("hello, this is a letter. "),
                                        padded("<a"),
                                        padded("ply"),
                                        padded("solid"),
                                        padded("OFF "),
                                        std::string(100, 'x'),
                                        padded("\xca\xfe\xba\xbe", 80000),
                                        "Lorem ipsum dolor sit amet\n"};
  for (const std::string& bytes : things)
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.off", "a.vtp", "a.vtk", "a.bin"}) {
      try {
        read_mesh(bytes, name);
        FAIL() << "read: " << bytes.substr(0, 20) << " as " << name;
      } catch (const InputError& error) {
        std::size_t digits = 0, most = 0;
        for (const char c : std::string(error.what())) {
          digits = std::isdigit(static_cast<unsigned char>(c)) != 0 ? digits + 1 : 0;
          most = std::max(most, digits);
        }
        EXPECT_LE(most, 4U) << error.what();
        for (const char c : std::string(error.what())) EXPECT_TRUE(c >= ' ' && c < 127) << error.what();
      }
    }
}

TEST(Recognise, TheEndingIsAHintOnly) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* name : {"a.stl", "a.ply", "a.off", "a.vtp", "a.vtk", "a.png", "a", "", "obj", ".obj", "a.OBJ.gz"})
    EXPECT_EQ(read_mesh(obj, name).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}})) << name;
  // what the content leaves open, the ending says
  expect_refused("a.obj", "f 1 2 3\n", "vertex 3 does not exist");
  expect_refused("a.txt", "f 1 2 3\n", "no mesh in a format that is read");
  EXPECT_EQ(recognise(obj, ".stl"), MeshFormat::obj);
}

}  // namespace
}  // namespace rhizodont
