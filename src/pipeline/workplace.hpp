// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/registration.hpp"
#include "intake/take_crown.hpp"
#include "mesh/space_order.hpp"
#include "rhizodont/completion_record.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/tooth_directions.hpp"

#include <optional>
#include <vector>

namespace rhizodont {

/// Where and how the crown stands while the stages work on it.
struct Workplace {
  Point origin = Point::Zero();  ///< in the input's coordinates: the input's own, or one near the crown
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the input's directions to those at the workplace
  double millimetres_per_unit = 1;
  bool as_float = true;    ///< new coordinates are rounded to float, as the input's are
  bool is_far = false;     ///< the crown lies far from the input's origin
  bool reordered = false;  ///< elements come in another order than the input's
  MeshOrder order;         ///< numbers in the input of what comes one after the other at the workplace
};

/// A crown far from the origin is moved there first, by whole steps of a grid: that rounds no coordinate whose last
/// digit is a part of a step, as all floats' are that lie as far out as the crown; a double or a stray vertex nearer to
/// 0 may lose its last digit, 1e-14 mm. The stages alone work with that: the tooth has the input's own bits. A crown
/// nearby stays, so that its tooth has always the same bits.
///
/// With `directions` the crown stands by them (x to the cheek, z occlusal), its mean vertex in the origin, and its
/// elements come in `space_order`: then its tooth depends neither on the scan's pose nor on the order of its elements.
Workplace workplace(const TriangleMesh& input, double millimetres_per_unit,
                    const std::optional<ToothDirections>& directions);

/// The input as it stands at the workplace, in its own unit.
TriangleMesh at_workplace(const TriangleMesh& input, const Workplace& place);

/// The directions as they are at the workplace that was made with them.
std::optional<ToothDirections> at_workplace(const std::optional<ToothDirections>& directions, const Workplace& place);

/// What was taken of the crown at the workplace, with the input's numbers and lists of them ascending; `kept` stays in
/// the workplace's order.
void number_as_input(TakenCrown& taken, const Workplace& place);

/// The same pose in the input's coordinates.
FrameRecord in_input_coordinates(const CrownFrame& found, const Workplace& place);

/// A tooth from the workplace (mm, the kept crown's elements first, in the input's order) in the input's coordinates:
/// crown vertices are the input's own bits. @param kept  number in the input of each
TriangleMesh in_input_coordinates(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                                  const Workplace& place);

}  // namespace rhizodont
