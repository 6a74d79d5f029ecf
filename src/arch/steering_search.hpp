// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// How roots are to be steered so that they stand apart, tried on teeth that cost little to steer.
#pragma once

#include "arch/clearance.hpp"
#include "arch/steerable_root.hpp"
#include "rhizodont/root_steering.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace rhizodont {

/// What a change of a root is thought to cost: how far it moves the apex, in mm. Turns (tip and torque, about the
/// root's start) count as they are; a bend makes another root of it, and a shorter root goes against the expected
/// length, so these cost more. Of all roots that stand apart those are looked for whose costs have the smallest sum of
/// squares, over tip, torque, bend and length of all teeth: so neighbours share a change, and many small ones come
/// before a large one.
struct SteeringSearchOptions {
  double clearance = 0.5;            ///< mm, [0, 3]: between a root and the neighbour's root and crown
  double bend_weight = 1.5;          ///< >= 1: of a mm that a bend moves the apex
  double shorten_weight = 2;         ///< >= 1: of a mm that a root is shortened
  double largest_turn_degrees = 20;  ///< (0, 60]: tip and torque change by at most this, within `RootSteering`'s range
  double largest_bend_degrees = 30;  ///< (0, 90]: likewise
  int steps = 40;                    ///< >= 0: at most so many steps at a stretch
};

/// Throws UsageError, with a sentence, for options out of range.
void require_options_in_range(const SteeringSearchOptions& options);

/// How far down a root a triangle lies, told by how far it moves when the root is turned.
enum class RootZone : int {
  crown,   ///< as scanned
  neck,    ///< of the root, but moves less than a twentieth of what moves most
  upper,   ///< less than 35 hundredths
  middle,  ///< less than 65 hundredths
  lower,   ///< the rest
};
inline constexpr int root_zone_count = 5;

/// The zone of each triangle. All of a root that cannot be steered is neck.
std::vector<int> root_zones(const SteerableRoot& root);

/// What two teeth lack, zone by zone, where a root can do something about it. Each made with `root_zones`.
/// @param wanted  mm
/// @return mm, >= 0, per pair of zones as in `part_clearances`; 0 where neither moves
std::vector<double> missing_where_roots_move(const SolidSurface& first, const SolidSurface& second, double wanted);

struct FoundSteering {
  std::vector<RootSteering> steering;                ///< per tooth; `start`, bit for bit, of one that need not change
  std::vector<double> cost_mm;                       ///< per tooth: root of the sum of the squares of its costs
  std::map<ToothPair, std::vector<double>> missing;  ///< mm, per pair of zones, of pairs that still lack something
  std::vector<bool> at_limit;                        ///< per tooth: some change is as large as it may be
};

/// The least change of roots by which all clearances of roots reach what is wanted, where roots move; what lies at the
/// necks stays nearly where it is, and may come no nearer than `clearance` or, where it is nearer now, than by 0.1 mm.
///
/// Each step moves the roots by the least change that would do if clearances changed as they do at first (with the
/// points where parts come nearest), in steps that shorten where this does not hold. Where that leaves roots in each
/// other, large turns are tried, and steps taken from the best of them. Found values are rounded to 0.01 mm and 0.01
/// degrees. The same on any number of threads.
///
/// @param extra  mm, >= 0, per pair: what its roots shall keep more than `clearance`
/// Throws UsageError for options out of range; what `vertices` throws for `start`, if it is no Error.
FoundSteering find_least_steering(const std::vector<SteerableRoot>& roots, const SteeringSearchOptions& options = {},
                                  const std::map<ToothPair, double>& extra = {});

}  // namespace rhizodont
