// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <map>
#include <string>
#include <vector>

#include "rhizodont/mesh.hpp"

namespace rhizodont {

/// By how many millimetres the network's roots of a type are to be made longer, so that half of them are too long and
/// half too short over generated people; measured after training and kept in the weight file's metadata. 0 where the
/// file says nothing of the type, and for a number that is no permanent tooth's. Throws InputError for an entry that
/// cannot be read.
double root_length_correction(const std::map<std::string, std::string>& metadata, int fdi);

/// Adds them to a weight file's metadata, by the FDI number of the type's left tooth, and takes away those that were
/// there.
void note_root_length_corrections(const std::map<int, double>& by_tooth, std::map<std::string, std::string>& metadata);

/// Stretches what lies below the crown along the growth axis, so that the lowest point comes to lie `mm` deeper; at
/// most by a quarter, and at most shortened by a fifth. Without effect on points at `level` and above.
/// @param axis   unit, from root to crown
/// @param level  of the crown's lowest place, mm along the axis
void lengthen_root(OrientedPoints& points, const Eigen::Vector3d& axis, double level, double mm);

/// How long a root was before `lengthen_root` made it `length` mm long (> 0) by being asked for `mm`.
double length_before_correction(double length, double mm);

}  // namespace rhizodont
