// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// One mesh in every dress that programs give it: each is the same mesh.
#include "base/float_bits.hpp"
#include "io/io_test_tools.hpp"
#include "mesh/test_meshes.hpp"

#include <Eigen/Geometry>

#include <fmt/format.h>
#include <zlib.h>

#include <string>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

using test::Bytes, test::expect_refused, test::load_bytes;

/// An open dome whose vertices are floats and numbered by first appearance, as STL numbers them.
TriangleMesh worn_mesh() {
  const TriangleMesh dome = test::dome(2);
  TriangleMesh mesh;
  std::vector<std::int32_t> number(dome.vertices.size(), -1);
  for (Triangle t : dome.triangles) {
    for (std::int32_t& v : t) {
      std::int32_t& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<std::int32_t>(mesh.vertices.size());
        mesh.vertices.push_back(nearest_float(dome.vertices[static_cast<std::size_t>(v)]));
      }
      v = n;
    }
    mesh.triangles.push_back(t);
  }
  return mesh;
}

std::string row(const Point& p) { return fmt::format("{} {} {}", p.x(), p.y(), p.z()); }

std::string as_stl_text(const TriangleMesh& mesh) {
  std::string text = "solid crown of tooth 34\n";
  for (const Triangle& t : mesh.triangles) {
    text += "  facet normal 0 0 1\n    outer loop\n";
    for (const std::int32_t v : t) text += "      vertex " + row(mesh.vertices[static_cast<std::size_t>(v)]) + "\n";
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid crown of tooth 34\n";
}

std::string rows(const TriangleMesh& mesh, const std::string& before_vertex, const std::string& before_triangle,
                 int first = 0) {
  std::string text;
  for (const Point& p : mesh.vertices) text += before_vertex + row(p) + "\n";
  for (const auto& [a, b, c] : mesh.triangles)
    text += fmt::format("{}{} {} {}\n", before_triangle, a + first, b + first, c + first);
  return text;
}

std::string as_off(const TriangleMesh& mesh) {
  return fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size()) + rows(mesh, "", "3 ");
}

std::string as_obj(const TriangleMesh& mesh) { return rows(mesh, "v ", "f ", 1); }

std::string as_ply_text(const TriangleMesh& mesh) {
  return fmt::format(
             "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
             "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
             mesh.vertices.size(), mesh.triangles.size()) +
         rows(mesh, "", "3 ");
}

std::string as_vtk_text(const TriangleMesh& mesh) {
  std::string text = fmt::format("# vtk DataFile Version 4.2\ncrown\nASCII\nDATASET POLYDATA\nPOINTS {} float\n",
                                 mesh.vertices.size());
  for (const Point& p : mesh.vertices) text += row(p) + "\n";
  text += fmt::format("POLYGONS {} {}\n", mesh.triangles.size(), 4 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) text += fmt::format("3 {} {} {}\n", a, b, c);
  return text;
}

std::string as_vtp_text(const TriangleMesh& mesh) {
  std::string points, corners, offsets;
  for (const Point& p : mesh.vertices) points += row(p) + "\n";
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    corners += fmt::format("{} {} {}\n", mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]);
    offsets += fmt::format("{}\n", 3 * t + 3);
  }
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\">\n<Points>\n"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\">\n{}</DataArray>\n</Points>\n<Polys>\n<DataArray "
      "type=\"Int32\" Name=\"connectivity\">\n{}</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\">\n"
      "{}</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n",
      mesh.vertices.size(), points, corners, offsets);
}

std::string as_binary_stl(const TriangleMesh& mesh, const std::string& title = "crown") {
  std::string header = title;
  header.resize(80, ' ');
  Bytes bytes(header);
  bytes.add(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) bytes.add(0.0F);
    for (const std::int32_t v : t)
      for (const double x : mesh.vertices[static_cast<std::size_t>(v)]) bytes.add(static_cast<float>(x));
    bytes.add(std::uint16_t{0});
  }
  return bytes.str();
}

std::string as_binary_vtk(const TriangleMesh& mesh) {
  Bytes bytes(fmt::format("# vtk DataFile Version 5.1\ncrown\nBINARY\nDATASET POLYDATA\nPOINTS {} float\n",
                          mesh.vertices.size()),
              std::endian::big);
  for (const Point& p : mesh.vertices)
    for (const double x : p) bytes.add(static_cast<float>(x));
  bytes.add_text(
      fmt::format("\nPOLYGONS {} {}\nOFFSETS vtktypeint64\n", mesh.triangles.size() + 1, 3 * mesh.triangles.size()));
  for (std::size_t t = 0; t <= mesh.triangles.size(); ++t) bytes.add(static_cast<std::int64_t>(3 * t));
  bytes.add_text("\nCONNECTIVITY vtktypeint64\n");
  for (const Triangle& t : mesh.triangles)
    for (const std::int32_t v : t) bytes.add(static_cast<std::int64_t>(v));
  return bytes.add_text("\n").str();
}

std::string with(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t place = 0; (place = text.find(what, place)) != std::string::npos; place += by.size())
    text.replace(place, what.size(), by);
  return text;
}

std::string in_utf16(const std::string& text, std::endian order, bool mark) {
  Bytes bytes({}, order);
  if (mark) bytes.add(std::uint16_t{0xfeff});
  for (const char c : text) bytes.add(static_cast<std::uint16_t>(static_cast<unsigned char>(c)));
  return bytes.str();
}

std::string in_gzip(const std::string& content) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, content.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

void expect_worn(const std::string& bytes, const std::string& what) {
  static const TriangleMesh mesh = worn_mesh();
  // the content alone decides
  for (const char* name : {"crown", "crown.stl", "crown.ply", "crown.vtp", "crown.xyz"}) {
    SCOPED_TRACE(what + " as " + name);
    try {
      const MeshFile file = read_mesh(bytes, name);
      EXPECT_TRUE(test::same_bits(file.mesh, mesh));
      EXPECT_TRUE(file.file_vertices.empty());
    } catch (const Error& error) {
      FAIL() << error.what();
    }
  }
}

TEST(Dress, EveryFormatInEveryEncodingIsTheSameMesh) {
  const TriangleMesh mesh = worn_mesh();
  for (const auto& [format, text] : std::vector<std::pair<std::string, std::string>>{{"STL", as_stl_text(mesh)},
                                                                                     {"OFF", as_off(mesh)},
                                                                                     {"OBJ", as_obj(mesh)},
                                                                                     {"PLY", as_ply_text(mesh)},
                                                                                     {"VTK", as_vtk_text(mesh)},
                                                                                     {"VTP", as_vtp_text(mesh)}}) {
    expect_worn(text, format);
    expect_worn("\xef\xbb\xbf" + text, format + " with a byte order mark");
    expect_worn(with(text, "\n", "\r\n"), format + " with CR LF");
    expect_worn(with(text, "\n", "\r"), format + " with CR");
    expect_worn(text.substr(0, text.size() - 1), format + " without the last line's end");
    for (const std::endian order : {std::endian::little, std::endian::big})
      for (const bool mark : {true, false}) expect_worn(in_utf16(text, order, mark), format + " in UTF-16");
    expect_worn(in_gzip(text), format + " packed");
    expect_worn(in_gzip(in_gzip(in_utf16(with(text, "\n", "\r\n"), std::endian::little, true))),
                format + " packed twice");
    const std::size_t half = text.size() / 2;
    expect_worn(in_gzip(text.substr(0, half)) + in_gzip(text.substr(half)), format + " packed in two members");
  }
  for (const std::string& bytes : {as_binary_stl(mesh), as_binary_stl(mesh, "solid crown"), as_binary_vtk(mesh)}) {
    expect_worn(bytes, "binary");
    expect_worn(in_gzip(bytes), "binary, packed");
  }
  EXPECT_TRUE(test::notes_hold(read_mesh(in_gzip(as_off(mesh)), ""), "gzip"));
  EXPECT_TRUE(test::notes_hold(read_mesh(in_utf16(as_off(mesh), std::endian::big, true), ""), "UTF-16"));
}

TEST(Dress, StlTextAsProgramsWriteIt) {
  const std::string text = as_stl_text(worn_mesh());
  const std::string head = "solid crown of tooth 34\n", tail = "endsolid crown of tooth 34\n";
  const std::string body = text.substr(head.size(), text.size() - head.size() - tail.size());
  std::string upper = body;
  for (char& c : upper) c = c >= 'a' && c <= 'z' && c != 'e' ? static_cast<char>(c - ('a' - 'A')) : c;
  std::string one_line = with(text, "\n", " ");
  const std::size_t middle = body.find("  facet", body.size() / 2);
  for (const auto& [what, dressed] : std::vector<std::pair<const char*, std::string>>{
           {"no solid", body},
           {"no solid, but an end", body + tail},
           {"no name", "solid\n" + body + "endsolid\n"},
           {"upper case", "SOLID X\n" + upper + "ENDSOLID X\n"},
           {"comments", "# one\n// two\n; three\n" + with(text, "    outer", "# before\n  ; it\n    outer")},
           {"comments behind", with(text, "endloop\n", "endloop // done\n")},
           {"colours",
            "solid x\ncolor 0.5 0.5 0.5\n" + with(body, "  facet normal", "color 1 0 0\n  facet normal") + tail},
           {"no normals", with(text, "facet normal 0 0 1", "facet")},
           {"normals that are none", with(text, "normal 0 0 1", "normal -nan(ind) 1.#QNAN nan")},
           {"two words",
            with(with(with(text, "endloop", "end loop"), "endfacet", "end facet"), "endsolid", "end solid")},
           {"anything after the end", text + "exported by a program\n\x01 facets: 12\n\x1a"},
           {"zeros after the end", text + std::string(3000, '\0')},
           {"several solids", head + body.substr(0, middle) + tail + "\nsolid second\n" + body.substr(middle) + tail},
           {"a name of keywords", "solid facet normal\n" + body + "endsolid facet normal\n"},
           {"one line", one_line},
           {"blank lines", "\n\n  \n" + with(text, "\n", "\n\n")},
           {"tabs", with(text, " ", "\t")},
           {"a name in no encoding", with(text, "tooth", "\xe4\xf6\xfc\xff")}})
    expect_worn(dressed, what);
  EXPECT_TRUE(test::notes_hold(read_mesh(text + "junk", ""), "after the end"));
  EXPECT_TRUE(test::notes_hold(read_mesh(head + body, ""), "does not end with 'endsolid'"));
  EXPECT_FALSE(test::notes_hold(read_mesh(text, ""), "."));
  expect_refused("a.stl", body.substr(0, body.size() - 20), "ends in the middle of a triangle");
  expect_refused("a.stl", with(text, "outer", "inner"), "'outer' is expected, 'inner' was found");
}

TEST(Dress, BinaryStlOfAnotherSizeThanAnnounced) {
  const TriangleMesh mesh = worn_mesh();
  const std::string good = as_binary_stl(mesh);
  const auto announcing = [&](std::uint32_t count) {
    std::string bytes = good;
    return bytes.replace(80, 4, Bytes().add(count).str());
  };
  const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const std::string& more :
       {std::string("\n"), std::string("\r\n"), std::string(49, '\0'), std::string(77, 'x')}) {
    expect_worn(good + more, "more bytes");
    EXPECT_TRUE(test::notes_hold(read_mesh(good + more, "a.stl"), "after the last triangle announced: passed over"));
  }
  for (const std::uint32_t count : {0U, 1U, n - 1, 0xffffffffU, 3 * n, n << 24}) {
    expect_worn(announcing(count), "count " + std::to_string(count));
    EXPECT_TRUE(test::notes_hold(read_mesh(announcing(count), "a.stl"), "count of triangles is wrong"));
  }
  // what is announced but not there may be missing
  expect_refused("a.stl", announcing(n + 1), fmt::format("announces {} triangles and has room for {}", n + 1, n));
  expect_refused("a.stl", good.substr(0, good.size() - 50), fmt::format("announces {} triangles and has room for", n));
  expect_refused("a.stl", good.substr(0, good.size() - 1), fmt::format("announces {} triangles and has room for", n));
  expect_refused("a.stl", announcing(0).substr(0, good.size() - 1), "no triangles, or it is damaged or cut off");
}

TEST(Dress, EverySplitVertexIsWeldedAndKnownByItsNumber) {
  const TriangleMesh mesh = worn_mesh();
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    for (const std::int32_t v : t) soup.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
    const auto end = static_cast<std::int32_t>(soup.vertices.size());
    soup.triangles.push_back({end - 3, end - 2, end - 1});
  }
  for (const std::string& text :
       {as_off(soup), as_obj(soup), as_ply_text(soup), as_vtk_text(soup), as_vtp_text(soup)}) {
    const MeshFile file = read_mesh(text, "");
    EXPECT_TRUE(test::same_bits(file.mesh, mesh));
    ASSERT_EQ(file.file_vertices.size(), mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      EXPECT_EQ(soup.vertices[static_cast<std::size_t>(file.file_vertices[v])], mesh.vertices[v]);
    EXPECT_TRUE(test::notes_hold(file, "merged"));
  }
}

TEST(Dress, ConcavePolygonsAreTheSameInEveryFormat) {
  // an L with its inner corner in the middle; corner 0 does not see all of it
  const std::vector<Point> points{{0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0.1}};
  const auto begun_at = [&](int start, const char* between, int first) {
    std::string text;
    for (int k = 0; k < 6; ++k) text += fmt::format("{}{}", k == 0 ? "" : between, (start + k) % 6 + first);
    return text;
  };
  std::string vertices, obj_vertices;
  for (const Point& p : points) {
    vertices += row(p) + "\n";
    obj_vertices += "v " + row(p) + "\n";
  }
  const std::string face = begun_at(2, " ", 0);
  const MeshFile off = read_mesh("OFF\n6 1 0\n" + vertices + "6 " + face, "");
  EXPECT_EQ(off.mesh.triangles.size(), 4U);
  EXPECT_TRUE(test::notes_hold(off, "1 concave polygon was cut"));
  double area = 0;
  for (const auto& [a, b, c] : off.mesh.triangles) {
    const auto at = [&](int v) { return off.mesh.vertices[static_cast<std::size_t>(v)]; };
    const double z = (at(b) - at(a)).cross(at(c) - at(a)).z() / 2;
    EXPECT_GT(z, 0);
    area += z;
  }
  EXPECT_DOUBLE_EQ(area, 3);
  // faces may stand before their vertices in OBJ
  for (const std::string& text :
       {"f " + begun_at(2, " ", 1) + "\n" + obj_vertices, obj_vertices + "f " + begun_at(2, " ", 1),
        "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 6\nproperty float "
        "x\nproperty float y\nproperty double z\nend_header\n6 " +
            face + "\n" + vertices,
        "# vtk DataFile Version 2.0\nL\nASCII\nDATASET POLYDATA\nPOINTS 6 double\n" + vertices + "POLYGONS 1 7\n6 " +
            face,
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"6\"><Points><DataArray type=\"Float64\" "
        "NumberOfComponents=\"3\">" +
            vertices + "</DataArray></Points><Polys><DataArray type=\"Int8\" Name=\"connectivity\">" + face +
            "</DataArray><DataArray type=\"Int8\" Name=\"offsets\">6</DataArray></Polys></Piece></PolyData></VTKFile>"})
    EXPECT_EQ(read_mesh(text, "").mesh.triangles, off.mesh.triangles) << text;
}

// Damaged files end in an InputError or a valid mesh, never in anything else, and their sentences can be printed.
TEST(Dress, RandomDamageIsSurvived) {
  const TriangleMesh mesh = worn_mesh();
  std::uint64_t state = 2026;
  const auto random = [&](std::size_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state >> 33) % below;
  };
  for (const std::string& whole : {as_stl_text(mesh), as_off(mesh), as_obj(mesh), as_ply_text(mesh), as_vtk_text(mesh),
                                   as_vtp_text(mesh), as_binary_vtk(mesh), as_binary_stl(mesh), in_gzip(as_obj(mesh)),
                                   in_utf16(as_off(mesh), std::endian::big, true)})
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = whole;
      // half of the damage is in the head
      for (std::size_t k = 0; k <= random(4); ++k)
        damaged[random(k % 2 == 0 ? damaged.size() : 300)] = static_cast<char>(random(256));
      if (trial % 3 == 0) damaged.resize(1 + random(damaged.size()));
      try {
        const MeshFile found = read_mesh(damaged, trial % 2 == 0 ? "a.stl" : "a.vtk");
        for (const Triangle& t : found.mesh.triangles)
          for (const std::int32_t v : t) ASSERT_LT(static_cast<std::size_t>(v), found.mesh.vertices.size());
        for (const Point& p : found.mesh.vertices) ASSERT_TRUE(p.allFinite());
      } catch (const InputError& error) {
        for (const char c : std::string(error.what())) ASSERT_TRUE(c >= ' ' && c < 127) << error.what();
      }
    }
}

TEST(Dress, PackedFilesThatAreNoneAreRefused) {
  const std::string packed = in_gzip(as_off(worn_mesh()));
  for (const std::size_t size :
       {std::size_t{3}, std::size_t{11}, packed.size() / 2, packed.size() - 9, packed.size() - 1})
    expect_refused("a.off.gz", packed.substr(0, size), "is cut off");
  std::string damaged = packed;
  damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x55);
  EXPECT_THROW(read_mesh(damaged, "a.off"), InputError);
  // zeros pack a thousandfold: it is not the memory that ends this
  expect_refused("a.stl.gz", in_gzip(std::string(std::size_t{100} << 20, '\0')), "far more than a mesh");
  expect_refused("a.stl.gz", in_gzip(in_gzip(in_gzip("x"))), "several times over");
  expect_refused("a.stl.gz", in_gzip(""), "empty");
}

}  // namespace
}  // namespace rhizodont
