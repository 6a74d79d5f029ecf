// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

struct CleanLabelOptions {
  double island_share =
      0.02;                ///< [0, 1): a piece below this share of its tooth's largest one is an island, so is a hole
  double island_area = 1;  ///< mm^2, >= 0: so is one below this area
  double least_tooth_area = 4;  ///< mm^2, >= 0: a number without a larger piece is a stray one
  double big_share = 0.25;      ///< (0, 1]: a piece of at least this share of the largest one may be a tooth
  double near_gap = 2;          ///< mm, >= 0: a smaller piece farther than this from the largest one is not its tooth's
  double tooth_gap = 3;         ///< mm, >= near_gap: a big piece farther than this is another tooth
};

/// What became of a piece of a labelled surface.
struct LabelChange {
  int number = 0;  ///< before; 0 for a hole of gum in a tooth
  std::size_t vertices = 0;
  Point at = Point::Zero();   ///< mm, mean of its vertices
  double area = 0;            ///< mm^2
  std::optional<int> became;  ///< the number around it, or 0; nothing: kept as a second piece of the tooth
};

struct CleanedLabels {
  std::vector<int> fdi;              ///< per vertex, 0 is gum
  std::vector<LabelChange> changes;  ///< by number, then place in the mesh
};

/// Takes islands, stray numbers and holes of gum within one tooth out of the labels; a piece becomes what is most of
/// its border, of equal shares gum, then the lower number. Teeth in several pieces close together stay so and are
/// listed. Throws InputError, with the places, where one number is on two teeth far apart. Precondition: valid indices,
/// three different corners per triangle, finite coordinates, a label per vertex.
CleanedLabels clean_labels(const TriangleMesh& mesh, const std::vector<int>& fdi,
                           const CleanLabelOptions& options = {});

/// A sentence on a change, for a report.
std::string describe(const LabelChange& change);

}  // namespace rhizodont
