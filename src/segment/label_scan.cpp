// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/label_scan.hpp"

#include "rhizodont/error.hpp"
#include "segment/numbering.hpp"
#include "segment/pieces_of_jaws.hpp"
#include "segment/tooth_borders.hpp"
#include "segment/tooth_instances.hpp"
#include "teeth/clean_labels.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// What is measured of the jaw beside what the network says.
struct JawDecision {
  Jaw jaw = Jaw::lower;
  double confidence = 0;
  std::string reason;
  ArchNumbers numbers;
};

double log_odds(double p) {
  const double q = std::clamp(p, 1e-4, 1 - 1e-4);
  return std::log(q / (1 - q));
}

/// How much larger central incisors are than lateral ones, by the surface that is seen of them; nothing where there is
/// not one of each on one side.
std::optional<double> central_over_lateral(const ToothInstances& found, const ArchNumbers& as_upper) {
  double sum = 0;
  int sides = 0;
  for (const int quadrant : {10, 20}) {
    double central = 0, lateral = 0;
    for (std::size_t t = 0; t < found.teeth.size(); ++t) {
      if (as_upper.teeth[t].fdi == quadrant + 1) central = found.teeth[t].support;
      if (as_upper.teeth[t].fdi == quadrant + 2) lateral = found.teeth[t].support;
    }
    if (!(central > 0 && lateral > 0)) continue;
    sum += std::log(central / lateral);
    ++sides;
  }
  return sides == 0 ? std::nullopt : std::optional(std::exp(sum / sides));
}

/// Logarithm of the odds that incisors are upper ones: there the central ones are about 1.4 times as large as the
/// lateral ones, in lower jaws 0.9 times.
double odds_by_incisors(double ratio) {
  constexpr double upper_ratio = 1.4, lower_ratio = 0.9, deviation = 0.2, most = 3;
  const double off_upper = std::log(ratio / upper_ratio), off_lower = std::log(ratio / lower_ratio);
  return std::clamp((off_lower * off_lower - off_upper * off_upper) / (2 * deviation * deviation), -most, most);
}

JawDecision decide_jaw(const TeethReading& reading, const ToothInstances& found, const ArchModel& arch,
                       const SegmentOptions& options, const NumberingOptions& numbering) {
  JawDecision decision;
  if (options.jaw) {
    decision.jaw = *options.jaw;
    decision.confidence = 1;
    decision.reason = fmt::format("The {} jaw, as was said.", jaw_name(decision.jaw));
    decision.numbers = number_teeth(found.teeth, decision.jaw, arch, numbering);
    const JawDecision own = decide_jaw(reading, found, arch, {}, {});
    constexpr double sure = 0.9;
    if (own.jaw != decision.jaw && own.confidence > sure)
      decision.reason += fmt::format(" By itself it would be taken for the {} one ({:.0f} %): is that right?",
                                     jaw_name(own.jaw), 100 * own.confidence);
    return decision;
  }
  // What a person says of teeth is of the jaw that they are in.
  std::set<int> named = options.missing;
  for (const auto& [tooth, fdi] : numbering.given) named.insert(fdi);
  if (!named.empty() && jaw_of_fdi(*named.begin()) == jaw_of_fdi(*named.rbegin())) {
    SegmentOptions stated = options;
    stated.jaw = jaw_of_fdi(*named.begin());
    decision = decide_jaw(reading, found, arch, stated, numbering);
    decision.reason = fmt::format("Tooth {} was said to be there or missing. {}", *named.begin(), decision.reason);
    return decision;
  }
  ArchNumbers upper = number_teeth(found.teeth, Jaw::upper, arch, numbering);
  ArchNumbers lower = number_teeth(found.teeth, Jaw::lower, arch, numbering);
  constexpr double distance_trust = 0.5;  // distances between neighbours are not independent
  constexpr double most_by_network = 3;   // it has seen generated scans alone
  const double by_network =
      std::clamp(log_odds(static_cast<double>(reading.said.upper)), -most_by_network, most_by_network);
  const double by_distances = distance_trust * (upper.evidence - lower.evidence);
  const std::optional<double> ratio = central_over_lateral(found, upper);
  const double by_incisors = ratio ? odds_by_incisors(*ratio) : 0;
  const double odds = by_network + by_distances + by_incisors;
  decision.jaw = odds > 0 ? Jaw::upper : Jaw::lower;
  decision.confidence = 1 / (1 + std::exp(-std::abs(odds)));
  const double sign = odds > 0 ? 1 : -1;
  const auto word = [&](double part) {
    return sign * part > 0.2 ? "for" : sign * part < -0.2 ? "against" : "neither for nor against";
  };
  decision.reason = fmt::format(
      "The {} jaw ({:.0f} %): its form as the network sees it speaks {} it, the distances between its teeth {} it",
      jaw_name(decision.jaw), 100 * decision.confidence, word(by_network), word(by_distances));
  decision.reason += ratio ? fmt::format(", its central incisors, {:.2f} times as large as the lateral ones, {} it.",
                                         *ratio, word(by_incisors))
                           : ".";
  decision.numbers = odds > 0 ? std::move(upper) : std::move(lower);
  return decision;
}

/// The tooth that each click means.
std::map<std::size_t, int> clicked_teeth(const TeethReading& reading, const ToothInstances& found,
                                         const std::vector<std::pair<int, Eigen::Vector3d>>& clicks) {
  std::map<std::size_t, int> given;
  for (const auto& [fdi, click] : clicks) {
    std::vector<double> scores(found.teeth.size(), 0);
    for (std::size_t i = 0; i < reading.size(); ++i) {
      const double near = std::exp(-(reading.place(i) - click).squaredNorm() / 2);
      if (near < 1e-3) continue;
      for (std::size_t t = 0; t < found.teeth.size(); ++t) scores[t] += near * found.share(i, t);
    }
    const auto best = std::max_element(scores.begin(), scores.end());
    if (best == scores.end() || !(*best > 0))
      throw InputError(fmt::format("There is no surface where tooth {} should be.", fdi));
    const auto tooth = static_cast<std::size_t>(best - scores.begin());
    const auto [entry, fresh] = given.emplace(tooth, fdi);
    if (!fresh) throw InputError(fmt::format("The places of teeth {} and {} are on one tooth.", entry->second, fdi));
  }
  return given;
}

/// Without what was found to be no tooth.
ToothInstances numbered_only(const ToothInstances& found, const ArchNumbers& numbers, std::size_t points,
                             std::vector<ToothNumber>& kept) {
  ToothInstances result;
  std::vector<std::size_t> chosen;
  for (std::size_t t = 0; t < found.teeth.size(); ++t)
    if (numbers.teeth[t].fdi) {
      chosen.push_back(t);
      result.teeth.push_back(found.teeth[t]);
      kept.push_back(numbers.teeth[t]);
    }
  for (std::size_t i = 0; i < points; ++i)
    for (const std::size_t t : chosen) result.shares.push_back(found.share(i, t));
  return result;
}

constexpr std::size_t least_teeth = 3;

void require_arch(const std::vector<ToothNumber>& teeth, bool a_person_knows) {
  constexpr const char* what_else =
      "A single crown goes to complete; a scan whose triangles face inwards is to be turned inside out first.";
  if (teeth.empty())
    throw InputError(fmt::format("No tooth was found: this is no scan of an arch of teeth. {}", what_else));
  if (teeth.size() < least_teeth)
    throw InputError(fmt::format("Only {} {} found: this is no scan of an arch of teeth. {}", teeth.size(),
                                 teeth.size() == 1 ? "tooth was" : "teeth were", what_else));
  // A surface of knobs has some teeth, too, but no numbers: those of generated arches, parts and few teeth among them,
  // are sure to 70 % and more in the mean.
  constexpr double least_sure = 0.4;
  double sure = 0;
  for (const ToothNumber& tooth : teeth) sure += tooth.probability / static_cast<double>(teeth.size());
  if (sure < least_sure && !a_person_knows)
    throw InputError(fmt::format(
        "{} shapes like teeth were found, but not in the order of an arch (their numbers are sure to {:.0f} % in the "
        "mean): this is no scan of an arch of teeth. If it is, say what you know of it (--jaw, --missing, --tooth).",
        teeth.size(), 100 * sure));
}

void describe_teeth(const TriangleMesh& scan, const std::vector<ToothNumber>& numbers, double millimetres_per_unit,
                    SegmentedScan& result) {
  for (const ToothNumber& number : numbers) {
    FoundTooth tooth;
    tooth.fdi = *number.fdi;
    tooth.confidence = number.probability;
    tooth.second = number.second;
    tooth.second_confidence = number.second_probability;
    for (std::size_t v = 0; v < scan.vertices.size(); ++v)
      if (result.fdi[v] == tooth.fdi) {
        tooth.middle += scan.vertices[v];
        ++tooth.vertices;
      }
    if (tooth.vertices == 0) continue;
    tooth.middle /= millimetres_per_unit * static_cast<double>(tooth.vertices);
    constexpr double sure = 0.8;
    if (tooth.confidence < sure)
      result.notes.push_back(tooth.second
                                 ? fmt::format("Tooth {} may be {} ({:.0f} % against {:.0f} %).", tooth.fdi,
                                               *tooth.second, 100 * tooth.confidence, 100 * tooth.second_confidence)
                                 : fmt::format("Tooth {} is doubtful ({:.0f} %).", tooth.fdi, 100 * tooth.confidence));
    result.teeth.push_back(tooth);
  }
  std::sort(result.teeth.begin(), result.teeth.end(), [](const auto& a, const auto& b) { return a.fdi < b.fdi; });
}

}  // namespace

SegmentedScan label_scan(const TriangleMesh& scan, const TeethReading& reading, const ArchModel& arch,
                         const SegmentOptions& options) {
  InstanceOptions instances;
  std::vector<std::pair<int, Eigen::Vector3d>> clicks;
  for (const auto& [fdi, place] : options.teeth) {
    clicks.emplace_back(fdi, reading.frame.rotation * (options.millimetres_per_unit * place - reading.frame.origin));
    instances.clicks.push_back(clicks.back().second);
  }
  const ToothInstances found = find_instances(reading, instances);
  NumberingOptions numbering;
  numbering.missing_teeth = options.missing;
  numbering.given = clicked_teeth(reading, found, clicks);
  const JawDecision decision = decide_jaw(reading, found, arch, options, numbering);

  SegmentedScan result;
  result.jaw = decision.jaw;
  result.jaw_confidence = decision.confidence;
  result.jaw_reason = decision.reason;
  std::vector<ToothNumber> numbers;
  const ToothInstances teeth = numbered_only(found, decision.numbers, reading.size(), numbers);
  require_arch(numbers, !options.teeth.empty());
  std::vector<int> labels = draw_borders(scan, reading, teeth);
  keep_largest_pieces(scan, labels);
  for (const int label : labels) result.fdi.push_back(label < 0 ? 0 : *numbers[static_cast<std::size_t>(label)].fdi);
  result.fdi = clean_labels(scan, result.fdi).fdi;
  describe_teeth(scan, numbers, options.millimetres_per_unit, result);
  constexpr double sure_jaw = 0.9;
  if (decision.confidence < sure_jaw) result.notes.push_back("Which jaw this is, is doubtful: --jaw settles it.");
  if (auto sentence = which_jaw_was_read(scan, result.fdi, options.millimetres_per_unit))
    result.notes.push_back(std::move(*sentence));
  return result;
}

}  // namespace rhizodont
