// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/repair_step.hpp"

#include "mesh/seams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rhizodont {
namespace {

/// In the order of RepairAction.
constexpr std::array<std::string_view, 15> texts{"other",
                                                 "vertex merged with another one at the same place",
                                                 "inward copy of a triangle dropped (double-sided)",
                                                 "triangle dropped: without area, or there twice",
                                                 "merged across a seam",
                                                 "triangle cut at vertices on its edge (T-junction)",
                                                 "dropped at an edge with more than two triangles",
                                                 "speck dropped",
                                                 "separate piece dropped",
                                                 "triangle turned over",
                                                 "dropped where the surface touches itself",
                                                 "spike dropped",
                                                 "tunnel cut along its shortest loop",
                                                 "dropped where the surface cuts itself",
                                                 "cap between vertices of the crown's border dropped"};
static_assert(texts.size() == static_cast<std::size_t>(RepairAction::cap_at_border_dropped) + 1);

}  // namespace

std::string action_text(const RepairStep& step) {
  const std::string_view text = texts[static_cast<std::size_t>(step.action)];
  if (step.action != RepairAction::seam_merged) return std::string(text);
  return fmt::format("{}, the farthest {} apart", text, seam_width_in_words(step.widest_seam_mm));
}

RepairAction action_of_text(std::string_view text) {
  constexpr auto seam = texts[static_cast<std::size_t>(RepairAction::seam_merged)];
  if (text.starts_with(seam)) return RepairAction::seam_merged;
  const auto found = std::find(texts.begin() + 1, texts.end(), text);
  return found == texts.end() ? RepairAction::other : static_cast<RepairAction>(found - texts.begin());
}

}  // namespace rhizodont
