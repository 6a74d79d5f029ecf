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
  /// [0, 1): of a tooth and its fellow on the other side. Left and right crowns' sizes correlate by 0.84 to 0.87 (Chen
  /// et al. 2023, arch covariances); what crowns tell of their roots is in the expectation already.
  double fellow = 0.8;
  /// [0, fellow]: of any other two teeth. The first principal component of 14 types' root lengths is overall length
  /// (n = 181, PMC8191938); sizes of first incisors of both jaws correlate by 0.44 (Chen et al. 2023).
  double others = 0.4;
  double measurement_mm = 0.3;  ///< > 0: standard deviation of a length measured on an X-ray
};

/// Conditional means and deviations of all teeth's lengths, given some that were measured: a Gaussian with the
/// expectations' deviations and the model's correlations. Teeth measured get the measured length itself. Keys are FDI
/// numbers. Without a measured tooth nothing changes. Throws UsageError for a measured tooth without expectation.
std::map<int, LengthExpectation> given_measured(const std::map<int, LengthExpectation>& expected,
                                                const std::map<int, double>& measured_mm,
                                                const PersonLengthModel& model = {});

}  // namespace rhizodont
