// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/output_options.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <string>

namespace rhizodont::command_line {

/// For those who want details: how large a mesh is that was read, and what was found and mended in reading it.
inline void detail_of_mesh(const OutputOptions& output, const std::string& name, const MeshFile& file) {
  output.detail(
      fmt::format("{}: {} vertices, {} triangles", name, file.mesh.vertices.size(), file.mesh.triangles.size()));
  for (const std::string& note : file.notes) output.detail("  " + note);
}

}  // namespace rhizodont::command_line
