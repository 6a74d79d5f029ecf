// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <string>
#include <string_view>

// One reader or writer per format, from bytes to bytes: nothing here touches the file system.
// Readers throw InputError (without the file's name) and leave checks that all formats share to `finish_reading`.
namespace rhizodont {

MeshFile read_stl(std::string_view bytes);
MeshFile read_ply(std::string_view bytes);
MeshFile read_obj(std::string_view bytes);
MeshFile read_off(std::string_view bytes);
MeshFile read_vtp(std::string_view bytes);
MeshFile read_vtk(std::string_view bytes);

// Preconditions of all writers: a mesh that passed `require_writable`.
std::string write_ply(const MeshFile& file);
std::string write_stl(const MeshFile& file);
std::string write_obj(const MeshFile& file);
std::string write_glb(const MeshFile& file);

/// What is common to all formats: refuses a mesh without triangles, indices out of range and coordinates that are not
/// numbers; welds seams (io/weld.hpp); takes out triangles that use a vertex twice and notes them; sets
/// `coordinates_fit_float`.
void finish_reading(MeshFile& file);

/// Throws InputError for a mesh or attributes that no file should hold.
void require_writable(const MeshFile& file);

}  // namespace rhizodont
