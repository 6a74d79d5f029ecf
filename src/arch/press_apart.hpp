// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// New surface taken back where it lies in a neighbour.
#pragma once

#include "fusion/restore.hpp"

#include <vector>

namespace rhizodont {

struct PressOptions {
  double gap = 0.03;  ///< mm, (0, 0.5]: vertices of teeth that lie in each other are sought to be this far apart
  /// mm, (0, 2]: no vertex moves farther. The default is about what is known of a root's surface: predicted ones are
  /// 0.4 mm off in the mean (docs/roots.md).
  double most = 0.5;
  double reach = 3;  ///< mm, > 0: so far along edges the surface around gives way, too
  int rounds = 8;    ///< >= 1: at most so often teeth are measured and moved
};

/// Throws UsageError, with a sentence, for options out of range.
void require_options_in_range(const PressOptions& options);

struct PressedTeeth {
  std::vector<TriangleMesh> meshes;  ///< per tooth; only new vertices have moved
  std::vector<double> largest_mm;    ///< per tooth: the longest way of a vertex; 0 where the tooth is as it was
};

/// Where a scan does not show what lies between two teeth, either is completed as if the other were not there, and the
/// two may share the place. Turning a root moves nothing so close to the crown. Here both new surfaces give way, each
/// by half, or one wholly where it meets the other's scan; around it the surface follows smoothly
/// (`smoothest_displacements`), and nothing turns over, gets needles or cuts itself (`move_safely`). Scanned vertices
/// never move. Teeth that touch nobody stay as they are, bit for bit; what is deeper than `most` stays partly.
///
/// @param teeth  mm; the first crown_vertices and crown_triangles of each as scanned. A tooth without any is left out
/// Ways are rounded to 2^-12 mm, so that sums in another order give the same. The same on any number of
/// threads. Throws UsageError for options out of range, InputError for a tooth that is no closed solid.
PressedTeeth press_apart(const std::vector<JoinedTooth>& teeth, const PressOptions& options = {});

}  // namespace rhizodont
