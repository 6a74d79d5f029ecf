// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/tooth_instances.hpp"

#include "networks/cloud_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rhizodont {
namespace {

/// Points with a vote.
struct Votes {
  std::vector<std::size_t> points;
  std::vector<float> at;  ///< 3 per vote
  std::vector<double> weights;

  Eigen::Vector3d vote(std::size_t i) const {
    return Eigen::Vector3f(at[3 * i], at[3 * i + 1], at[3 * i + 2]).cast<double>();
  }
};

Votes votes_of(const TeethReading& reading, const InstanceOptions& options) {
  Votes votes;
  for (std::size_t i = 0; i < reading.size(); ++i) {
    const double tooth = reading.tooth(i);
    if (tooth < options.least_tooth) continue;
    votes.points.push_back(i);
    for (const double x : reading.vote(i)) votes.at.push_back(static_cast<float>(x));
    // Beside another tooth a vote may mean either.
    votes.weights.push_back(tooth * (1 - 0.5 * static_cast<double>(reading.said.borders[i])));
  }
  return votes;
}

/// Where the votes around a place gather, and how many.
struct Gathering {
  Eigen::Vector3d at;
  double weight = 0;
};

Gathering gathering_near(const Votes& votes, const CloudGrid& grid, Eigen::Vector3d at, double width) {
  double total = 0;
  for (int step = 0; step < 30; ++step) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    total = 0;
    const Eigen::Vector3f query = at.cast<float>();
    grid.visit_near(query.data(), static_cast<float>(2 * width), [&](std::int32_t j) {
      const auto i = static_cast<std::size_t>(j);
      const Eigen::Vector3d vote = votes.vote(i);
      const double squared = (vote - at).squaredNorm() / (width * width);
      if (squared > 4) return;
      const double w = votes.weights[i] * std::exp(-squared);
      sum += w * vote;
      total += w;
    });
    if (!(total > 0)) break;
    const Eigen::Vector3d next = sum / total;
    const double moved = (next - at).norm();
    at = next;
    if (moved < 0.01) break;
  }
  return {at, total};
}

/// Gatherings, heaviest first, without those that lie within reach of a heavier one.
std::vector<Gathering> gatherings_of(const Votes& votes, double width) {
  const CloudGrid grid(votes.at, static_cast<float>(width));
  std::vector<Gathering> all;
  for (std::size_t i = 0; i < votes.points.size(); ++i)
    all.push_back(gathering_near(votes, grid, votes.vote(i), width));
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return all[a].weight > all[b].weight; });
  std::vector<Gathering> kept;
  for (const std::size_t i : order) {
    const bool near = std::any_of(kept.begin(), kept.end(),
                                  [&](const Gathering& g) { return (g.at - all[i].at).norm() < 0.8 * width; });
    if (!near && all[i].weight > 0) kept.push_back(all[i]);
  }
  return kept;
}

std::size_t nearest_of(const std::vector<Gathering>& gatherings, const Eigen::Vector3d& vote) {
  std::size_t best = 0;
  for (std::size_t g = 1; g < gatherings.size(); ++g)
    if ((gatherings[g].at - vote).squaredNorm() < (gatherings[best].at - vote).squaredNorm()) best = g;
  return best;
}

/// What the votes of a gathering say of it together.
ToothInstance instance_at(const TeethReading& reading, const Votes& votes, const std::vector<Gathering>& gatherings,
                          std::size_t gathering) {
  ToothInstance tooth;
  tooth.middle = gatherings[gathering].at;
  for (std::size_t i = 0; i < votes.points.size(); ++i) {
    if (nearest_of(gatherings, votes.vote(i)) != gathering) continue;
    const double w = reading.tooth(votes.points[i]);
    tooth.support += w;
    for (int s = 0; s < arch_place_count; ++s)
      tooth.places[static_cast<std::size_t>(s)] += reading.probability(votes.points[i], kind_of_place(s));
  }
  const double sum = std::accumulate(tooth.places.begin(), tooth.places.end(), 0.0);
  for (double& p : tooth.places) p = sum > 0 ? p / sum : 1.0 / arch_place_count;
  return tooth;
}

double likeness(const ToothInstance& a, const ToothInstance& b) {
  double common = 0;
  for (std::size_t s = 0; s < arch_place_count; ++s) common += std::min(a.places[s], b.places[s]);
  return common;
}

/// How near the middles of two teeth of the kinds that these are most likely can come, mm.
double least_distance(const ToothInstance& tooth) {
  const auto place = std::max_element(tooth.places.begin(), tooth.places.end()) - tooth.places.begin();
  const auto from_middle = place < 8 ? 8 - place : place - 7;
  return from_middle >= 6 ? 6 : from_middle >= 3 ? 4 : 3;
}

/// Joins gatherings that are one tooth, and gives up those with few votes, until none is left.
std::vector<ToothInstance> settled(const TeethReading& reading, const Votes& votes, std::vector<Gathering> gatherings,
                                   const InstanceOptions& options) {
  for (;;) {
    std::vector<ToothInstance> teeth;
    for (std::size_t g = 0; g < gatherings.size(); ++g) teeth.push_back(instance_at(reading, votes, gatherings, g));
    std::size_t give_up = teeth.size();
    for (std::size_t g = 0; g < teeth.size(); ++g)
      if (teeth[g].support < options.least_support &&
          (give_up == teeth.size() || teeth[g].support < teeth[give_up].support))
        give_up = g;
    for (std::size_t a = 0; a < teeth.size() && give_up == teeth.size(); ++a)
      for (std::size_t b = a + 1; b < teeth.size() && give_up == teeth.size(); ++b) {
        const double distance = (teeth[a].middle - teeth[b].middle).norm();
        const double least = std::max(least_distance(teeth[a]), least_distance(teeth[b]));
        if (distance > least || likeness(teeth[a], teeth[b]) < 0.5 * distance / least + 0.2) continue;
        const double sum = teeth[a].support + teeth[b].support;
        gatherings[a].at = (teeth[a].support * teeth[a].middle + teeth[b].support * teeth[b].middle) / sum;
        give_up = b;
      }
    if (give_up == teeth.size()) return teeth;
    gatherings.erase(gatherings.begin() + static_cast<std::ptrdiff_t>(give_up));
    if (gatherings.empty()) return {};
  }
}

void share_points(const TeethReading& reading, double width, ToothInstances& found) {
  const std::size_t count = found.teeth.size();
  found.shares.assign(count * reading.size(), 0);
  for (std::size_t i = 0; i < reading.size(); ++i) {
    const double tooth = reading.tooth(i);
    if (tooth < 1e-3) continue;
    const Eigen::Vector3d vote = reading.vote(i);
    double sum = 0;
    for (std::size_t t = 0; t < count; ++t) {
      double alike = 0;  // what the point says of its kind counts beside where it votes
      for (int s = 0; s < arch_place_count; ++s)
        alike += found.teeth[t].places[static_cast<std::size_t>(s)] * reading.probability(i, kind_of_place(s)) / tooth;
      const double squared = (vote - found.teeth[t].middle).squaredNorm() / (width * width);
      found.shares[i * count + t] = (alike + 0.05) * (std::exp(-squared / 2) + 1e-9 / (1 + squared));
      sum += found.shares[i * count + t];
    }
    for (std::size_t t = 0; t < count; ++t) found.shares[i * count + t] *= sum > 0 ? tooth / sum : 0;
  }
}

/// A tooth where a click is and the network saw none: points around it that no tooth has.
void add_clicked(const TeethReading& reading, const std::vector<Eigen::Vector3d>& clicks, ToothInstances& found) {
  constexpr double most_mm = 5, radius_mm = 3.5;
  for (const Eigen::Vector3d& click : clicks) {
    const bool known = std::any_of(found.teeth.begin(), found.teeth.end(),
                                   [&](const ToothInstance& t) { return (t.middle - click).norm() < most_mm; });
    if (known) continue;
    ToothInstance tooth;
    tooth.middle = click;
    tooth.places.fill(1.0 / arch_place_count);
    const std::size_t before = found.teeth.size();
    std::vector<double> shares;
    for (std::size_t i = 0; i < reading.size(); ++i) {
      double taken = 0;
      for (std::size_t t = 0; t < before; ++t) taken += found.shares[i * before + t];
      const double near = std::exp(-(reading.place(i) - click).squaredNorm() / (radius_mm * radius_mm));
      const double own = (1 - taken) * (near > 0.2 ? 0.9 : near > 0.05 ? 0.3 : 0);
      for (std::size_t t = 0; t < before; ++t) shares.push_back(found.shares[i * before + t]);
      shares.push_back(own);
      tooth.support += own;
    }
    found.shares = std::move(shares);
    found.teeth.push_back(tooth);
  }
}

}  // namespace

ToothInstances find_instances(const TeethReading& reading, const InstanceOptions& options) {
  const Votes votes = votes_of(reading, options);
  ToothInstances found;
  if (!votes.points.empty()) found.teeth = settled(reading, votes, gatherings_of(votes, options.width_mm), options);
  share_points(reading, options.width_mm, found);
  add_clicked(reading, options.clicks, found);
  return found;
}

}  // namespace rhizodont
