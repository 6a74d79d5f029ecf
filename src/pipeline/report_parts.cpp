// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/report_parts.hpp"

namespace rhizodont {

std::vector<int> vertices_not_of_tooth(const CompletionRecord& record) {
  std::vector<int> vertices;
  for (const DroppedCrownVertex& dropped : record.crown.dropped_vertices)
    if (dropped.reason != DropReason::repair) vertices.push_back(dropped.vertex);
  return vertices;
}

}  // namespace rhizodont
