// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What one measured root tells of a person's other roots: bench_people DATA [COUNT [LENGTHS.csv]]. The roots of
// generated people's crowns (28 teeth each, families/person.hpp) are predicted one by one, by the network's points
// alone; then the length of one root is taken as measured and the others' expectations are conditioned on it
// (arch/person_lengths.hpp). Correlations of the errors in their deviations, by pairs of fellows and of any other two
// teeth, are what PersonLengthModel states. All lengths go to LENGTHS.csv.
#include "arch/person_lengths.hpp"
#include "base/parallel_tasks.hpp"
#include "base/random_stream.hpp"
#include "completion/uncertainty.hpp"
#include "evaluation/held_out_people.hpp"
#include "families/crown_crop.hpp"
#include "families/person.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/models.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

namespace {

using namespace rhizodont;

struct Length {
  LengthExpectation expected;
  double truth = 0;
};

/// A generated crown's root as predicted and as it is, both from the crown's lowest point along the same axis.
std::optional<Length> length_of(const ToothFamilies& families, const CompletionModels& models, int fdi,
                                const PersonDraw& person) {
  constexpr double paper_share = 0.15, gap_probability = 0.35, half_of_80_percent = 1.2816;
  try {
    const SyntheticTooth tooth = generate_tooth_of_person(families, fdi, person);
    RandomStream random(person.seed, static_cast<std::uint64_t>(fdi));
    const TriangleMesh crown = draw_cropped_crown(tooth, paper_share, gap_probability, random).mesh;
    const int left = fdi_of_type(tooth_type_of_fdi(fdi), false);  // right teeth are made as left ones
    const RootOutcome root = predicted_root(crown, tooth.mesh, left, models).outcome;
    const auto scales = uncertainty_scales(content_of(models)->network.metadata(), left);
    if (!scales) return std::nullopt;
    const auto [low, high] = length_interval(root.length_mm, root.expected_distance_mm, *scales);
    return Length{{root.length_mm, (high - low) / (2 * half_of_80_percent)}, root.true_length_mm};
  } catch (const Error&) {
    return std::nullopt;
  }
}

using Person = std::map<int, Length>;

std::vector<Person> people(const ToothFamilies& families, const CompletionModels& models, std::size_t count) {
  std::vector<int> teeth;
  for (const int quadrant : {1, 2, 3, 4})
    for (int place = 1; place <= 7; ++place) teeth.push_back(10 * quadrant + place);
  std::vector<std::optional<Length>> lengths(count * teeth.size());
  parallel_tasks(lengths.size(), [&](std::size_t i) {
    lengths[i] = length_of(families, models, teeth[i % teeth.size()], draw_person(90'000 + i / teeth.size()));
  });
  std::vector<Person> all(count);
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i]) all[i / teeth.size()].emplace(teeth[i % teeth.size()], *lengths[i]);
  return all;
}

void write_lengths(const std::vector<Person>& all, const char* path) {
  std::ofstream file(path);
  file << "person,tooth,expected_mm,deviation_mm,true_mm\n";
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const auto& [fdi, length] : all[i])
      file << fmt::format("{},{},{:.4f},{:.4f},{:.4f}\n", i, fdi, length.expected.mm, length.expected.deviation_mm,
                          length.truth);
}

struct MeanError {
  double sum = 0;
  int count = 0;
  void add(double error) { sum += std::abs(error), ++count; }
  double mm() const { return sum / std::max(count, 1); }
};

void print_row(const std::vector<Person>& all, const std::vector<int>& measured) {
  MeanError before, after;
  for (const Person& person : all) {
    std::map<int, LengthExpectation> expected;
    std::map<int, double> known;
    for (const auto& [fdi, length] : person) expected[fdi] = length.expected;
    for (const int fdi : measured)
      if (person.contains(fdi)) known[fdi] = person.at(fdi).truth;
    if (known.size() < measured.size()) continue;
    for (const auto& [fdi, length] : given_measured(expected, known)) {
      if (known.contains(fdi)) continue;
      before.add(expected.at(fdi).mm - person.at(fdi).truth);
      after.add(length.mm - person.at(fdi).truth);
    }
  }
  fmt::print("| {} | {:.3f} | {:.3f} | {:.1f} % |\n", fmt::join(measured, ", "), before.mm(), after.mm(),
             100 * (1 - after.mm() / before.mm()));
}

/// How errors of two teeth go together: the correlation of what lies between truth and expectation, in deviations.
struct Together {
  double product = 0, of_first = 0, of_second = 0;
  void add(double a, double b) { product += a * b, of_first += a * a, of_second += b * b; }
  double correlation() const { return product / std::sqrt(std::max(1e-12, of_first * of_second)); }
};

void print_correlations(const std::vector<Person>& all) {
  // A type's bias is no person's.
  std::array<double, tooth_type_count> bias{}, count{};
  const auto error = [](const Length& length) {
    return (length.truth - length.expected.mm) / length.expected.deviation_mm;
  };
  for (const Person& person : all)
    for (const auto& [fdi, length] : person) {
      const auto type = static_cast<std::size_t>(tooth_type_of_fdi(fdi));
      bias[type] += error(length), count[type] += 1;
    }
  Together fellows, others, truths_of_fellows, truths_of_others;
  std::array<double, tooth_type_count> mean_length{};
  for (const Person& person : all)
    for (const auto& [fdi, length] : person) {
      const auto type = static_cast<std::size_t>(tooth_type_of_fdi(fdi));
      mean_length[type] += length.truth / count[type];
    }
  for (const Person& person : all)
    for (auto a = person.begin(); a != person.end(); ++a)
      for (auto b = std::next(a); b != person.end(); ++b) {
        const auto i = static_cast<std::size_t>(tooth_type_of_fdi(a->first)),
                   j = static_cast<std::size_t>(tooth_type_of_fdi(b->first));
        (i == j ? fellows : others).add(error(a->second) - bias[i] / count[i], error(b->second) - bias[j] / count[j]);
        (i == j ? truths_of_fellows : truths_of_others)
            .add(a->second.truth - mean_length[i], b->second.truth - mean_length[j]);
      }
  fmt::print("correlations of errors: fellows {:.2f}, others {:.2f}; of true lengths: {:.2f}, {:.2f}\n\n",
             fellows.correlation(), others.correlation(), truths_of_fellows.correlation(),
             truths_of_others.correlation());
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) {
    fmt::print(stderr, "usage: bench_people DATA [COUNT [LENGTHS.csv]]\n");
    return 2;
  }
  const std::size_t number = count > 2 ? std::strtoul(words[2], nullptr, 10) : 20;
  const std::vector<Person> all =
      people(load_tooth_families(words[1]), CompletionModels::load(default_models_folder()), number);
  if (count > 3) write_lengths(all, words[3]);
  std::size_t teeth = 0;
  for (const Person& person : all) teeth += person.size();
  print_correlations(all);
  fmt::print(
      "{} people, {} of {} teeth\n\n| measured | mean error of the others before, mm | after | less |\n"
      "|---|---|---|---|\n",
      all.size(), teeth, 28 * all.size());
  for (const std::vector<int>& measured : {std::vector{11}, std::vector{13}, std::vector{16}, std::vector{31},
                                           std::vector{36}, std::vector{36, 11}, std::vector{36, 46, 16, 26, 11, 31}})
    print_row(all, measured);
  return 0;
}
