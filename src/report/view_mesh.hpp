// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"

#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// A mesh to look at, with the numbers that it can be coloured by.
struct ViewMesh {
  const TriangleMesh* mesh = nullptr;
  Point middle = Point::Zero();  ///< that coordinates are counted from, in the mesh's unit
  double millimetres_per_unit = 1;
  std::map<std::string, std::vector<float>> per_vertex, per_triangle;
};

/// "RZV1", the number of bytes of a JSON text (uint32), that text, padded with spaces to a multiple of four, and the
/// arrays that it lists, each at a multiple of four, all little-endian: position (float32, mm from `centre_mm`), index
/// (uint32), and the named numbers (float32). To look at: coordinates are rounded.
std::string view_bytes(const ViewMesh& view);

/// A tooth: source (values of VertexSource) and uncertainty (mm) per vertex, quality (Q) per triangle, clearance (mm)
/// where it is known.
std::string tooth_view(const CompletedTooth& tooth, const std::vector<double>& clearance, const Point& middle);

/// The crown as it was given: kept (1 or 0), deviation (mm from the tooth's surface; paper, figure 10) and, if it was
/// judged, confidence (0..1, -1 not judged) per vertex, quality (Q) per triangle.
std::string crown_view(const TriangleMesh& crown, const CompletedTooth& tooth, const Point& middle);

/// The middle of a scan's box, from which coordinates are counted in what is looked at.
Point middle_of(const TriangleMesh& mesh);

/// Shape alone.
std::string plain_view(const TriangleMesh& mesh, const Point& middle, double millimetres_per_unit);

}  // namespace rhizodont
