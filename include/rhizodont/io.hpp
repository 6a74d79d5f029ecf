// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/output_files.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// Number type of an attribute in a file.
enum class AttributeType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// One number per vertex, or per triangle. `values` holds what `type` can store exactly.
struct VertexAttribute {
  AttributeType type = AttributeType::float32;
  std::vector<double> values;
};

/// Name of the attribute that says where a vertex comes from (uint8, the values of VertexSource).
inline constexpr const char* source_attribute = "source";

/// Where a vertex of a completed tooth comes from.
enum class VertexSource : std::uint8_t {
  scan = 0,        ///< given with the crown, untouched
  transition = 1,  ///< new, between crown and root
  predicted = 2,   ///< new, not seen by any scanner
};

/// A mesh as it stands in a file.
struct MeshFile {
  TriangleMesh mesh;
  std::map<std::string, VertexAttribute> vertex_attributes;  ///< written to PLY only
  std::vector<std::string> comments;                         ///< PLY and OBJ, one line each
  /// All coordinates are floats as they are. Set by `load_mesh`; `save_mesh` looks at the mesh itself.
  bool coordinates_fit_float = true;
  /// Triangles of the file left out because two corners are the same vertex (STL: the same bits); by their place in the
  /// file.
  std::vector<std::int64_t> dropped_triangles;
  /// Per vertex its number in the file, from 0: the first of those that were merged because their bits are equal. Empty
  /// where the numbers are the same, and for STL, whose files number no vertices.
  std::vector<int> file_vertices = {};
  /// What reading found and mended or passed over, a sentence each, for the user. Not written.
  std::vector<std::string> notes = {};
  /// Per triangle of the mesh, written to PLY only. Read from PLY, VTP and legacy VTK; all triangles of a polygon or a
  /// strip have its value. Whoever changes the triangles changes these too, or clears them.
  std::map<std::string, VertexAttribute> triangle_attributes = {};
  /// Per vertex of the file, from 0, the mesh's vertex that it became, for values kept beside the file in its own
  /// order. Empty where the numbers are the same, and for STL.
  std::vector<int> mesh_vertices = {};
  bool file_numbers_vertices = true;  ///< false for STL: its triangles repeat their corners' coordinates
};

/// Number of vertices in the file that was read; for STL, of the mesh.
RHIZODONT_EXPORT std::size_t vertices_in_file(const MeshFile& file);

/// True if every coordinate, rounded to float, is still the same number.
RHIZODONT_EXPORT bool coordinates_fit_float(const TriangleMesh& mesh);

/// Rounds all coordinates to float, for formats that hold no more. Returns the farthest that this moved a vertex, in
/// the mesh's unit. Throws InputError (id of the vertex) for a coordinate beyond all floats.
RHIZODONT_EXPORT double round_to_float(TriangleMesh& mesh);

/// Reads STL (binary, text), PLY (text, binary of both byte orders; polygons, strips), OBJ, OFF, VTP (text, base64,
/// raw; zlib, LZ4) and legacy VTK (POLYDATA, text and binary, to version 5). The content says which of them it is, the
/// file's ending only where the content leaves it open. gzip around any of them is unpacked (to at most 1 GiB, and
/// beyond 64 MiB to 200 times the packed size); byte order marks, UTF-16 and line ends of every kind are understood.
///
/// Order of vertices and triangles is that of the file. Vertices with equal bits (-0 = +0) are merged: in STL all of
/// them, numbered by first appearance; elsewhere where that closes a seam between triangles' borders, the first staying
/// (`file_vertices`), so that sheets that only touch stay apart. Polygons are cut into a fan from their first corner,
/// or, where that is wrong, along their inside. Colours per vertex or triangle become the attributes red, green and
/// blue (uint8).
///
/// Throws InputError, with the line, the element or the byte concerned, if the file is missing, empty, damaged, cut
/// off, something else than a mesh in one of these formats (then named), holds no triangle, a coordinate that is not a
/// number, or an index that is not a vertex. What was mended or passed over stands in `notes`.
RHIZODONT_EXPORT MeshFile load_mesh(const std::filesystem::path& path);

/// All bytes of a file or a pipe. Throws InputError, without the file's name, if it cannot be read.
RHIZODONT_EXPORT std::string read_file_bytes(const std::filesystem::path& path);

/// All bytes that come over standard input. Throws InputError if they cannot be read.
RHIZODONT_EXPORT std::string read_standard_input();

/// As `load_mesh`, of bytes that are at hand, such as those of standard input. The hint is a file's name, its ending or
/// a format's name ("crown.stl", ".stl", "stl"). Errors do not name the file.
RHIZODONT_EXPORT MeshFile read_mesh(std::string_view bytes, const std::filesystem::path& name_or_format_hint);

/// Writes .ply (binary), .stl (binary), .obj or .glb by extension. Coordinates that all fit float are written as float
/// bits, otherwise as double (PLY) or with all digits (OBJ). The file appears complete or not at all. Throws UsageError
/// for another extension, for STL or GLB of a mesh whose coordinates do not fit float; InputError for an invalid mesh
/// (index out of range, not finite, attribute of another length); OutputError if the file cannot be written.
RHIZODONT_EXPORT void save_mesh(const std::filesystem::path& path, const MeshFile& file);

/// What `save_mesh` would write, for `write_output_files` together with other files. Throws as `save_mesh`.
RHIZODONT_EXPORT std::string mesh_file_bytes(const std::filesystem::path& path, const MeshFile& file);

/// Throws UsageError unless a mesh can have this name: .ply, .stl, .obj or .glb.
RHIZODONT_EXPORT void require_mesh_ending(const std::filesystem::path& path);

/// Whether the format of this name holds no more than floats (STL, GLB).
RHIZODONT_EXPORT bool holds_floats_only(const std::filesystem::path& path);

}  // namespace rhizodont
