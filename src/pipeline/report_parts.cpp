// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/report_parts.hpp"

#include <algorithm>

namespace rhizodont {

std::vector<int> vertices_not_of_tooth(const CompletionRecord& record) {
  std::vector<int> vertices;
  for (const DroppedCrownVertex& dropped : record.crown.dropped_vertices)
    if (std::none_of(record.repairs.begin(), record.repairs.end(),
                     [&](const RepairStep& step) { return step.action == dropped.reason; }))
      vertices.push_back(dropped.vertex);
  return vertices;
}

}  // namespace rhizodont
