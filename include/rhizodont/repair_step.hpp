// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace rhizodont {

/// One repair of a crown: what was done, and to which vertices and triangles of the input.
struct RepairStep {
  std::string action;                 ///< such as "merged with another vertex at the same place"
  std::vector<int> vertices;          ///< that are no longer there, ascending
  std::vector<int> triangles;         ///< that are no longer there as they were although their corners are, ascending
  std::vector<int> merged_into = {};  ///< of a seam: per entry of `vertices` the one that stands in its place
};

}  // namespace rhizodont
