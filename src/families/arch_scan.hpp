// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/arch_fields.hpp"

#include <cstddef>
#include <vector>

// From fields on a lattice to what a scanner and its program give.
namespace rhizodont {

struct ScanSurface {
  TriangleMesh mesh;     ///< work frame
  std::vector<int> fdi;  ///< per vertex, 0 is gum
};

/// How much of the gum a scan shows and how it ends. Millimetres.
struct ScanExtent {
  double buccal = 6, oral = 6, behind = 4;  ///< from the nearest tooth
  bool whole_palate = true;                 ///< upper jaw
  double palate_end = 4;                    ///< in front of the last tooth's middle (negative: behind it)
  bool model = false;                       ///< on a closed base instead
  bool partial = false;
  double from = 0, to = 0;  ///< partial: along the curve
};

ScanExtent draw_extent(const ArchCrowns& arch, RandomStream& random, const ArchDrawOptions& options);

/// A base below the gum, for a model: closes the solid.
void add_model_base(const ArchCrowns& arch, RandomStream& random, ArchFields& fields);

/// The surface of teeth and gum. @param soft  mm, how softly teeth run into each other and into the gum
ScanSurface surface_of(const ArchCrowns& arch, const ArchFields& fields, double soft);

/// Takes out pieces of fewer than `least` triangles, and vertices at which the surface is no disc.
void drop_crumbs(ScanSurface& scan, std::size_t least);

/// Gives the gum its small forms: bumps, folds of the palate.
void form_gum(const ArchCrowns& arch, const ArchFields& fields, RandomStream& random, ScanSurface& scan);

/// Takes away what the scan does not show; its border is ragged.
void trim(const ArchCrowns& arch, const ArchFields& fields, const ScanExtent& extent, RandomStream& random,
          ScanSurface& scan);

/// Holes, bubbles, loose pieces. @param amount 0..2
void spoil(const ArchCrowns& arch, double amount, RandomStream& random, ScanSurface& scan);

/// Thinned to about that many triangles, unevenly, as programs do.
void thin(std::size_t triangles, RandomStream& random, ScanSurface& scan);

/// Noise along the normals. @param amount 0..2
void roughen(double amount, RandomStream& random, ScanSurface& scan);

/// Makes every tooth one patch: lesser patches get the label that is around them. Teeth with fewer than `least`
/// vertices become gum.
void tidy_labels(std::size_t least, ScanSurface& scan);

}  // namespace rhizodont
