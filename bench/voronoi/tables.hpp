// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/bench_teeth.hpp"

namespace rhizodont {

/// Time of the restricted Voronoi diagram with its dual by sites and facets, on the guiding surface of one tooth.
void print_diagram_times(const BenchTooth& tooth);

}  // namespace rhizodont
