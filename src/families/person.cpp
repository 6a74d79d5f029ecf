// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A random effect of the person and one of the pair of teeth beside each tooth's own, as in an analysis of variance:
// their variances add up to one. Sources of the shares: person.hpp.
#include "families/person.hpp"

#include "base/option_range.hpp"
#include "base/random_stream.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <cmath>

namespace rhizodont {
namespace {

void require_in_range(const PersonVariation& persons) {
  for (const SharedVariance& shared : {persons.size, persons.root_length, persons.root_thickness})
    require_ranges("a person's teeth",
                   {{"of_person", shared.of_person, OptionRange::at_least(0).at_most(1)},
                    {"of_pair", shared.of_pair, OptionRange::at_least(0).at_most(1 - shared.of_person)}});
  require_ranges("a person's teeth", {{"worn_share", persons.worn_share, OptionRange::at_least(0).at_most(1)}});
}

double mixed(const SharedVariance& shared, double of_person, double of_pair, double own) {
  return std::sqrt(shared.of_person) * of_person + std::sqrt(shared.of_pair) * of_pair +
         std::sqrt(std::max(0.0, 1 - shared.of_person - shared.of_pair)) * own;
}

/// Streams of one person's seed; a person's own is 0, and those of the types follow.
constexpr std::uint64_t person_stream = 0x70e50, tooth_stream = 0x70e51;

}  // namespace

PersonDraw draw_person(std::uint64_t seed) {
  RandomStream random(seed, person_stream);
  PersonDraw person;
  person.seed = seed;
  person.size = random.normal();
  person.root_length = random.normal();
  person.root_thickness = random.normal();
  person.wear = random.uniform();
  for (auto* of_pairs : {&person.pair_size, &person.pair_root_length, &person.pair_root_thickness})
    for (double& z : *of_pairs) z = random.normal();
  return person;
}

SyntheticTooth generate_tooth_of_person(const ToothFamilies& families, int fdi, const PersonDraw& person,
                                        const ToothVariation& variation, const PersonVariation& persons) {
  require_in_range(persons);
  const int type = tooth_type_of_fdi(fdi);
  const auto pair = static_cast<std::size_t>(type);
  RandomStream own(person.seed, tooth_stream + static_cast<std::uint64_t>(fdi));
  SharedDraws shared;
  shared.size = mixed(persons.size, person.size, person.pair_size[pair], own.normal());
  shared.root_length = mixed(persons.root_length, person.root_length, person.pair_root_length[pair], own.normal());
  shared.root_thickness =
      mixed(persons.root_thickness, person.root_thickness, person.pair_root_thickness[pair], own.normal());
  ToothVariation of_person = variation;
  const bool is_worn = person.wear > 1 - variation.wear_share;
  of_person.wear_share = is_worn ? persons.worn_share : std::min(0.1, variation.wear_share);
  return generate_tooth(families, type, person.seed, of_person, shared);
}

}  // namespace rhizodont
