// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// STL as written by scanners and CAD programs: 80 bytes of anything, a count, 50 bytes per triangle; or text.
#include "io/stl.hpp"
#include "io/append_bytes.hpp"
#include "io/cursors.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"
#include "io/weld.hpp"
#include "mesh/geometry.hpp"

#include <fmt/core.h>

#include <cmath>

namespace rhizodont {
namespace {

constexpr std::size_t header_size = 84, record_size = 50;
constexpr std::size_t most_triangles = 100'000'000;  // a larger announcement is no number of triangles

void require_finite_corner(const std::array<float, 3>& corner, std::int64_t triangle) {
  for (const float x : corner)
    if (!std::isfinite(x))
      throw InputError(
          fmt::format("triangle {} (counted from 0) has a coordinate that is not a finite number", triangle),
          {triangle});
}

std::size_t announced_triangles(std::string_view bytes) {
  ByteCursor cursor(bytes, std::endian::little);
  cursor.skip(80);
  return cursor.read<std::uint32_t>();
}

std::size_t triangles_with_room(std::string_view bytes) { return (bytes.size() - header_size) / record_size; }

std::array<float, 3> read_corner(ByteCursor& cursor) {
  std::array<float, 3> corner{};
  for (float& x : corner) x = cursor.read<float>();
  return corner;
}

MeshFile read_binary(std::string_view bytes, std::size_t count) {
  MeshFile file;
  file.mesh.triangles.reserve(count);
  EqualPoints points(count / 2);
  ByteCursor cursor(bytes, std::endian::little);
  cursor.skip(header_size);
  for (std::size_t t = 0; t < count; ++t) {
    cursor.skip(12);
    Triangle& triangle = file.mesh.triangles.emplace_back();
    for (std::int32_t& v : triangle) {
      const std::array<float, 3> corner = read_corner(cursor);
      require_finite_corner(corner, static_cast<std::int64_t>(t));
      v = points.number_in({corner[0], corner[1], corner[2]}, file.mesh.vertices);
    }
    cursor.skip(2);
  }
  if (bytes.substr(0, 80).find("COLOR=") != std::string_view::npos) file.notes.emplace_back(triangle_colours_note);
  return file;
}

/// Whether bytes can be the triangles of a scan: coordinates are 0 or of a size that has a sense. Bytes of anything
/// else do not look so for long.
bool are_triangles(std::string_view bytes, std::size_t begin, std::size_t end) {
  ByteCursor cursor(bytes, std::endian::little);
  cursor.skip(header_size + begin * record_size);
  for (std::size_t t = begin; t < end; ++t) {
    cursor.skip(12);
    for (int i = 0; i < 9; ++i) {
      const float x = std::abs(cursor.read<float>());
      if (!(x == 0 || (x > 1e-20F && x < 1e9F))) return false;
    }
    cursor.skip(2);
  }
  return end > begin;
}

/// A count that was never filled in, or written in the other byte order, or of corners: the file's size says how many
/// triangles there are.
bool is_known_wrong_count(std::size_t announced, std::size_t present) {
  const auto as_written = static_cast<std::uint32_t>(announced);
  const std::uint32_t turned =
      as_written << 24 | (as_written << 8 & 0xff0000U) | (as_written >> 8 & 0xff00U) | as_written >> 24;
  return announced == 0 || announced >= std::size_t{1} << 31 || turned == present || announced == 3 * present;
}

/// A binary file whose size is not the one announced. Precondition: there is a whole header.
MeshFile read_of_other_size(std::string_view bytes) {
  const std::size_t announced = announced_triangles(bytes), present = triangles_with_room(bytes);
  const std::size_t left_over = (bytes.size() - header_size) % record_size;
  if (left_over == 0 && are_triangles(bytes, 0, present) &&
      (announced < present || is_known_wrong_count(announced, present))) {
    MeshFile file = read_binary(bytes, present);
    file.notes.push_back(
        fmt::format("The file's count of triangles is wrong; all {} that it holds were read.", present));
    return file;
  }
  if (announced > 0 && announced <= present) {
    MeshFile file = read_binary(bytes, announced);
    const std::size_t more = bytes.size() - header_size - announced * record_size;
    file.notes.push_back(counted(more, "byte", "bytes") + " after the last triangle announced: passed over.");
    return file;
  }
  const std::size_t whole = std::min(announced, present);
  if (whole > 0 && !are_triangles(bytes, 0, whole))
    throw InputError("this is no STL file: it is neither text nor triangles");
  if (announced == 0) throw InputError("the file holds no triangles, or it is damaged or cut off");
  if (announced > most_triangles)
    throw InputError(fmt::format("the file is damaged or cut off: it has room for {} only",
                                 counted(present, "triangle", "triangles")));
  throw InputError(
      fmt::format("the file is damaged or cut off: it announces {} triangles and has room for {}", announced, present));
}

// What a comment "unit: ..." says; millimetres where none does.
std::string unit_in_comments(const std::vector<std::string>& comments) {
  constexpr std::string_view mark = "unit: ";
  for (const std::string& comment : comments)
    if (comment.starts_with(mark)) return comment.substr(mark.size());
  return "millimetres";
}

}  // namespace

bool is_exact_binary_stl(std::string_view bytes) {
  return bytes.size() > header_size && bytes.size() == header_size + record_size * announced_triangles(bytes);
}

bool is_binary_stl_of_other_size(std::string_view bytes) {
  if (bytes.size() < header_size + record_size) return false;
  const std::size_t announced = announced_triangles(bytes), present = triangles_with_room(bytes);
  return are_triangles(bytes, 0, announced > 0 ? std::min(announced, present) : present);
}

namespace {

MeshFile read_any(std::string_view bytes) {
  if (is_exact_binary_stl(bytes)) return read_binary(bytes, triangles_with_room(bytes));
  if (is_stl_text(bytes)) return read_stl_text(bytes);
  if (bytes.size() < header_size) throw InputError("the file is too short for an STL file: it is damaged or cut off");
  return read_of_other_size(bytes);
}

}  // namespace

MeshFile read_stl(std::string_view bytes) {
  MeshFile file = read_any(bytes);
  file.file_numbers_vertices = false;
  return file;
}

std::string write_stl(const MeshFile& file) {
  const TriangleMesh& mesh = file.mesh;
  if (!coordinates_fit_float(mesh))
    throw UsageError(
        "STL files hold single precision only, and this mesh has coordinates that need double; use PLY or OBJ");
  std::string bytes = "Rhizodont, " + unit_in_comments(file.comments);
  bytes.resize(80, ' ');
  bytes.reserve(header_size + record_size * mesh.triangles.size());
  append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3f normal = triangle_normal(mesh, t).cast<float>();
    for (int i = 0; i < 3; ++i) append_bytes(bytes, normal[i]);
    for (const std::int32_t v : mesh.triangles[t])
      for (int i = 0; i < 3; ++i)
        append_bytes(bytes, static_cast<float>(mesh.vertices[static_cast<std::size_t>(v)][i]));
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace rhizodont
