// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <filesystem>

namespace rhizodont {

/// A complete tooth from a library, and which part of it is crown.
struct TemplateTooth {
  TriangleMesh mesh;              ///< closed, outward, mm
  TriangleMesh crown;             ///< its triangles of enamel
  Eigen::Vector3d axis{0, 0, 1};  ///< unit, root to crown: the longest extent
};

/// Reads folder/tooth_FDI.ply of the left side (21-28, 31-38), mirrored for a tooth of the right side. The file's
/// vertex attribute `crown` says where enamel is (1); a file without it has its upper 40 % taken for crown, the wider
/// end being up. Throws UsageError for a number that is no FDI number of a permanent tooth, InputError for a missing or
/// damaged file or one without crown.
TemplateTooth load_template_tooth(const std::filesystem::path& folder, int fdi);

struct TemplateFitOptions {
  int start_rotations = 12;         ///< >= 1: starting positions, evenly turned about the growth axis
  int iterations = 25;              ///< >= 1, of each start
  std::size_t samples = 1500;       ///< >= 100: points on either crown, twice as many on the whole template
  double trim = 0.85;               ///< (0, 1]: share of the template's points, the nearest, that take part
  double border_margin_mm = 0.3;    ///< >= 0: template points lower than this above the crown's border do not take part
  double largest_scale_step = 1.1;  ///< > 1: of one iteration, and its inverse the smallest
};

/// The simple predictor: what a program with a tooth library does. The template is moved, turned and scaled (similarity
/// ICP, P. Besl and N. McKay 1992, with the closed form of S. Umeyama 1991) until its crown lies on the given one; the
/// best of several starts is returned, the crown itself is not joined to it. Deterministic.
/// @param crown  open at its base, mm
/// Throws InputError for a crown without surface or border, UsageError for an option out of range.
TriangleMesh fit_template(const TriangleMesh& crown, const TemplateTooth& tooth,
                          const TemplateFitOptions& options = {});

}  // namespace rhizodont
