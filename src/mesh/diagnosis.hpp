// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// What is wrong with a mesh, each defect by the ids of its elements, and its topology. All lists are sorted.
/// Triangles with an index out of range or a repeated index are left out of everything that follows them here.
struct Diagnosis {
  std::vector<int> non_finite_vertices;                ///< a coordinate is NaN or infinite
  std::vector<int> out_of_range_triangles;             ///< an index is not a vertex
  std::vector<int> repeated_index_triangles;           ///< the same vertex twice
  std::vector<int> degenerate_triangles;               ///< corners exactly on one line
  std::vector<int> duplicate_triangles;                ///< same three vertices (any order) as an earlier triangle
  std::vector<int> duplicate_vertices;                 ///< same coordinates (as bits, -0 = +0) as an earlier vertex
  std::vector<int> unreferenced_vertices;              ///< in no triangle
  std::vector<std::array<int, 2>> border_edges;        ///< with one triangle
  std::vector<std::array<int, 2>> non_manifold_edges;  ///< with more than two triangles
  std::vector<std::array<int, 2>>
      misoriented_edges;                   ///< directed edges that two or more triangles run through the same way
  std::vector<int> non_manifold_vertices;  ///< whose triangles are not one fan (joined over edges at the vertex)

  int vertices = 0;  ///< in use by a triangle
  int edges = 0;
  int triangles = 0;
  int components = 0;         ///< pieces joined by vertices
  int border_loop_count = 0;  ///< pieces of the border, joined by vertices
  int euler_number = 0;       ///< vertices - edges + triangles
  std::optional<int> genus;   ///< of a closed manifold oriented mesh: components - euler_number / 2
  double volume = 0;          ///< mm^3, signed; 0 if a vertex is not finite

  /// Every index valid and every coordinate finite.
  bool is_valid() const;
  /// Manifold at edges and vertices, consistently oriented (a border is allowed).
  bool is_oriented_manifold() const;
  /// No border, and an oriented manifold.
  bool is_closed_manifold() const;
  /// Closed manifold, outward, one component, genus 0, nothing unreferenced or duplicated. Self-intersections are not
  /// looked at: that is `self_intersecting_triangles`.
  bool is_closed_solid() const;
};

Diagnosis diagnose(const TriangleMesh& mesh);

/// One sentence per defect found, with counts and the first ids; empty for a mesh without defects. A border is no
/// defect.
std::vector<std::string> describe_defects(const Diagnosis& diagnosis);

}  // namespace rhizodont
