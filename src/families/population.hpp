// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "teeth/fdi.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace rhizodont {

/// A type's teeth in a population. The default table, populations/middle.json, names the source of each value.
struct ToothPopulation {
  double root_length_mm = 0;              ///< mean of the longest root, from the junction amid the cheek's side; 4..30
  double root_length_deviation_mm = 0;    ///< with what goes with the crown's size; 0..6
  double root_follows_crown = 0;          ///< exponent with which the root's length follows the crown's size; 0..1
  double crown_size = 1;                  ///< of its widths, over the means of anatomy.csv; 0.7..1.4
  double crown_size_deviation = 0;        ///< relative; 0..0.25
  double crown_proportion_deviation = 0;  ///< mesiodistal and buccolingual width each on its own, relative; 0..0.2
  double crown_form_factor = 1;           ///< on the deviations of the crown models' modes and of the surface; 0..2
  double neighbour_share = 0;             ///< grown from a neighbour's template; upper premolars: with its roots; 0..1;
                                          ///< 0 for 21, 23 and 33, which resemble none
  double fused_share = 0;                 ///< of multi-rooted teeth: roots that part late; 0..1
  double trunk_mm = 0;  ///< of molars: junction amid the cheek's side to the parting; 0: as in the template; 0..10
  double trunk_deviation_mm = 0;         ///< 0..4
  double lean_mesiodistal_degrees = 0;   ///< deviation of the root's line from the crown's axis; 0..15
  double lean_buccolingual_degrees = 0;  ///< 0..15
  double curved_share = 0;               ///< of roots; 0..1
  double curve_degrees = 0;              ///< turn of the tip's chord of curved roots, mean; 0..45
  double curve_deviation_degrees = 0;    ///< 0..20
  double curve_usual_share = 0;          ///< single roots to distal, parted ones to the tooth's middle; 0..1
  double dilaceration_share = 0;         ///< sharp turns near the tip; 0..1
  double root_thickness_deviation = 0;   ///< of the width along x and y each, relative; 0..0.3
  double short_root_share = 0;           ///< short, blunt roots from birth; 0..1
};

/// Of the sixteen types: upper 1..8, lower 1..8.
struct Population {
  std::string name;
  std::array<ToothPopulation, tooth_type_count> teeth;
};

/// The middle of published populations.
const Population& default_population();

/// A table as JSON: {"format": "rhizodont population 1", "name": ..., "sources": {anything}, "teeth": {"36":
/// {"root_length_mm": 13.1, ...}, ...}}, teeth by their FDI numbers on the left. Teeth and values that are not named
/// are the default's. Throws InputError for text that is no such table, for a tooth or value that does not exist and
/// for one that is no number or out of its range, naming it and `file`.
Population read_population(std::string_view text, const std::string& file);

/// Throws InputError for a file that cannot be read, and as read_population.
Population load_population(const std::filesystem::path& file);

}  // namespace rhizodont
