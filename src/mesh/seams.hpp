// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <string>
#include <vector>

namespace rhizodont {

struct SeamOptions {
  double most_mm = 0.025;    ///< mm, >= 0: border vertices farther apart are not the same place; a scanner is surer
                             ///< of a place than by this
  double edge_share = 0.25;  ///< [0, 0.5): nor are those farther apart than this share of the shortest edge at either,
                             ///< so that no triangle loses a side
};

/// Throws UsageError for an option out of its range.
void require_in_range(const SeamOptions& options);

/// Which border vertices are the same place on both sides of a seam.
struct Seams {
  std::vector<int> target;  ///< per vertex the lower one that is to take its place, or itself
  int merged = 0;           ///< vertices that another one takes the place of
  double largest_mm = 0;    ///< between a vertex and the one that takes its place
};

/// Finds places where border edges of a mesh run along each other, equal but for rounding or a small shift; of a soup
/// all its seams at once. Takes n log n time. Precondition: valid indices, finite coordinates.
Seams find_seams(const TriangleMesh& mesh, const SeamOptions& options = {});

/// The width of a seam for a sentence: "0.012 mm", "less than 0.001 mm".
std::string seam_width_in_words(double mm);

}  // namespace rhizodont
