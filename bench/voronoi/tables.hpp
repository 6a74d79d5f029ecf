// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/bench_teeth.hpp"

#include <filesystem>

namespace rhizodont {

/// Time of the restricted Voronoi diagram with its dual by sites and facets, on the guiding surface of one tooth.
void print_diagram_times(const BenchTooth& tooth);

/// What share of the crowns in `validation` and `crowns` the dual of the joined diagram gives, beside what the test for
/// strong-Delaunay says, with the reasons for what is missing.
void print_crown_shares(const std::filesystem::path& data_folder);

}  // namespace rhizodont
