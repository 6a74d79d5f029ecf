// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/face_list.hpp"

#include "io/notes.hpp"
#include "mesh/cut_polygon.hpp"

#include <algorithm>
#include <utility>

namespace rhizodont {

void FaceList::add_polygon(std::span<const std::int32_t> corners) {
  if (corners.size() > 3) {
    polygons_.push_back({triangles_.size(), corners_.size(), corners.size()});
    corners_.insert(corners_.end(), corners.begin(), corners.end());
  }
  for (std::size_t k = 2; k < corners.size(); ++k) triangles_.push_back({corners[0], corners[k - 1], corners[k]});
  end_face();
}

void FaceList::add_strip(std::span<const std::int32_t> corners) {
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const std::size_t odd = k % 2;
    const Triangle t{corners[k - 2 + odd], corners[k - 1 - odd], corners[k]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles_.push_back(t);
  }
  end_face();
}

void FaceList::end_face() { face_of_triangle_.resize(triangles_.size(), static_cast<std::int32_t>(face_count_++)); }

std::vector<double> FaceList::of_triangles(const std::vector<double>& of_faces) const {
  std::vector<double> values(triangles_.size());
  for (std::size_t t = 0; t < values.size(); ++t) values[t] = of_faces[static_cast<std::size_t>(face_of_triangle_[t])];
  return values;
}

void FaceList::move_to(MeshFile& file) {
  std::size_t concave = 0, cutting = 0;
  const std::vector<Point>& vertices = file.mesh.vertices;
  for (const Polygon& polygon : polygons_) {
    const std::span<const std::int32_t> corners(corners_.data() + polygon.first_corner, polygon.corner_count);
    const bool known = std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) {
      return v >= 0 && static_cast<std::size_t>(v) < vertices.size() &&
             vertices[static_cast<std::size_t>(v)].allFinite();
    });
    if (!known) continue;
    const CutPolygon cut = cut_polygon(vertices, corners);
    std::copy(cut.triangles.begin(), cut.triangles.end(),
              triangles_.begin() + static_cast<std::ptrdiff_t>(polygon.first_triangle));
    concave += cut.cut == PolygonCut::constrained;
    cutting += cut.cut == PolygonCut::fan_as_it_cuts;
  }
  file.mesh.triangles = std::move(triangles_);
  if (concave > 0)
    file.notes.push_back(counted(concave, "concave polygon was", "concave polygons were") + " cut into triangles.");
  if (cutting > 0)
    file.notes.push_back(counted(cutting, "polygon cuts itself", "polygons cut themselves") +
                         " and may be cut into wrong triangles.");
}

}  // namespace rhizodont
