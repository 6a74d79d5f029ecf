// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/way_out.hpp"

#include "skirt/skirt_border.hpp"

namespace rhizodont {

std::string way_out(const CompleteOptions& options, bool skirt_known,
                    const std::function<bool(const CompleteOptions&)>& would_be_taken) {
  CompleteOptions repaired = options, without_skirt = options;
  repaired.repair = true;
  without_skirt.skirt = SkirtBorderOptions().threshold;
  const bool repair_helps = !options.repair && would_be_taken(repaired);
  const bool skirt_helps = !options.skirt && skirt_known && would_be_taken(without_skirt);
  if (repair_helps && skirt_helps) return " The option --repair may help; so may --skirt auto.";
  if (repair_helps) return " The option --repair may help.";
  if (skirt_helps) return " The option --skirt auto may help.";
  return {};
}

}  // namespace rhizodont
