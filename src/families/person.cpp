// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A random effect of the person and one of the pair of teeth beside each tooth's own, as in an analysis of variance:
// their variances add up to one. Sources of the shares: person.hpp.
#include "families/person.hpp"

#include "base/option_range.hpp"
#include "base/random_stream.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

void require_in_range(const PersonVariation& persons) {
  for (const SharedVariance& shared : {persons.size, persons.root_length, persons.root_thickness, persons.wear})
    require_ranges("a person's teeth",
                   {{"of_person", shared.of_person, OptionRange::at_least(0).at_most(1)},
                    {"of_pair", shared.of_pair, OptionRange::at_least(0).at_most(1 - shared.of_person)}});
  require_ranges("a person's teeth", {{"age_of_wear", persons.age_of_wear, share_range},
                                      {"youngest", persons.youngest, OptionRange::at_least(0)},
                                      {"oldest", persons.oldest, OptionRange::above(persons.youngest)},
                                      {"mature_years", persons.mature_years, OptionRange::at_least(0)}});
}

double mixed(const SharedVariance& shared, double of_person, double of_pair, double own) {
  return std::sqrt(shared.of_person) * of_person + std::sqrt(shared.of_pair) * of_pair +
         std::sqrt(std::max(0.0, 1 - shared.of_person - shared.of_pair)) * own;
}

/// The standard normal number that a share `rank` of all lies below; by halving.
double normal_of_rank(double rank) {
  double low = -6, high = 6;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::numbers::sqrt2) < rank ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Of immature teeth among all, those of the young, so that on the whole there are as many as elsewhere.
double immature_share(const PersonDraw& person, const PersonVariation& persons, int type, double share) {
  constexpr double third_molars_later = 5;
  const double until = persons.mature_years + (type % 8 == 7 ? third_molars_later : 0);
  const double young = std::clamp((until - persons.youngest) / (persons.oldest - persons.youngest), 0.0, 1.0);
  return person.age_years(persons) < until ? std::min(1.0, share / young) : 0.0;
}

/// Streams of one person's seed; a person's own is 0, and those of the types follow.
constexpr std::uint64_t person_stream = 0x70e50, tooth_stream = 0x70e51;

SharedDraws draws_of(int fdi, const PersonDraw& person, const PersonVariation& persons) {
  const auto pair = static_cast<std::size_t>(tooth_type_of_fdi(fdi));
  RandomStream own(person.seed, tooth_stream + static_cast<std::uint64_t>(fdi));
  SharedDraws shared;
  shared.size = mixed(persons.size, person.size, person.pair_size[pair], own.normal());
  shared.root_length = mixed(persons.root_length, person.root_length, person.pair_root_length[pair], own.normal());
  shared.root_thickness =
      mixed(persons.root_thickness, person.root_thickness, person.pair_root_thickness[pair], own.normal());
  const double of_age = std::sqrt(persons.age_of_wear) * normal_of_rank(person.age_rank) +
                        std::sqrt(1 - persons.age_of_wear) * person.wear;
  shared.wear = mixed(persons.wear, of_age, person.pair_wear[pair], own.normal());
  return shared;
}

}  // namespace

PersonDraw draw_person(std::uint64_t seed) {
  RandomStream random(seed, person_stream);
  PersonDraw person;
  person.seed = seed;
  person.size = random.normal();
  person.root_length = random.normal();
  person.root_thickness = random.normal();
  person.wear = random.normal();
  person.age_rank = random.uniform();
  for (auto* of_pairs : {&person.pair_size, &person.pair_root_length, &person.pair_root_thickness, &person.pair_wear})
    for (double& z : *of_pairs) z = random.normal();
  return person;
}

double PersonDraw::age_years(const PersonVariation& persons) const {
  return persons.youngest + age_rank * (persons.oldest - persons.youngest);
}

SyntheticTooth generate_tooth_of_person(const ToothFamilies& families, int fdi, const PersonDraw& person,
                                        const ToothVariation& variation, const PersonVariation& persons) {
  require_in_range(persons);
  const int type = tooth_type_of_fdi(fdi);
  ToothVariation of_person = variation;
  of_person.open_apex_share = immature_share(person, persons, type, variation.open_apex_share);
  const SharedDraws shared = draws_of(fdi, person, persons),
                    of_fellow = draws_of(fdi_of_type(type, !is_right_side(fdi)), person, persons);
  for (int draw = 0; draw < most_tooth_draws; ++draw) {
    auto tooth = draw_tooth(families, type, person.seed, draw, of_person, shared);
    if (tooth && draw_tooth(families, type, person.seed, draw, of_person, of_fellow)) return std::move(*tooth);
  }
  throw NoResultError(fmt::format("No sound tooth {} and fellow came out of {} draws.", fdi, most_tooth_draws));
}

}  // namespace rhizodont
