// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/crown_crop.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"

#include <cstdint>

namespace rhizodont {

/// A generated tooth, or its crown, for the other side of the mouth: x changes sign, triangles still face outward.
TriangleMesh on_other_side(TriangleMesh mesh);

/// A generated tooth as a file, coordinates rounded to float: `source` says which vertices stand above the gum line
/// (values of VertexSource), `crown` which are enamel; comments say where it comes from and how long it is. Generated
/// teeth are left ones: `right_side` mirrors.
MeshFile synthetic_tooth_file(const SyntheticTooth& tooth, const GumLine& line, bool right_side);

/// How a crown is scanned; see `scanner_mesh`.
struct ScannedAs {
  double edge_mm = 0;   ///< 0.1..1; 0: the generator's own triangles, without noise
  double noise_mm = 0;  ///< 0..0.1
  std::uint64_t seed = 0;
};

/// The crown cut from a generated tooth as a file, with the tooth's comments, on its side, coordinates rounded to
/// float. Throws as `scanner_mesh`.
MeshFile synthetic_crown_file(const SyntheticTooth& tooth, const CroppedCrown& crown, bool right_side,
                              const ScannedAs& look);

}  // namespace rhizodont
