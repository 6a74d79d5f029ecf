// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// From bytes to a mesh: which reader, and what all formats have in common.
#include "io/formats.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

std::string read_bytes(const fs::path& path) {
  if (fs::is_directory(path)) throw InputError("this is a folder, not a file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("the file cannot be opened: {}", std::strerror(errno)));
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw InputError("the file cannot be read");
  return bytes;
}

using Reader = MeshFile (*)(std::string_view);

/// The ending of a name in lower case with its dot; also of a bare "ply" or ".ply".
std::string format_hint(const fs::path& name) {
  std::string hint = name.has_extension() ? name.extension().string() : name.filename().string();
  for (char& c : hint)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  return hint.starts_with('.') ? hint : "." + hint;
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
  triangles.resize(kept);
}

}  // namespace

void finish_reading(MeshFile& file) {
  if (file.mesh.triangles.empty()) throw InputError("the file holds no triangles");
  if (file.mesh.vertices.size() > static_cast<std::size_t>(INT32_MAX) ||
      file.mesh.triangles.size() > static_cast<std::size_t>(INT32_MAX) / 3)
    throw InputError("the mesh is too large");
  require_valid_indices(file.mesh);
  require_finite(file.mesh.vertices);
  take_out_repeated_corners(file);
  if (file.mesh.triangles.empty())
    throw InputError("the file holds no triangle with three different corners", file.dropped_triangles);
  file.coordinates_fit_float = coordinates_fit_float(file.mesh);
}

MeshFile read_mesh(std::string_view bytes, const std::filesystem::path& name_or_format_hint) {
  static const std::map<std::string, Reader> readers{
      {".stl", read_stl}, {".ply", read_ply}, {".obj", read_obj}, {".off", read_off}, {".vtp", read_vtp}};
  const auto reader = readers.find(format_hint(name_or_format_hint));
  if (reader == readers.end()) throw UsageError("only files named .obj, .off, .ply, .stl, .vtp can be read");
  if (bytes.empty()) throw InputError("the file is empty");
  MeshFile file = reader->second(bytes);
  finish_reading(file);
  return file;
}

MeshFile load_mesh(const std::filesystem::path& path) {
  try {
    return read_mesh(read_bytes(path), path);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what(), error.elements());
  } catch (const UsageError& error) {
    throw UsageError(path.string() + ": " + error.what());
  }
}

}  // namespace rhizodont
