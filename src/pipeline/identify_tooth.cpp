// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/identify_tooth.hpp"

#include "pipeline/crown_likeness.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

namespace rhizodont {

CrownFrame lay_crown(const PreparedCrown& crown, int fdi, const std::optional<ToothDirections>& directions,
                     const CompletionModels::Content& models) {
  std::optional<CrownPose> seen;
  if (models.pose) seen = models.pose->pose_of(crown.mesh, fdi);
  return canonical_frame(crown, fdi, models.atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))], {},
                         directions, seen);
}

IdentifiedTooth identify_tooth(const PreparedCrown& crown, std::optional<int> fdi,
                               const std::optional<ToothDirections>& directions,
                               const CompletionModels::Content& models) {
  IdentifiedTooth tooth;
  tooth.guessed = !fdi;
  if (models.likeness) {
    tooth.likeness = judge_crown(crown, fdi, models.atlas, *models.likeness);
    tooth.fdi = tooth.likeness->said.fdi;
    tooth.warning = likeness_warning(*tooth.likeness, tooth.guessed);
  } else {
    tooth.fdi = fdi ? *fdi : guess_fdi_type(crown, models.atlas).fdi;
    if (tooth.guessed)
      tooth.warning = fmt::format("No FDI number was given; by its shape the crown was taken for tooth {}.", tooth.fdi);
  }
  tooth.frame = lay_crown(crown, tooth.fdi, directions, models);
  return tooth;
}

}  // namespace rhizodont
