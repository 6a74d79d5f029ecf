// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"

#include <array>
#include <cstdint>

// Teeth of one person: they share how large, how long-rooted, how thick and how worn they are.
namespace rhizodont {

/// What of the variance of generated teeth is the person's, and what in addition the pair's, a tooth's and its fellow's
/// on the other side; the rest is the tooth's own. 0..1, together at most 1.
struct SharedVariance {
  double of_person = 0, of_pair = 0;
};

struct PersonVariation {
  /// Sizes of first incisors of both jaws correlate by 0.44, of left and right first molars by 0.87 (Chen et al. 2023).
  SharedVariance size{0.44, 0.43};
  /// Lengths of 14 types go together, their first principal component being overall length (n = 181, PMC8191938); left
  /// and right are alike (Choi et al. 2017). No correlations are published: those of sizes, rounded down.
  SharedVariance root_length{0.4, 0.4};
  /// As lengths, for want of anything published.
  SharedVariance root_thickness{0.4, 0.4};
  /// 0..1: of worn people's teeth are worn, who are as many as ToothVariation::wear_share says; a tenth of others'.
  double worn_share = 0.9;
};

/// A person, as standard normal numbers. Nothing in it depends on which of the teeth are made.
struct PersonDraw {
  std::uint64_t seed = 0;
  double size = 0, root_length = 0, root_thickness = 0;
  std::array<double, tooth_type_count> pair_size{}, pair_root_length{}, pair_root_thickness{};
  double wear = 0;  ///< 0..1, rank among people by wear: 1 most worn
};

/// Draws person number `seed`.
PersonDraw draw_person(std::uint64_t seed);

/// A permanent tooth (FDI number) of a person, in the frame of FamilyTemplate, right teeth as their left fellows: of
/// the same form, template and marks as the tooth on the other side, but for what is its own of size, length and
/// thickness. Throws as generate_tooth, and UsageError for shares out of range.
SyntheticTooth generate_tooth_of_person(const ToothFamilies& families, int fdi, const PersonDraw& person,
                                        const ToothVariation& variation = {}, const PersonVariation& persons = {});

}  // namespace rhizodont
