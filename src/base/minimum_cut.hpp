// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace rhizodont {

/// What it costs to put two neighbouring nodes on different sides.
struct CutEdge {
  int a = 0;
  int b = 0;
  double cost = 0;  ///< >= 0
};

/// Divides nodes into two sides at the least total cost: node i costs `cost_true[i]` on the true side and
/// `cost_false[i]` on the other, a cut edge its cost. All costs >= 0. Of several minima the one with the smallest true
/// side is returned. Source: Y. Boykov and V. Kolmogorov, 2004.
std::vector<bool> minimum_cut(const std::vector<double>& cost_true, const std::vector<double>& cost_false,
                              const std::vector<CutEdge>& edges);

}  // namespace rhizodont
