// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "rhizodont/io.hpp"

#include <optional>
#include <string>
#include <vector>

// Labels in the dialects that other programs read. What the numbers mean is the caller's (teeth/label_numbers.hpp turns
// FDI numbers into others).
namespace rhizodont {

/// Text of a Teeth3DS file: `labels` and `instances` (teeth numbered from 1 in the order of their numbers) in the
/// order and count of the vertices of the file that `scan` was read from; `id_patient` is empty.
/// The format keeps one jaw a file: `jaw` is written as given; for a scan of both jaws give none and the entry is left
/// out. Throws UsageError if a jaw is given and a tooth is of the other one, if there are not as many labels as the
/// mesh has vertices, or if one is neither 0 nor an FDI number.
std::string teeth3ds_json(const std::vector<int>& fdi, std::optional<Jaw> jaw, const MeshFile& scan);

/// VTP (text) of the mesh with the cell array `Label` (Int32). Throws UsageError if there are not as many labels as
/// triangles.
std::string vtp_with_cell_labels(const TriangleMesh& mesh, const std::vector<int>& per_triangle,
                                 const std::string& array = "Label");

enum class VtkEncoding { ascii, binary };

/// Legacy VTK 4.2 of the mesh with the point array `Universal_ID` (int), coordinates as float where that is exact and
/// as double otherwise. Throws UsageError if there are not as many labels as vertices.
std::string vtk_with_point_labels(const TriangleMesh& mesh, const std::vector<int>& per_vertex,
                                  VtkEncoding encoding = VtkEncoding::binary,
                                  const std::string& array = "Universal_ID");

}  // namespace rhizodont
