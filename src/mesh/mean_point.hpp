// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <vector>

namespace rhizodont {

/// The sum of the points over their number. Precondition: there are some.
Point mean_point(const std::vector<Point>& points);

}  // namespace rhizodont
