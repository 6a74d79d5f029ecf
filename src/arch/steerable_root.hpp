// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/root_steering.hpp"

#include <functional>
#include <vector>

namespace rhizodont {

/// A tooth whose root can be tried in many places at little cost: the same triangles each time, only new vertices move.
struct SteerableRoot {
  int fdi = 0;                       ///< for sentences
  std::vector<Triangle> triangles;   ///< of the closed tooth
  std::vector<VertexSource> source;  ///< per vertex
  /// The tooth's vertices (mm) with its root so steered; those of the scan always the same, bit for bit. Called from
  /// several threads. May throw an Error for what cannot be made.
  std::function<std::vector<Point>(const RootSteering&)> vertices;
  /// mm: how long the root is that is so steered, along the growth axis from the crown's lowest point to the apex.
  /// Asked for steering without a length alone. Called from several threads.
  std::function<double(const RootSteering&)> length;
  RootSteering start;      ///< how the root stands now: what the user wishes of it
  double length_mm = 0;    ///< of the root as it stands now
  double shortest_mm = 0;  ///< it may be shortened to this; `length_mm` where its length is known
  bool may_change = true;  ///< false: others must give way
};

/// A tooth for trials, out of a finished one: `steer_root` moves its new vertices, as the stage before the joining
/// would have moved the surface that they lie on. It may be shortened down to its interval, if it has one and `start`
/// sets no length.
/// @param unsteered  finished without any steering
/// @param start      the user's wishes
/// Throws UsageError where `unsteered` is steered, or `start` out of range.
SteerableRoot steerable_root(const CompletedTooth& unsteered, const RootSteering& start = {});

}  // namespace rhizodont
