// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

/// What of a variance among teeth is the person's, and what in addition the pair's, a tooth's and its fellow's on the
/// other side; the rest is the tooth's own. 0..1, together at most 1.
struct SharedVariance {
  double of_person = 0, of_pair = 0;
};

/// Of root lengths, beside what goes with the crown's size: what generated people share (families/person.hpp), and what
/// one measured root says of others (arch/person_lengths.hpp). Lengths of 14 types go together, their first principal
/// component being overall length (n = 181, PMC8191938); left and right are alike (Choi et al. 2017). No correlations
/// are published: between 0.44, that of sizes of first incisors of both jaws (Chen et al. 2023), and 0.63, the first
/// component's part of what crown diameters of 2,650 people share (Harris and Bailit 1988); and with the pair 0.8, a
/// little less than sizes of left and right first molars, 0.87.
inline constexpr SharedVariance shared_root_length{0.5, 0.3};

}  // namespace rhizodont
