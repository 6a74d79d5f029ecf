// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// Per vertex the lowest one with the same coordinates (-0 = +0). Precondition: finite coordinates.
std::vector<int> first_at_place(const std::vector<Point>& points);

}  // namespace rhizodont
