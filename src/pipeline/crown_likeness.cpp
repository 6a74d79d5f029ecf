// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/crown_likeness.hpp"

#include "completion/mean_crown_agreement.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace rhizodont {
namespace {

constexpr double least_seen = 0.2;  // of a likely tooth's mean crown: less is no crown to predict a root from

std::string percent(double share) {
  if (share > 0 && share < 0.01) return "under 1 %";
  return fmt::format("{:.0f} %", 100 * share);
}

std::string refusal(const CrownLikeness& likeness, bool given) {
  const ToothLikeness& said = likeness.said;
  const ToothLikeness& next = likeness.next[0];
  std::string sentence = given ? fmt::format("This does not look like a {}, nor like any other tooth", said.fdi)
                               : "This does not look like any tooth";
  sentence += fmt::format(" ({:.1f} mm from the mean crown of a {}, {} of which it covers", said.distance_mm, said.fdi,
                          percent(likeness.seen));
  if (next.distance_mm < said.distance_mm)
    sentence += fmt::format("; {:.1f} mm from that of a {}", next.distance_mm, next.fdi);
  return sentence + "). A root can be predicted for one whole crown that is not prepared.";
}

}  // namespace

CrownLikeness judge_crown(const PreparedCrown& crown, std::optional<int> fdi, const Atlas& atlas,
                          const LikenessModel& model) {
  const Likeness judged = likeness(crown.mesh, crown.growth_axis, model.classifier);
  // The tooth that it is said to be first, then the most probable ones.
  std::vector<std::size_t> teeth(tooth_count);
  std::iota(teeth.begin(), teeth.end(), std::size_t{0});
  const std::optional<std::size_t> given = fdi ? std::optional(tooth_of_fdi(*fdi)) : std::nullopt;
  std::stable_sort(teeth.begin(), teeth.end(), [&](std::size_t a, std::size_t b) {
    if ((a == given) != (b == given)) return a == given;
    return judged.log_probability[a] > judged.log_probability[b];
  });
  teeth.resize(3);
  const std::vector<MeanCrownAgreement> agreement = mean_crown_agreement(crown, atlas, teeth);
  const auto tooth = [&](std::size_t i) {
    return ToothLikeness{fdi_of_type(static_cast<int>(teeth[i] / 2), teeth[i] % 2 == 1),
                         std::exp(judged.log_probability[teeth[i]]), agreement[i].distance_mm};
  };
  CrownLikeness result;
  result.said = tooth(0);
  result.next = {tooth(1), tooth(2)};
  result.seen = agreement[0].seen;
  result.explained = agreement[0].explained;
  result.unlike_probability = 1 / (1 + std::exp(-judged.log_unlike));
  // What the network was never shown, such as a few triangles, it may take for anything.
  const bool covers_none =
      std::all_of(agreement.begin(), agreement.end(), [](const MeanCrownAgreement& a) { return a.seen < least_seen; });
  if (covers_none || judged.log_unlike > model.bounds.refused) throw InputError(refusal(result, fdi.has_value()));
  if (judged.log_unlike > model.bounds.unlike)
    result.verdict = LikenessVerdict::unlike;
  else if (judged.lead_over(teeth[0]) > model.bounds.other_tooth)
    result.verdict = LikenessVerdict::other_tooth;
  else if (result.seen < least_seen && result.explained < 0.5)  // low crowns lie on what little they show
    result.verdict = LikenessVerdict::unlike;
  return result;
}

std::optional<std::string> likeness_warning(const CrownLikeness& likeness, bool guessed) {
  const ToothLikeness& said = likeness.said;
  const auto& [next, third] = likeness.next;
  std::string sentence;
  if (guessed)
    sentence = fmt::format(
        "No FDI number was given; by its shape the crown was taken for tooth {} ({} sure; next {} with {}, {} with "
        "{}).",
        said.fdi, percent(said.probability), next.fdi, percent(next.probability), third.fdi,
        percent(third.probability));
  if (likeness.verdict == LikenessVerdict::other_tooth && !guessed)
    sentence = fmt::format(
        "The crown looks more like a {} ({}, mean distance {:.2f} mm) than like a {} ({}, {:.2f} mm): is the number "
        "right?",
        next.fdi, percent(next.probability), next.distance_mm, said.fdi, percent(said.probability), said.distance_mm);
  if (likeness.verdict == LikenessVerdict::unlike)
    sentence += fmt::format(
        "{}The crown hardly looks like a {}: it lies {:.2f} mm from that tooth's mean crown and covers {} of it. Is "
        "all "
        "of the crown there, and is it not prepared?",
        sentence.empty() ? "" : " ", said.fdi, said.distance_mm, percent(likeness.seen));
  if (sentence.empty()) return std::nullopt;
  return sentence;
}

}  // namespace rhizodont
