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
    for (int s = 0; s < place_count; ++s) model_.push_back(model_place(model, s, jaw));
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

  double distance(int i, int s, int j, int next) const {
    const double expected = (model_[static_cast<std::size_t>(s)] - model_[static_cast<std::size_t>(next)]).norm();
    const double off = (tooth(i).middle - tooth(j).middle).norm() - expected;
    const double deviation = options_.distance_mm + options_.distance_share * expected;
    const double cost = 0.5 * (off / deviation) * (off / deviation);
    return -log_sum(-cost, -options_.most_off);
  }

 private:
  const std::vector<ToothInstance>& teeth_;
  const std::vector<std::size_t>& order_;
  Jaw jaw_;
  const NumberingOptions& options_;
  std::vector<Eigen::Vector3d> model_;
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
  std::set<int> seen;
  for (const auto& [tooth, fdi] : options.given) {
    if (!is_permanent_tooth(fdi) || jaw_of_fdi(fdi) != jaw)
      throw UsageError(fmt::format("Tooth {} is no permanent tooth of the {} jaw.", fdi, jaw_name(jaw)));
    if (!seen.insert(fdi).second) throw UsageError(fmt::format("Tooth {} was given to two teeth.", fdi));
    if (options.missing_teeth.contains(fdi))
      throw UsageError(fmt::format("Tooth {} cannot be missing and be there.", fdi));
  }
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
  const Costs costs(teeth, order, jaw, model, options);
  const Table sums = forward(costs, false, nullptr), behind = backward(costs);
  double all = 0;
  for (int i = 0; i < costs.count(); ++i) all -= costs.nothing(i);  // that nothing is a tooth
  if (!std::isfinite(all)) all = -impossible;
  for (int i = 0; i < costs.count(); ++i)
    for (int s = 0; s < place_count; ++s)
      all = log_sum(all, sums[static_cast<std::size_t>(i)][static_cast<std::size_t>(s)] - ending(costs, i, s));
  if (all == -impossible) throw UsageError("The teeth's given numbers contradict their order along the arch.");
  numbers.evidence = all;

  std::vector<std::array<std::pair<int, int>, place_count>> before;
  const Table best = forward(costs, true, &before);
  std::pair<int, int> at{-1, -1};
  double least = -impossible;
  for (int i = 0; i < costs.count(); ++i)
    for (int s = 0; s < place_count; ++s) {
      const double value = best[static_cast<std::size_t>(i)][static_cast<std::size_t>(s)] - ending(costs, i, s);
      if (value > least) {
        least = value;
        at = {i, s};
      }
    }
  std::vector<int> chosen(teeth.size(), -1);  // by order
  while (at.first >= 0) {
    chosen[static_cast<std::size_t>(at.first)] = at.second;
    at = before[static_cast<std::size_t>(at.first)][static_cast<std::size_t>(at.second)];
  }
  for (int i = 0; i < costs.count(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    ToothNumber& number = numbers.teeth[order[n]];
    double none = 1;
    std::array<double, place_count> probability{};
    for (std::size_t s = 0; s < place_count; ++s) {
      probability[s] = std::clamp(std::exp(sums[n][s] + behind[n][s] - all), 0.0, 1.0);
      none -= probability[s];
    }
    none = std::max(none, 0.0);
    if (chosen[n] >= 0) number.fdi = fdi_of_place(chosen[n], jaw);
    number.probability = chosen[n] >= 0 ? probability[static_cast<std::size_t>(chosen[n])] : none;
    if (chosen[n] >= 0) number.second_probability = none;
    for (int s = 0; s < place_count; ++s)
      if (s != chosen[n] && probability[static_cast<std::size_t>(s)] > number.second_probability) {
        number.second_probability = probability[static_cast<std::size_t>(s)];
        number.second = fdi_of_place(s, jaw);
      }
  }
  return numbers;
}

}  // namespace rhizodont
