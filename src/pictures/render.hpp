// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// 8-bit sRGB, rows from top to bottom.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3 * width * height
};

using Colour = std::array<float, 3>;  ///< linear RGB, [0, 1]

/// One mesh to draw, with a colour for each triangle (or one for all).
struct RenderItem {
  const TriangleMesh* mesh = nullptr;
  std::vector<Colour> colours;
  std::optional<Eigen::Vector3d> up;  ///< direction from root to crown, upwards in the picture; else RenderOptions::up
};

struct RenderOptions {
  int width = 640;   ///< pixels of one tile, [16, 8192]
  int height = 800;  ///< pixels of one tile, [16, 8192]
  /// One column each: front, back, left, right, top, bottom, oblique.
  std::vector<std::string> views = {"front", "right"};
  Eigen::Vector3d up = {0, 0, 1};
  bool wireframe = false;  ///< draw the triangles' edges
  int supersampling = 2;   ///< samples per pixel and direction, [1, 8]
};

/// Draws every mesh (a row of tiles each) in every view (a column each), orthographic, all at the same scale, each in
/// the middle of its tile. The same picture for any number of threads. Throws UsageError for an option out of range or
/// an unknown view, InputError for a mesh without triangles, with an index out of range, a coordinate that is not a
/// number, or another number of colours than 1 or that of its triangles.
Image render(const std::vector<RenderItem>& items, const RenderOptions& options = {});

/// The bytes of a PNG file.
std::string encode_png(const Image& image);

/// Colours of triangles by where their vertices come from (values of VertexSource): crown, transition, predicted.
/// A triangle is crown if all its vertices are, predicted if one of them is, else transition.
std::vector<Colour> colours_by_source(const TriangleMesh& mesh, const std::vector<double>& sources);

/// Colours of triangles by the mean of a number at their vertices, from dark blue (least) over green to yellow (most).
std::vector<Colour> colours_by_value(const TriangleMesh& mesh, const std::vector<double>& values);

/// The colour of enamel, for meshes that say nothing about their vertices.
Colour plain_colour();

}  // namespace rhizodont
