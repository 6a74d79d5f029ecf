// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Readers of meshes: what they take is a mesh as `MeshFile` describes it, and is read again from what is written of it.
#include "fuzz/targets.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace rhizodont::test {
namespace {

void require_attributes(const std::map<std::string, VertexAttribute>& attributes, std::size_t count) {
  for (const auto& [name, attribute] : attributes)
    require_rule(attribute.values.size() == count, "an attribute of another length");
}

void require_promises(const MeshFile& file) {
  const TriangleMesh& mesh = file.mesh;
  const auto vertices = static_cast<std::int64_t>(mesh.vertices.size());
  require_rule(!mesh.triangles.empty(), "no triangle");
  for (const Point& p : mesh.vertices) require_rule(p.allFinite(), "a coordinate that is no number");
  for (const Triangle& t : mesh.triangles) {
    require_rule(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "a corner twice");
    for (const std::int32_t v : t) require_rule(v >= 0 && v < vertices, "a corner that is no vertex");
  }
  require_attributes(file.vertex_attributes, mesh.vertices.size());
  require_attributes(file.triangle_attributes, mesh.triangles.size());
  require_rule(file.file_vertices.empty() || file.file_vertices.size() == mesh.vertices.size(),
               "numbers in the file of other vertices");
  for (const int v : file.mesh_vertices) require_rule(v >= 0 && v < vertices, "a vertex of the file that became none");
  for (const std::string& note : file.notes)
    require_rule(std::all_of(note.begin(), note.end(), [](char c) { return c >= ' ' && c <= '~'; }),
                 "a note that cannot be shown");
}

/// Names and numbers that a reader took are for a PLY file too, to the bit.
void require_same_when_written(const MeshFile& file) {
  MeshFile plain;
  plain.mesh = file.mesh;
  const MeshFile again = read_mesh(mesh_file_bytes("again.ply", plain), "again.ply");
  require_rule(again.mesh.triangles.size() == file.mesh.triangles.size(), "other triangles when written and read");
}

bool read_as(std::string_view bytes, const char* name) {
  MeshFile file;
  if (!is_taken([&] { file = read_mesh(bytes, name); })) return false;
  require_promises(file);
  require_same_when_written(file);
  return true;
}

/// gzip of the bytes, hardly packed.
std::string packed(std::string_view bytes) {
  z_stream stream{};
  require_rule(deflateInit2(&stream, 1, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) == Z_OK, "zlib");
  std::string result(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  const int outcome = deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  require_rule(outcome == Z_STREAM_END, "zlib");
  return result;
}

}  // namespace

bool fuzz_any_mesh(std::string_view bytes) { return read_as(bytes, ""); }
bool fuzz_ply(std::string_view bytes) { return read_as(bytes, "crown.ply"); }
bool fuzz_stl(std::string_view bytes) { return read_as(bytes, "crown.stl"); }
bool fuzz_obj(std::string_view bytes) { return read_as(bytes, "crown.obj"); }
bool fuzz_off(std::string_view bytes) { return read_as(bytes, "crown.off"); }
bool fuzz_vtp(std::string_view bytes) { return read_as(bytes, "crown.vtp"); }
bool fuzz_vtk(std::string_view bytes) { return read_as(bytes, "crown.vtk"); }

/// Packed bytes as they come; others are packed first, so that what is inside is reached too.
bool fuzz_gzip(std::string_view bytes) {
  return read_as(bytes.starts_with("\x1f\x8b") ? std::string(bytes) : packed(bytes), "crown.stl.gz");
}

}  // namespace rhizodont::test
