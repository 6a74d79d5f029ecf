// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Roots brought apart by the least change.
#pragma once

#include "arch/clearance.hpp"
#include "arch/press_apart.hpp"
#include "arch/steerable_root.hpp"
#include "arch/steering_search.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/root_steering.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace rhizodont {

/// A whole tooth as it is handed on.
struct SourcedTooth {
  TriangleMesh mesh;                 ///< mm; a closed solid
  std::vector<VertexSource> source;  ///< per vertex
  /// So many vertices and triangles, the first ones, are as scanned and never move. If 0 the tooth is pressed nowhere.
  int scanned_vertices = 0, scanned_triangles = 0;
  /// New vertices above this height along `up` close the crown and count as its; with no direction none do.
  double root_begins = 0;  ///< mm
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
};

/// Makes tooth `number` anew with the root so steered. May throw an Error where that gives no tooth: it then keeps the
/// steering that it was last made with. Called for one tooth at a time, in the order of their numbers.
using FinishTooth = std::function<SourcedTooth(std::size_t number, const RootSteering& steering)>;

struct ResolveOptions {
  SteeringSearchOptions search;
  int rounds = 4;  ///< >= 1: at most so often teeth are made with what the search on trial teeth has found
  PressOptions press;
};

/// Why roots stay nearer to each other than asked for.
enum class CollisionCause {
  necks,              ///< they are as near where they leave the crowns, which never move
  at_limit,           ///< they would have to be turned, bent or shortened more than they may
  out_of_proportion,  ///< where they are near, turning and bending hardly move them, so that little was done
};

/// Two teeth whose roots, or a root and a crown, stay nearer than asked for.
struct UnresolvedCollision {
  std::size_t first, second;  ///< numbers of the teeth, first < second
  double clearance_mm;        ///< the smallest in which a root has a part; negative in each other
  CollisionCause cause;
  std::string sentence;  ///< for a technician
};

struct ResolvedCollisions {
  std::vector<RootSteering> steering;  ///< per tooth; `start`, bit for bit, of one that was not changed
  std::vector<SourcedTooth> teeth;     ///< so steered and pressed; as given where nothing was changed
  std::vector<double> cost_mm;         ///< per tooth: `FoundSteering::cost_mm`
  std::vector<double> pressed_mm;      ///< per tooth: `PressedTeeth::largest_mm`
  std::vector<UnresolvedCollision> unresolved;
  std::vector<std::string> notes;  ///< sentences on teeth that could not be made as wished
};

/// Steers roots so that each keeps `options.search.clearance` from the roots and crowns of other teeth, by the least
/// change (`SteeringSearchOptions`); crowns never move, and teeth that stand apart stay as they are. New surfaces that
/// lie in each other are pressed apart (`press_apart`), before a change is looked for and whenever teeth are made anew.
/// The change is searched on trial teeth; those concerned are made with it and measured, and what they lack is asked
/// for in addition the next time. Of all rounds the one is taken that lacks least.
///
/// @param roots   of all teeth, for trials
/// @param teeth   the same teeth as they are now, made with `start`
/// @param finish  makes a tooth anew
/// Throws UsageError for options out of range or numbers of teeth that differ; InputError for a tooth that is no closed
/// solid, also one that `finish` has made.
ResolvedCollisions resolve_collisions(const std::vector<SteerableRoot>& roots, const std::vector<SourcedTooth>& teeth,
                                      const FinishTooth& finish, const ResolveOptions& options = {});

}  // namespace rhizodont
