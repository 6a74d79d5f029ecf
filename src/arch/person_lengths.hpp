// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>

namespace rhizodont {

/// What is expected of a root's length before and after others are measured.
struct LengthExpectation {
  double mm = 0;            ///< > 0
  double deviation_mm = 0;  ///< > 0: standard deviation of what the truth differs by
};

/// How far the errors of expected root lengths go together within one person, as correlations.
struct PersonLengthModel {
  /// [0, 1): of a tooth and its fellow on the other side. On 672 crowns of 24 generated people 0.79 to 0.82
  /// (`bench_people`), where lengths of fellows share 0.8 of their variance (families/person.hpp).
  double fellow = 0.8;
  /// [0, fellow]: of any other two teeth. On the same crowns 0.10 to 0.12, where lengths share 0.4: the crown tells a
  /// part of what teeth share, and resorption, wear and cuts are each tooth's own. A little more, for real people's
  /// mean errors spread wider than those of generated ones.
  double others = 0.15;
  double measurement_mm = 0.3;  ///< > 0: standard deviation of a length measured on an X-ray
};

/// Conditional means and deviations of all teeth's lengths, given some that were measured: a Gaussian with the
/// expectations' deviations and the model's correlations. Teeth measured get the measured length itself. Keys are FDI
/// numbers. Without a measured tooth nothing changes. Throws UsageError for a measured tooth without expectation.
std::map<int, LengthExpectation> given_measured(const std::map<int, LengthExpectation>& expected,
                                                const std::map<int, double>& measured_mm,
                                                const PersonLengthModel& model = {});

}  // namespace rhizodont
