// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// What one measured root tells of a person's other roots: bench_people DATA [COUNT [LENGTHS.csv]]. Crowns of generated
// people (28 teeth each, families/person.hpp) are completed one by one; then the length of one root is taken as
// measured and the others' expectations are conditioned on it (arch/person_lengths.hpp). All lengths go to LENGTHS.csv.
#include "arch/person_lengths.hpp"
#include "base/random_stream.hpp"
#include "families/crown_crop.hpp"
#include "families/person.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <vector>

namespace {

using namespace rhizodont;

struct Length {
  LengthExpectation expected;
  double truth = 0;
};

/// A generated crown's root as completed and as it is, both from the crown's lowest point along the same axis.
std::optional<Length> length_of(const ToothFamilies& families, const CompletionModels& models, int fdi,
                                const PersonDraw& person) {
  constexpr double paper_share = 0.15, gap_probability = 0.35, half_of_80_percent = 1.2816;
  try {
    const SyntheticTooth tooth = generate_tooth_of_person(families, fdi, person);
    RandomStream random(person.seed, static_cast<std::uint64_t>(fdi));
    const TriangleMesh crown = draw_cropped_crown(tooth, paper_share, gap_probability, random).mesh;
    CompleteOptions options;
    // Right teeth are made as their left fellows.
    options.fdi = is_right_side(fdi) ? (fdi < 20 ? fdi + 10 : fdi - 10) : fdi;
    const CompletionRecord record = complete_tooth(crown, models, options).record;
    if (!record.root.interval) return std::nullopt;
    const Eigen::Vector3d& axis = record.frame.growth_axis;
    const double truth = extent_along(crown.vertices, axis).first - extent_along(tooth.mesh.vertices, axis).first;
    const double wide = record.root.interval->length_high_mm - record.root.interval->length_low_mm;
    return Length{{record.root.length_mm, wide / (2 * half_of_80_percent)}, truth};
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
  tbb::parallel_for(std::size_t{0}, lengths.size(), [&](std::size_t i) {
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
  fmt::print(
      "{} people, {} of {} teeth\n\n| measured | mean error of the others before, mm | after | less |\n"
      "|---|---|---|---|\n",
      all.size(), teeth, 28 * all.size());
  for (const std::vector<int>& measured : {std::vector{11}, std::vector{13}, std::vector{16}, std::vector{31},
                                           std::vector{36}, std::vector{36, 11}, std::vector{36, 46, 16, 26, 11, 31}})
    print_row(all, measured);
  return 0;
}
