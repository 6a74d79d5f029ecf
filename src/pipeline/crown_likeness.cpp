// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "pipeline/crown_likeness.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace rhizodont {
namespace {

std::string percent(double share) {
  if (share > 0 && share < 0.01) return "under 1 %";
  return fmt::format("{:.0f} %", 100 * share);
}

std::size_t place_of(int fdi) {
  return 2 * static_cast<std::size_t>(tooth_type_of_fdi(fdi)) + (is_right_side(fdi) ? 1 : 0);
}

}  // namespace

CrownLikeness judge_crown(const TriangleMesh& crown, std::optional<int> fdi, const Atlas& atlas,
                          const LikenessModel& model) {
  const std::vector<ToothTraits> traits =
      crown_traits(crown, atlas, fdi ? std::optional(place_of(*fdi)) : std::nullopt);
  const Likeness judged = likeness(traits, model);
  std::vector<std::size_t> order(traits.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return judged.probability[a] > judged.probability[b]; });
  const auto tooth = [&](std::size_t i) {
    return ToothLikeness{fdi_of_type(static_cast<int>(traits[i].tooth / 2), traits[i].tooth % 2 == 1),
                         judged.probability[i], traits[i].traits.distance_mm};
  };
  const std::size_t said = fdi ? 0 : order.front();  // a tooth that was asked for comes first
  CrownLikeness result;
  result.said = tooth(said);
  std::size_t next = 0;
  for (const std::size_t i : order)
    if (i != said && next < result.next.size()) result.next[next++] = tooth(i);
  result.seen = traits[said].traits.seen;
  result.explained = traits[said].traits.explained;
  result.strangeness = judged.strangeness[said] / model.strange_bound;

  const auto least_strange = std::min_element(judged.strangeness.begin(), judged.strangeness.end());
  if (*least_strange > model.refused_bound) {
    const ToothLikeness nearest = tooth(static_cast<std::size_t>(least_strange - judged.strangeness.begin()));
    std::string sentence = "This does not look like any tooth";
    if (fdi)
      sentence = fmt::format(
          "This does not look like a {} ({:.1f} mm from that tooth's mean crown, {} of which it covers), nor like any "
          "other tooth",
          *fdi, result.said.distance_mm, percent(result.seen));
    throw InputError(
        fmt::format("{}; the nearest is a {} ({:.1f} mm from its mean crown). A root can be predicted for a whole "
                    "crown that is not "
                    "prepared.",
                    sentence, nearest.fdi, nearest.distance_mm));
  }
  if (judged.type_lead[said] > model.type_bound || judged.side_lead[said] > model.side_bound)
    result.verdict = LikenessVerdict::other_tooth;
  else if (result.strangeness > 1)
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
