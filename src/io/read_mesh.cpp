// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// From bytes to a mesh: which reader, and what all formats have in common.
#include "base/lower_case.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"
#include "io/recognise.hpp"
#include "io/stl.hpp"
#include "io/unwrap.hpp"
#include "io/weld.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

/// The ending of a name in lower case with its dot; also of a bare "ply" or ".ply". An ending ".gz" is passed over.
std::string format_hint(fs::path name) {
  if (name.extension() == ".gz" || name.extension() == ".GZ") name = name.stem();
  const std::string hint = lower_case((name.has_extension() ? name.extension() : name.filename()).string());
  return hint.starts_with('.') ? hint : "." + hint;
}

/// A sentence that quotes a file may hold any bytes.
std::string printable(std::string sentence) {
  for (char& c : sentence)
    if (c < ' ' || c > '~') c = '?';
  return sentence;
}

void keep_triangles(std::vector<double>& values, const std::vector<std::int64_t>& dropped) {
  std::size_t kept = 0, next = 0;
  for (std::size_t t = 0; t < values.size(); ++t) {
    if (next < dropped.size() && static_cast<std::size_t>(dropped[next]) == t)
      ++next;
    else
      values[kept++] = values[t];
  }
  values.resize(kept);
}

void take_out_repeated_corners(MeshFile& file) {
  std::vector<Triangle>& triangles = file.mesh.triangles;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle c = triangles[t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
      file.dropped_triangles.push_back(static_cast<std::int64_t>(t));
    else
      triangles[kept++] = c;
  }
  if (kept == triangles.size()) return;
  for (auto& [name, attribute] : file.triangle_attributes) keep_triangles(attribute.values, file.dropped_triangles);
  triangles.resize(kept);
  if (triangles.empty())
    throw InputError("the file holds no triangle with three different corners", file.dropped_triangles,
                     ElementKind::triangles);
  if (const std::size_t dropped = file.dropped_triangles.size(); dropped > 0)
    file.notes.push_back(counted(dropped, "facet without area was left out: two of its corners",
                                 "facets without area were left out: two of their corners") +
                         " are one point.");
}

MeshFile read_as(MeshFormat format, std::string_view bytes) {
  switch (format) {
    case MeshFormat::stl:
      return read_stl(bytes);
    case MeshFormat::ply:
      return read_ply(bytes);
    case MeshFormat::obj:
      return read_obj(bytes);
    case MeshFormat::off:
      return read_off(bytes);
    case MeshFormat::vtp:
      return read_vtp(bytes);
    case MeshFormat::vtk:
      break;
  }
  return read_vtk(bytes);
}

std::string all_bytes(std::FILE* file) {
  std::string bytes;
  std::size_t size = 0;
  do {
    bytes.resize(std::max<std::size_t>(2 * size, 1 << 16));
    size += std::fread(bytes.data() + size, 1, bytes.size() - size, file);
  } while (size == bytes.size());
  if (std::ferror(file) != 0) throw InputError(fmt::format("the file cannot be read: {}", std::strerror(errno)));
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string read_file_bytes(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw InputError("this is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) throw InputError(fmt::format("the file cannot be opened: {}", std::strerror(errno)));
  return all_bytes(file.get());
}

std::string read_standard_input() { return all_bytes(stdin); }

std::size_t vertices_in_file(const MeshFile& file) {
  return file.mesh_vertices.empty() ? file.mesh.vertices.size() : file.mesh_vertices.size();
}

void finish_reading(MeshFile& file) {
  if (file.mesh.triangles.empty()) throw InputError("the file holds no triangles");
  if (file.mesh.vertices.size() > static_cast<std::size_t>(INT32_MAX) ||
      file.mesh.triangles.size() > static_cast<std::size_t>(INT32_MAX) / 3)
    throw InputError("the mesh is too large");
  require_valid_indices(file.mesh);
  require_finite(file.mesh.vertices);
  weld_seams(file);
  take_out_repeated_corners(file);
  file.coordinates_fit_float = coordinates_fit_float(file.mesh);
}

MeshFile read_mesh(std::string_view bytes, const std::filesystem::path& name_or_format_hint) {
  try {
    if (bytes.empty()) throw InputError("the file is empty");
    Unwrapped content;
    content.bytes = bytes;
    if (!is_exact_binary_stl(bytes)) unwrap(bytes, content);
    if (content.bytes.empty()) throw InputError("the file is empty");
    MeshFile file = read_as(recognise(content.bytes, format_hint(name_or_format_hint)), content.bytes);
    file.notes.insert(file.notes.begin(), content.notes.begin(), content.notes.end());
    for (std::string& note : file.notes) note = printable(std::move(note));
    finish_reading(file);
    return file;
  } catch (const InputError& error) {
    throw error.reworded(printable(error.what()));
  }
}

MeshFile load_mesh(const std::filesystem::path& path) {
  try {
    return read_mesh(read_file_bytes(path), path);
  } catch (const InputError& error) {
    throw error.reworded(path.string() + ": " + error.what());
  }
}

}  // namespace rhizodont
