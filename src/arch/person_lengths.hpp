// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "teeth/person_shares.hpp"

#include <map>

namespace rhizodont {

/// What is expected of a root's length before and after others are measured.
struct LengthExpectation {
  double mm = 0;            ///< > 0
  double deviation_mm = 0;  ///< > 0: standard deviation of what the truth differs by
};

/// How far the errors of expected root lengths go together within one person, as correlations.
struct PersonLengthModel {
  /// [0, 1): of a tooth and its fellow on the other side: a part of what these share of their lengths. On 672 crowns of
  /// 24 generated people it was 0.59 (`bench_people`) where lengths of fellows shared 0.8 of their variance: how crowns
  /// are cut, and resorption and wear, are each tooth's own.
  double fellow = 0.75 * (shared_root_length.of_person + shared_root_length.of_pair);
  /// [0, fellow]: of any other two teeth. On the same crowns 0.20 where lengths shared 0.5, for the crown tells a part
  /// of what teeth share.
  double others = 0.4 * shared_root_length.of_person;
  double measurement_mm = 0.3;  ///< > 0: standard deviation of a length measured on an X-ray
};

/// Conditional means and deviations of all teeth's lengths, given some that were measured: a Gaussian with the
/// expectations' deviations and the model's correlations. Teeth measured get the measured length itself. Keys are FDI
/// numbers. Without a measured tooth nothing changes. Throws UsageError for a measured tooth without expectation.
std::map<int, LengthExpectation> given_measured(const std::map<int, LengthExpectation>& expected,
                                                const std::map<int, double>& measured_mm,
                                                const PersonLengthModel& model = {});

}  // namespace rhizodont
