// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "segment/arch_model.hpp"
#include "segment/tooth_instances.hpp"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace rhizodont {

/// FDI number of a place along the arch, 0 at the last tooth on the side of -x, in the frame of a reading.
int fdi_of_place(int place, Jaw jaw);
/// And back. Precondition: a permanent tooth.
int place_of_fdi(int fdi);

/// What numbers are weighed by, in units of the logarithm of a probability.
struct NumberingOptions {
  double network_trust = 0.9;   ///< 0..1: share of what the network says of a tooth that is believed
  double missing = 2.2;         ///< cost of each tooth that lacks between two others
  double missing_at_end = 0.7;  ///< of each that lacks behind the last one, wisdom teeth apart
  /// 0..1, together below 1: shares of jaws whose first or second premolars were taken out on both sides. Ours: about
  /// half of what the generated arches are drawn with, which were to have many.
  double first_premolars_out = 0.06, second_premolars_out = 0.015;
  double closed = 0.5;               ///< (0, 1): share of gaps whose sides have come together; ours
  double wisdom = 1.5;               ///< of each wisdom tooth that is there
  double distance_mm = 1.0;          ///< deviation of the distance between two teeth from what the arch model says
  double distance_share = 0.12;      ///< and that part which grows with the distance
  double most_off = 4.5;             ///< what a distance can cost at most: gaps close and open
  double no_tooth = 2.0;             ///< cost of taking what was found for no tooth
  double no_tooth_point = 0.08;      ///< more of it for each point that it has
  std::set<int> missing_teeth;       ///< FDI numbers that nobody has
  std::map<std::size_t, int> given;  ///< numbers of teeth that a person has said, by their place in the list
};

/// A tooth's number, and what else it might be.
struct ToothNumber {
  std::optional<int> fdi;  ///< nothing: it is no tooth
  double probability = 0;
  std::optional<int> second;  ///< the next likely reading; nothing: that it is no tooth
  double second_probability = 0;
};

/// A reading of one jaw.
struct ArchNumbers {
  std::vector<ToothNumber> teeth;  ///< as those given
  double evidence = 0;             ///< logarithm, up to a constant that is the same for both jaws
};

/// Numbers for the teeth of one jaw: each in its order along the arch, no number twice, whatever lacks between them.
/// Orthodontists take premolars out in pairs, which is far likelier than two teeth lacking by chance: that none were,
/// and that the first or the second ones were, are supposed in turn. The most likely reading under any of the three, by
/// dynamic programming; probabilities are sums over all readings under all of them, so that another number than the one
/// that was chosen may have a larger one. Which tooth comes after which is by the angle around the arch's middle.
/// Throws UsageError where a person's numbers contradict each other or are of another jaw.
ArchNumbers number_teeth(const std::vector<ToothInstance>& teeth, Jaw jaw, const ArchModel& model,
                         const NumberingOptions& options = {});

}  // namespace rhizodont
