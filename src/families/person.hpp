// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/tooth_family.hpp"
#include "teeth/person_shares.hpp"

#include <array>
#include <cstdint>

// Teeth of one person: they share how large, how long-rooted, how thick and how worn they are.
namespace rhizodont {

/// What of the variances of generated teeth people and pairs share.
struct PersonVariation {
  /// Sizes of first incisors of both jaws correlate by 0.44, of left and right first molars by 0.87 (Chen et al. 2023).
  SharedVariance size{0.44, 0.43};
  SharedVariance root_length = shared_root_length;
  /// As sizes of crowns, for want of anything published, and a little less.
  SharedVariance root_thickness{0.4, 0.4};
  /// Of wear: what is the person's, age among it, and the pair's (ours: opposing and neighbouring teeth wear together).
  SharedVariance wear{0.8, 0.1};
  double age_of_wear = 0.6;           ///< of the person's part of wear, what age tells, 0..1 (ours)
  double youngest = 12, oldest = 80;  ///< years; everyone between is as likely (ours: those who are scanned)
  double mature_years = 15;           ///< roots of younger people may be immature; third molars five years later
};

/// A person, as standard normal numbers. Nothing in it depends on which of the teeth are made.
struct PersonDraw {
  std::uint64_t seed = 0;
  double size = 0, root_length = 0, root_thickness = 0;
  double wear = 0;      ///< beside what age tells
  double age_rank = 0;  ///< 0..1 among people: 1 oldest
  std::array<double, tooth_type_count> pair_size{}, pair_root_length{}, pair_root_thickness{}, pair_wear{};

  double age_years(const PersonVariation& persons = {}) const;
};

/// Draws person number `seed`.
PersonDraw draw_person(std::uint64_t seed);

/// A permanent tooth (FDI number) of a person, in the frame of FamilyTemplate, right teeth as their left fellows: of
/// the same form, template and marks as the tooth on the other side, but for what is its own of size, length and
/// thickness and wear: a draw that is rejected on one side is on both. Immature are only the young. Throws as
/// generate_tooth, and UsageError for shares out of range.
SyntheticTooth generate_tooth_of_person(const ToothFamilies& families, int fdi, const PersonDraw& person,
                                        const ToothVariation& variation = {}, const PersonVariation& persons = {});

}  // namespace rhizodont
