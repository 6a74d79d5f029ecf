// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/arch_crowns.hpp"
#include "families/marching_cubes.hpp"

#include <cstdint>
#include <vector>

// Signed distances (mm, negative inside, roughly right near 0 and cut off farther away) of teeth and gum on a lattice.
namespace rhizodont {

/// Distances are cut off beyond this, mm.
inline constexpr float field_reach = 1.2F;

/// The arch as seen from above, every mm.
struct PlanMap {
  double x0 = 0, z0 = 0;
  int nx = 0, nz = 0;
  std::vector<float> along;  ///< mm along the curve of the nearest point
  std::vector<float> off;    ///< mm from the curve, positive towards the cheek
  std::vector<float> level;  ///< height of palate or floor of the mouth; far below where there is none

  /// Between the four values around.
  double sample(const std::vector<float>& values, double x, double z) const;
};

struct ArchFields {
  Lattice lattice;
  std::vector<float> tooth;         ///< of the nearest tooth
  std::vector<float> second;        ///< of the second nearest
  std::vector<std::uint8_t> owner;  ///< number of the nearest tooth among the crowns; 255 for none
  std::vector<float> gum;
  PlanMap plan;
};

/// A lattice around the crowns with room for gum.
Lattice lattice_around(const ArchCrowns& arch, double cell);

/// Lays all teeth on the lattice.
void add_teeth(const ArchCrowns& arch, RandomStream& random, ArchFields& fields);

/// How the gum of a jaw is formed.
struct GumForm {
  double rise = 0.8, rise_length = 0.9;           ///< mm: thickness that the margin swells to, and within what depth
  double buccal_slope = 0.15, oral_slope = 0.25;  ///< growth of thickness per mm of depth
  double vestibule = 9, flare = 0.7;              ///< depth at which the cheek begins, and how it bends outwards
  double papilla = 1.2;                           ///< mm: how high the gum rises between two teeth, above their necks
  double wall = 0.85;                             ///< width of the ridge between the teeth, of theirs
  double jaw = 0.5;                               ///< mm: by how much the jaw below is wider than the ridge
  double root_shows = 4;                          ///< mm of depth down to which the gum follows each root
  double blend = 0.6;                             ///< mm: how softly neighbours run into each other
  double palate_depth = 14, palate_power = 0.65;  ///< below the necks; the larger the more like a gable
  double floor_depth = 10;                        ///< of the mouth, lower jaw
  bool floor = true;
};

GumForm draw_gum_form(Jaw jaw, RandomStream& random);

/// Lays gum, palate and the ridges behind the last teeth on the lattice; makes `plan`.
void add_gum(const ArchCrowns& arch, const GumForm& form, ArchFields& fields);

}  // namespace rhizodont
