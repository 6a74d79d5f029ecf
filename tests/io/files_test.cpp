// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/float_bits.hpp"
#include "io/io_test_tools.hpp"
#include "mesh/test_meshes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::cube, test::TemporaryFolder;

MeshFile cube_file() { return {cube(), {}, {}, true, {}}; }

TEST(Files, UnknownExtensionsAreNotWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"a.off", "a.vtp", "a", "a.plyx"})
    EXPECT_THROW(save_mesh(folder.path() / name, cube_file()), UsageError);
}

TEST(Files, MissingFilesAndFoldersAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(load_mesh(folder.path() / "none.ply"), InputError);
  fs::create_directory(folder.path() / "folder.ply");
  EXPECT_THROW(load_mesh(folder.path() / "folder.ply"), InputError);
  EXPECT_THROW(save_mesh(folder.path() / "folder.ply", cube_file()), OutputError);
  EXPECT_THROW(save_mesh("/proc/no/such/place.ply", cube_file()), OutputError);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Files, WhatCannotBeReadIsAnInputError) {
  const TemporaryFolder folder;
  fs::create_symlink("circle.ply", folder.path() / "circle.ply");
  for (const fs::path& path : {folder.path() / "circle.ply", folder.path() / std::string(300, 'a'),
                               fs::path("/proc/self/mem"), fs::path(std::string(5000, 'b'))})
    EXPECT_THROW(load_mesh(path), InputError) << path;
}

TEST(Files, RoundingToFloatKnowsTheLargestFloat) {
  TriangleMesh mesh = cube();
  mesh.vertices[3].y() = 1e39;
  try {
    round_to_float(mesh);
    FAIL() << "infinity is no coordinate";
  } catch (const InputError& error) {
    EXPECT_EQ(error.elements(), std::vector<std::int64_t>{3});
    EXPECT_EQ(error.kind(), ElementKind::vertices);
  }
}

TEST(Files, InvalidMeshesAreNotWritten) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.ply";
  save_mesh(path, cube_file());
  const std::string before = test::read_all(path);
  std::vector<MeshFile> bad(8, cube_file());
  bad[0].mesh.triangles[3][1] = 8;
  bad[1].mesh.vertices[2].y() = std::numeric_limits<double>::infinity();
  bad[2].mesh.triangles.clear();
  bad[3].vertex_attributes["source"] = {AttributeType::uint8, {1, 2}};
  bad[4].vertex_attributes["source"] = {AttributeType::uint8, std::vector<double>(8, 256)};
  bad[5].vertex_attributes["two words"] = {AttributeType::float32, std::vector<double>(8, 1)};
  bad[6].comments = {"end_header\n"};
  bad[7].vertex_attributes["x"] = {AttributeType::float32, std::vector<double>(8, 1)};
  for (const MeshFile& file : bad) EXPECT_THROW(save_mesh(path, file), InputError);
  EXPECT_EQ(test::read_all(path), before);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Files, WritingReplacesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path path = folder.write("a.ply", "old");
  save_mesh(path, cube_file());
  EXPECT_TRUE(test::same_bits(load_mesh(path).mesh, cube()));
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Files, LinksAreFollowed) {
  const TemporaryFolder folder;
  const fs::path real = folder.write("real.ply", "old"), link = folder.path() / "link.ply";
  fs::create_symlink("real.ply", link);
  save_mesh(link, cube_file());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(test::same_bits(load_mesh(real).mesh, cube()));
}

TEST(Files, DevicesAreWrittenToNotReplaced) {
  const TemporaryFolder folder;
  fs::create_symlink("/dev/null", folder.path() / "a.ply");
  save_mesh(folder.path() / "a.ply", cube_file());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Files, FitFloatIsDecidedExactly) {
  TriangleMesh mesh = cube();
  EXPECT_TRUE(coordinates_fit_float(mesh));
  mesh.vertices[0].x() = static_cast<double>(0.1F);
  EXPECT_TRUE(coordinates_fit_float(mesh));
  mesh.vertices[0].x() = 0.1;
  EXPECT_FALSE(coordinates_fit_float(mesh));
  mesh.vertices[0].x() = 1e300;
  EXPECT_FALSE(coordinates_fit_float(mesh));
}

// Parses a GLB file as the specification says, without a library.
struct Glb {
  nlohmann::json json;
  std::string data;

  explicit Glb(const std::string& bytes) {
    const auto number = [&](std::size_t place) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + place, 4);
      return value;
    };
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number(4), 2U);
    EXPECT_EQ(number(8), bytes.size());
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    const std::size_t length = number(12);
    EXPECT_EQ(length % 4, 0U);
    json = nlohmann::json::parse(bytes.substr(20, length));
    EXPECT_EQ(bytes.substr(24 + length, 4), std::string("BIN\0", 4));
    EXPECT_EQ(number(20 + length) % 4, 0U);
    data = bytes.substr(28 + length);
    EXPECT_EQ(data.size(), number(20 + length));
    EXPECT_EQ(json["buffers"][0]["byteLength"], data.size());
  }

  template <class T>
  std::vector<T> numbers(int accessor_index, std::size_t per_element) const {
    const auto& accessor = json["accessors"][static_cast<std::size_t>(accessor_index)];
    const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::vector<T> values(accessor["count"].get<std::size_t>() * per_element);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), data.size());
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
    EXPECT_LE(values.size() * sizeof(T), view["byteLength"].get<std::size_t>());
    std::memcpy(values.data(), data.data() + view["byteOffset"].get<std::size_t>(), values.size() * sizeof(T));
    return values;
  }
};

TEST(GlbFormat, HoldsFloatsAndIndicesAsTheyAre) {
  const TemporaryFolder folder;
  MeshFile file{test::sphere(1), {}, {}, true, {}};
  for (Point& p : file.mesh.vertices) p = nearest_float(p);
  file.vertex_attributes["source"] = {AttributeType::uint8, std::vector<double>(file.mesh.vertices.size(), 2)};
  save_mesh(folder.path() / "a.glb", file);
  const Glb glb(test::read_all(folder.path() / "a.glb"));
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto positions = glb.numbers<float>(primitive["attributes"]["POSITION"], 3);
  ASSERT_EQ(positions.size(), 3 * file.mesh.vertices.size());
  for (std::size_t k = 0; k < positions.size(); ++k)
    EXPECT_EQ(positions[k], static_cast<float>(file.mesh.vertices[k / 3][static_cast<Eigen::Index>(k % 3)]));
  const auto indices = glb.numbers<std::uint32_t>(primitive["indices"], 1);
  ASSERT_EQ(indices.size(), 3 * file.mesh.triangles.size());
  for (std::size_t k = 0; k < indices.size(); ++k)
    EXPECT_EQ(static_cast<std::int32_t>(indices[k]), file.mesh.triangles[k / 3][k % 3]);
  EXPECT_TRUE(primitive["attributes"].contains("COLOR_0"));
  EXPECT_EQ(glb.json["nodes"][0]["scale"][0], 0.001);
  EXPECT_EQ(glb.json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["max"],
            (std::vector<double>{1, 1, 1}));
}

TEST(GlbFormat, DoubleCoordinatesAreNotSquashedSilently) {
  const TemporaryFolder folder;
  MeshFile file = cube_file();
  file.mesh.vertices[0].z() = 0.1;
  EXPECT_THROW(save_mesh(folder.path() / "a.glb", file), UsageError);
}

// As a program writes it; formats that `save_mesh` does not write as plain text.
std::string bytes_as(const std::string& name, const MeshFile& file) {
  std::string points, polygons, connectivity, offsets;
  for (const Point& p : file.mesh.vertices) points += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : file.mesh.triangles) {
    polygons += fmt::format("3 {} {} {}\n", a, b, c);
    connectivity += fmt::format("{} {} {}\n", a, b, c);
    offsets += fmt::format("{} ", offsets.empty() ? 3 : 3 * (std::count(offsets.begin(), offsets.end(), ' ') + 1));
  }
  const std::size_t v = file.mesh.vertices.size(), t = file.mesh.triangles.size();
  if (name.ends_with(".off")) return fmt::format("OFF\n{} {} 0\n", v, t) + points + polygons;
  if (name.ends_with(".vtk"))
    return fmt::format("# vtk DataFile Version 3.0\nball\nASCII\nDATASET POLYDATA\nPOINTS {} float\n", v) + points +
           fmt::format("POLYGONS {} {}\n", t, 4 * t) + polygons;
  if (name.ends_with(".vtp"))
    return fmt::format(
               "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
               "<PolyData><Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\"><Points><DataArray type=\"Float32\" "
               "NumberOfComponents=\"3\" format=\"ascii\">\n",
               v, t) +
           points + "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n" +
           connectivity + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n" + offsets +
           "</DataArray></Polys></Piece></PolyData></VTKFile>\n";
  const TemporaryFolder folder;
  save_mesh(folder.path() / name, file);
  return test::read_all(folder.path() / name);
}

// Damaged files of every format end in an InputError or a valid mesh, never in anything else.
TEST(Files, RandomDamageIsSurvived) {
  const TemporaryFolder folder;
  MeshFile file{test::sphere(1), {}, {"c"}, true, {}};
  for (Point& p : file.mesh.vertices) p = nearest_float(p);
  file.vertex_attributes["source"] = {AttributeType::uint8, std::vector<double>(file.mesh.vertices.size(), 1)};
  std::uint64_t state = 12345;
  const auto random = [&](std::size_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state >> 33) % below;
  };
  using Reader = MeshFile (*)(std::string_view);
  for (const auto& [name, reader] : {std::pair<const char*, Reader>{"a.ply", read_ply},
                                     {"a.stl", read_stl},
                                     {"a.obj", read_obj},
                                     {"a.off", read_off},
                                     {"a.vtp", read_vtp},
                                     {"a.vtk", read_vtk}}) {
    SCOPED_TRACE(name);
    const std::string whole = bytes_as(name, file);
    ASSERT_EQ(test::parse(reader, whole).mesh.triangles.size(), file.mesh.triangles.size()) << "undamaged";
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = whole;
      for (std::size_t k = 0; k <= random(4); ++k) damaged[random(damaged.size())] = static_cast<char>(random(256));
      if (trial % 3 == 0) damaged.resize(random(damaged.size()));
      try {
        const MeshFile found = test::parse(reader, damaged);
        for (const Triangle& t : found.mesh.triangles)
          for (const std::int32_t v : t) ASSERT_LT(static_cast<std::size_t>(v), found.mesh.vertices.size());
        for (const Point& p : found.mesh.vertices) ASSERT_TRUE(p.allFinite());
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()), "");
      }
    }
  }
}

}  // namespace
}  // namespace rhizodont
