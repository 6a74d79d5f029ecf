// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fusion/edge_lengths.hpp"
#include "fusion/patch_mesh.hpp"
#include "fusion/restore.hpp"
#include "fusion/surface_walk.hpp"

#include <vector>

namespace rhizodont {

/// Smallest angle of a triangle in radians; 0 if two corners coincide.
double smallest_angle(const Point& a, const Point& b, const Point& c);

/// The new triangles of a tooth, lying along the guiding surface. Beside the crown's border, which does not lie on that
/// surface exactly, they follow it at an offset that fades with the distance.
class FittedPatch {
 public:
  /// Keeps references to `walk` and `lengths`.
  FittedPatch(const JoinedTooth& tooth, const SurfaceWalk& walk, const EdgeLengths& lengths);

  const PatchMesh& mesh() const { return mesh_; }
  const Point& point(int v) const { return mesh_.points[static_cast<std::size_t>(v)]; }
  double size(int v) const { return size_[static_cast<std::size_t>(v)]; }

  /// Vertices that nothing may touch: fixed vertices are not affected.
  void freeze(const std::vector<Point>& centres, double radius);
  bool is_frozen(int v) const { return frozen_[static_cast<std::size_t>(v)] != 0; }

  /// Length of the edge relative to what is wanted there.
  double relative_length(int h) const;
  /// Smallest angle of the half-edge's triangle, and with vertex v elsewhere.
  double smallest_angle_at(int h) const;

  /// Wanted edge lengths at all vertices anew.
  void renew_sizes();
  /// Offsets of the free vertices from their neighbours'.
  void renew_offsets(double fading);

  /// Where vertex v would lie if put at p, brought back to the guiding surface.
  SurfacePlace fit(int v, const Point& p) const;
  /// The triangles around v, with v at `place`, do not turn away from the guiding surface more than they do now.
  bool can_move(int v, const SurfacePlace& place) const;
  void move(int v, const SurfacePlace& place);

  bool can_flip(int h) const;
  void flip(int h) { mesh_.flip(h); }
  bool can_split(int h) const;
  int split(int h);
  /// Also that no triangle turns over.
  bool can_collapse(int h) const;
  void collapse(int h) { mesh_.collapse(h); }

  /// The tooth with these triangles in the place of its new ones.
  TriangleMesh tooth(const JoinedTooth& before) const;

 private:
  bool faces_outward(const Point& a, const Point& b, const Point& c, int near) const;

  const SurfaceWalk& walk_;
  const EdgeLengths& lengths_;
  PatchMesh mesh_;
  std::vector<int> place_;               // per vertex: triangle of the guiding surface
  std::vector<double> size_;             // per vertex: wanted edge length
  std::vector<Eigen::Vector3d> offset_;  // per vertex: from the guiding surface
  std::vector<char> frozen_;
};

}  // namespace rhizodont
