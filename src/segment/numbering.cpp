// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The forward-backward algorithm: L. Rabiner, "A tutorial on hidden Markov models and selected applications in speech
// recognition", Proceedings of the IEEE 77(2), 1989.
#include "segment/numbering.hpp"

#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rhizodont {
namespace {

constexpr double impossible = std::numeric_limits<double>::infinity();
constexpr int place_count = arch_place_count;

/// Where a tooth of the model stands, in the frame of a reading: mm.
Eigen::Vector3d model_place(const ArchModel& model, int place, Jaw jaw) {
  const Point& p = model.teeth.at(fdi_of_place(place, jaw)).place;
  const double to_front = p.z(), left = p.x();
  return jaw == Jaw::upper ? Eigen::Vector3d(left, to_front, -p.y()) : Eigen::Vector3d(-left, to_front, p.y());
}

/// Teeth in their order along the arch from -x over the front to +x.
std::vector<std::size_t> order_along_arch(const std::vector<ToothInstance>& teeth, Jaw jaw, const ArchModel& model) {
  // The model is moved onto the teeth, each of which is where its places are.
  Eigen::Vector3d shift = Eigen::Vector3d::Zero(), centre = Eigen::Vector3d::Zero();
  for (int s = 0; s < place_count; ++s) centre += model_place(model, s, jaw) / place_count;
  for (const ToothInstance& tooth : teeth) {
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();
    for (int s = 0; s < place_count; ++s)
      expected += tooth.places[static_cast<std::size_t>(s)] * model_place(model, s, jaw);
    shift += (tooth.middle - expected) / static_cast<double>(teeth.size());
  }
  centre += shift;
  const auto angle = [&](std::size_t i) {
    const Eigen::Vector3d d = teeth[i].middle - centre;
    return std::atan2(d.x(), d.y());
  };
  std::vector<std::size_t> order(teeth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  return order;
}

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  return high == -impossible ? high : high + std::log(std::exp(a - high) + std::exp(b - high));
}

/// Costs of readings of one arch. Teeth are by their order along it; -1 stands before all, `count` behind all.
class Costs {
 public:
  Costs(const std::vector<ToothInstance>& teeth, const std::vector<std::size_t>& order, Jaw jaw, const ArchModel& model,
        const NumberingOptions& options)
      : teeth_(teeth), order_(order), jaw_(jaw), options_(options) {
    std::vector<Eigen::Vector3d> places;
    for (int s = 0; s < place_count; ++s) places.push_back(model_place(model, s, jaw));
    const auto apart = [&](std::size_t a, std::size_t b) { return (places[a] - places[b]).norm(); };
    // What a tooth takes up along the arch, from the distances to its neighbours.
    const auto width = [&](std::size_t s) {
      if (s == 0) return apart(0, 1);
      return s + 1 == places.size() ? apart(s - 1, s) : (apart(s - 1, s) + apart(s, s + 1)) / 2;
    };
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 0; b < places.size(); ++b) {
        open_[a][b] = apart(a, b);
        closed_[a][b] = (width(a) + width(b)) / 2;
      }
  }

  int count() const { return static_cast<int>(order_.size()); }
  const ToothInstance& tooth(int i) const { return teeth_[order_[static_cast<std::size_t>(i)]]; }

  double unary(int i, int s) const {
    const int fdi = fdi_of_place(s, jaw_);
    const auto given = options_.given.find(order_[static_cast<std::size_t>(i)]);
    if (given != options_.given.end()) return given->second == fdi ? 0 : impossible;
    if (options_.missing_teeth.contains(fdi)) return impossible;
    for (const auto& [other, number] : options_.given)
      if (number == fdi) return impossible;
    const double trust = options_.network_trust;
    return -std::log(trust * tooth(i).places[static_cast<std::size_t>(s)] + (1 - trust) / place_count) +
           (fdi % 10 == 8 ? options_.wisdom : 0);
  }

  /// Of taking what was found for nothing.
  double nothing(int i) const {
    if (options_.given.contains(order_[static_cast<std::size_t>(i)])) return impossible;
    return options_.no_tooth + options_.no_tooth_point * std::min(tooth(i).support, 100.0);
  }

  /// Of what lacks between two places, or before or behind (-1, `place_count`) them.
  double between(int s, int next) const {
    double cost = 0;
    for (int m = s + 1; m < next; ++m) {
      const int fdi = fdi_of_place(m, jaw_);
      if (options_.missing_teeth.contains(fdi)) continue;
      if (fdi % 10 == 8) continue;
      cost += s < 0 || next >= place_count ? options_.missing_at_end : options_.missing;
    }
    return cost;
  }

  /// Of the distance between neighbours: as in the model, or, where teeth lack between them, of a closed gap.
  double distance(int i, int s, int j, int next) const {
    const double is = (tooth(i).middle - tooth(j).middle).norm();
    const auto a = static_cast<std::size_t>(s), b = static_cast<std::size_t>(next);
    const double open = likelihood(is, open_[a][b]);
    if (next == s + 1) return -open;
    const double closed = likelihood(is, closed_[a][b]);
    return -log_sum(std::log(1 - options_.closed) + open, std::log(options_.closed) + closed);
  }

 private:
  /// Logarithm of how likely a distance is where another one is expected, mm.
  double likelihood(double is, double expected) const {
    const double off = (is - expected) / (options_.distance_mm + options_.distance_share * expected);
    return log_sum(-0.5 * off * off, -options_.most_off);
  }

  const std::vector<ToothInstance>& teeth_;
  const std::vector<std::size_t>& order_;
  Jaw jaw_;
  const NumberingOptions& options_;
  /// mm between the middles of the teeth at two places: in the model, and where they touch.
  std::array<std::array<double, place_count>, place_count> open_{}, closed_{};
};

using Table = std::vector<std::array<double, place_count>>;

/// Logarithm of the sum (or, for `best`, of the largest) of all readings up to tooth i at place s; with what is best
/// before, if it is wanted.
Table forward(const Costs& costs, bool best, std::vector<std::array<std::pair<int, int>, place_count>>* before) {
  Table table(static_cast<std::size_t>(costs.count()));
  if (before != nullptr) before->resize(table.size());
  for (int i = 0; i < costs.count(); ++i)
    for (int s = 0; s < place_count; ++s) {
      double skipped = 0, sum = -impossible;
      std::pair<int, int> from{-1, -1};
      const auto add = [&](double value, std::pair<int, int> candidate) {
        if (value > sum) from = candidate;
        sum = best ? std::max(sum, value) : log_sum(sum, value);
      };
      for (int j = i - 1; j >= 0; --j) {
        for (int p = 0; p < s; ++p)
          add(table[static_cast<std::size_t>(j)][static_cast<std::size_t>(p)] - skipped - costs.between(p, s) -
                  costs.distance(j, p, i, s),
              {j, p});
        skipped += costs.nothing(j);
      }
      add(-skipped - costs.between(-1, s), {-1, -1});
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(s)] = sum - costs.unary(i, s);
      if (before != nullptr) (*before)[static_cast<std::size_t>(i)][static_cast<std::size_t>(s)] = from;
    }
  return table;
}

/// The same of all that comes behind tooth i at place s.
Table backward(const Costs& costs) {
  Table table(static_cast<std::size_t>(costs.count()));
  for (int i = costs.count() - 1; i >= 0; --i)
    for (int s = 0; s < place_count; ++s) {
      double skipped = 0, sum = -impossible;
      for (int j = i + 1; j < costs.count(); ++j) {
        for (int p = s + 1; p < place_count; ++p)
          sum = log_sum(sum, table[static_cast<std::size_t>(j)][static_cast<std::size_t>(p)] - skipped -
                                 costs.between(s, p) - costs.distance(i, s, j, p) - costs.unary(j, p));
        skipped += costs.nothing(j);
      }
      sum = log_sum(sum, -skipped - costs.between(s, place_count));
      table[static_cast<std::size_t>(i)][static_cast<std::size_t>(s)] = sum;
    }
  return table;
}

/// The end of a whole reading whose last tooth is i at s.
double ending(const Costs& costs, int i, int s) {
  double cost = costs.between(s, place_count);
  for (int j = i + 1; j < costs.count(); ++j) cost += costs.nothing(j);
  return cost;
}

void require_numbers_of(Jaw jaw, const NumberingOptions& options) {
  const double first = options.first_premolars_out, second = options.second_premolars_out;
  if (!(first >= 0 && second >= 0 && first + second < 1))
    throw UsageError("Premolars cannot be taken out in less than none or all jaws.");
  std::set<int> seen;
  for (const auto& [tooth, fdi] : options.given) {
    if (!is_permanent_tooth(fdi) || jaw_of_fdi(fdi) != jaw)
      throw UsageError(fmt::format("Tooth {} is no permanent tooth of the {} jaw.", fdi, jaw_name(jaw)));
    if (!seen.insert(fdi).second) throw UsageError(fmt::format("Tooth {} was given to two teeth.", fdi));
    if (options.missing_teeth.contains(fdi))
      throw UsageError(fmt::format("Tooth {} cannot be missing and be there.", fdi));
  }
}

/// What a tooth's number is if place `chosen` is its (-1: it is no tooth), and what else it might be.
void describe(std::array<double, place_count> probability, int chosen, Jaw jaw, ToothNumber& number) {
  double none = 1;
  for (double& p : probability) {
    p = std::clamp(p, 0.0, 1.0);
    none -= p;
  }
  none = std::max(none, 0.0);
  if (chosen >= 0) number.fdi = fdi_of_place(chosen, jaw);
  number.probability = chosen >= 0 ? probability[static_cast<std::size_t>(chosen)] : none;
  if (chosen >= 0) number.second_probability = none;
  for (int s = 0; s < place_count; ++s)
    if (s != chosen && probability[static_cast<std::size_t>(s)] > number.second_probability) {
      number.second_probability = probability[static_cast<std::size_t>(s)];
      number.second = fdi_of_place(s, jaw);
    }
}

/// One supposition about which teeth were taken out, carried through.
struct Supposition {
  Table sums, behind;
  double evidence = -impossible;  ///< logarithm of the sum of all readings
  double best = -impossible;      ///< of the most likely one
  std::vector<int> chosen;        ///< place by order in it; -1: no tooth
};

/// @param prior  logarithm
Supposition carried_through(const Costs& costs, double prior) {
  Supposition result;
  result.sums = forward(costs, false, nullptr);
  result.behind = backward(costs);
  double nothing = 0;  // the reading in which nothing is a tooth
  for (int i = 0; i < costs.count(); ++i) nothing -= costs.nothing(i);
  result.evidence = nothing;
  std::vector<std::array<std::pair<int, int>, place_count>> before;
  const Table best = forward(costs, true, &before);
  std::pair<int, int> at{-1, -1};
  for (int i = 0; i < costs.count(); ++i)
    for (int s = 0; s < place_count; ++s) {
      const auto n = static_cast<std::size_t>(i), place = static_cast<std::size_t>(s);
      const double end = ending(costs, i, s);
      result.evidence = log_sum(result.evidence, result.sums[n][place] - end);
      if (best[n][place] - end > result.best) {
        result.best = best[n][place] - end;
        at = {i, s};
      }
    }
  result.chosen.assign(static_cast<std::size_t>(costs.count()), -1);
  while (at.first >= 0) {
    result.chosen[static_cast<std::size_t>(at.first)] = at.second;
    at = before[static_cast<std::size_t>(at.first)][static_cast<std::size_t>(at.second)];
  }
  result.evidence += prior;
  result.best += prior;
  for (auto& row : result.sums)
    for (double& value : row) value += prior;
  return result;
}

/// Orthodontists take premolars out in pairs: as one event that is far likelier than twice one tooth lacking.
std::vector<Supposition> suppositions(const std::vector<ToothInstance>& teeth, const std::vector<std::size_t>& order,
                                      Jaw jaw, const ArchModel& model, const NumberingOptions& options) {
  const double first = options.first_premolars_out, second = options.second_premolars_out;
  std::vector<Supposition> all;
  for (const auto& [number, share] : {std::pair(0, 1 - first - second), std::pair(4, first), std::pair(5, second)}) {
    NumberingOptions supposed = options;
    bool contradicts = false;
    if (number > 0)
      for (const int place : {8 - number, number + 7}) {
        const int fdi = fdi_of_place(place, jaw);
        contradicts = contradicts || std::any_of(options.given.begin(), options.given.end(),
                                                 [&](const auto& given) { return given.second == fdi; });
        supposed.missing_teeth.insert(fdi);
      }
    if (contradicts || !(share > 0)) continue;
    // What a person says is missing costs nothing below, but is no likelier to be one of a pair for that.
    double prior = std::log(share);
    for (const int fdi : options.missing_teeth)
      if ((fdi % 10 == 4 || fdi % 10 == 5) && jaw_of_fdi(fdi) == jaw && fdi % 10 != number) prior -= options.missing;
    all.push_back(carried_through(Costs(teeth, order, jaw, model, supposed), prior));
  }
  return all;
}

}  // namespace

int fdi_of_place(int place, Jaw jaw) {
  // From above a lower jaw has the patient's left where an upper one, from below, has the right.
  return fdi_of_arch_place(jaw == Jaw::upper ? place + 1 : place_count - place, place_count, jaw);
}

int place_of_fdi(int fdi) {
  const int quadrant = fdi / 10, number = fdi % 10;
  return quadrant == 1 || quadrant == 3 ? 8 - number : number + 7;
}

ArchNumbers number_teeth(const std::vector<ToothInstance>& teeth, Jaw jaw, const ArchModel& model,
                         const NumberingOptions& options) {
  require_numbers_of(jaw, options);
  ArchNumbers numbers;
  numbers.teeth.resize(teeth.size());
  if (teeth.empty()) return numbers;
  const std::vector<std::size_t> order = order_along_arch(teeth, jaw, model);
  const std::vector<Supposition> all = suppositions(teeth, order, jaw, model, options);
  numbers.evidence = -impossible;
  const Supposition* likeliest = nullptr;
  for (const Supposition& one : all) {
    numbers.evidence = log_sum(numbers.evidence, one.evidence);
    if (likeliest == nullptr || one.best > likeliest->best) likeliest = &one;
  }
  if (likeliest == nullptr || !std::isfinite(numbers.evidence))
    throw UsageError("The teeth's given numbers contradict their order along the arch.");
  for (std::size_t n = 0; n < teeth.size(); ++n) {
    std::array<double, place_count> probability{};
    for (const Supposition& one : all)
      for (std::size_t s = 0; s < place_count; ++s)
        probability[s] += std::exp(one.sums[n][s] + one.behind[n][s] - numbers.evidence);
    describe(probability, likeliest->chosen[n], jaw, numbers.teeth[order[n]]);
  }
  return numbers;
}

}  // namespace rhizodont
