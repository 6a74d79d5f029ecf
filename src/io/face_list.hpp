// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rhizodont {

/// The faces of a file on their way to triangles. A polygon becomes a fan from its first corner at once and is cut
/// again at the end, when all vertices are known, if the fan was wrong; the number of triangles is the same.
class FaceList {
 public:
  void reserve(std::size_t count) {
    triangles_.reserve(count);
    face_of_triangle_.reserve(count);
  }
  std::size_t size() const { return triangles_.size(); }
  /// Faces and strips added so far, also those that are no triangles.
  std::size_t face_count() const { return face_count_; }

  /// Fewer than three corners are no face and passed over.
  void add_polygon(std::span<const std::int32_t> corners);

  /// A strip of triangles, every second turned around. Those with a corner twice only join pieces and are left out.
  void add_strip(std::span<const std::int32_t> corners);

  /// Values of the faces, in the order in which they were added, as values of the triangles. Precondition: as many as
  /// `face_count`.
  std::vector<double> of_triangles(const std::vector<double>& of_faces) const;

  /// Gives the file its triangles, and a note on polygons that needed care. Corners may still be no vertices: such
  /// polygons stay fans.
  void move_to(MeshFile& file);

 private:
  void end_face();

  struct Polygon {
    std::size_t first_triangle, first_corner, corner_count;
  };
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> face_of_triangle_;
  std::size_t face_count_ = 0;
  std::vector<Polygon> polygons_;  // of more than three corners
  std::vector<std::int32_t> corners_;
};

}  // namespace rhizodont
