// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/crown_features.hpp"

#include "mesh/smooth_functions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace rhizodont {
namespace {

double crown_top(const SyntheticTooth& tooth) {
  double top = 0;
  for (const Point& p : tooth.mesh.vertices) top = std::max(top, p.z());
  return top;
}

// Height that a worn tooth has lost: most have lost little, some a great deal, one in twelve up to half of its crown.
// `rank` among worn teeth, 0..1, 1 the most worn.
double lost_height(double rank, double top, double wear_mm) {
  constexpr double much_worn = 11.0 / 12, least = 0.25, most = 0.5;
  const double usual = std::min(wear_mm * rank * rank, least * top);
  if (rank < much_worn || wear_mm <= 0) return usual;
  return std::max(usual, top * (least + (most - least) * (rank - much_worn) / (1 - much_worn)));
}

// Cusps and edges ground down to a facet, flat or a little hollow, as dentine wears before enamel does; a second, lower
// facet on one side for the teeth that are worn unevenly.
void wear(SyntheticTooth& tooth, double rank, const ToothVariation& variation, RandomStream& random) {
  const double top = crown_top(tooth);
  const double loss = lost_height(rank, top, variation.wear_mm);
  const Eigen::Vector2d slope(random.normal(0.0, 0.08), random.normal(0.0, 0.14));
  const double hollow = random.uniform(0.0, 0.02) * std::min(1.0, loss);
  for (Point& p : tooth.mesh.vertices) {
    const double facet = top - loss + slope.dot(p.head<2>()) + hollow * (p.head<2>().squaredNorm() - 6);
    const double over = p.z() - facet;
    if (over > -1) p.z() -= 0.94 * soft_plus(over, 0.15);
  }
}

// A hollow into the crown at a random place: caries, a lost filling, a chipped corner.
void hollow_out(SyntheticTooth& tooth, RandomStream& random) {
  std::vector<std::size_t> places;
  const double top = crown_top(tooth);
  for (std::size_t v = 0; v < tooth.crown.size(); ++v)
    if (tooth.crown[v] == 1 && tooth.mesh.vertices[v].z() > 0.2 * top) places.push_back(v);
  if (places.empty()) return;
  const Point centre = tooth.mesh.vertices[places[random.index(places.size())]];
  const double radius = random.uniform(0.7, 1.8), depth = radius * random.uniform(0.3, 0.8);
  const Eigen::Vector3d inward = (Point(0, 0, 0.35 * top) - centre).normalized();
  for (std::size_t v : places) {
    Point& p = tooth.mesh.vertices[v];
    const double r = (p - centre).norm() / radius;
    if (r < 2) p += depth * std::exp(-std::pow(r, 3)) * inward;
  }
}

// A pad on the cheek's side, with a bracket's or an attachment's outline.
void put_bracket(SyntheticTooth& tooth, RandomStream& random) {
  const double top = crown_top(tooth);
  const Eigen::Vector2d half(random.uniform(1.0, 1.8), random.uniform(0.7, 1.6));
  const Eigen::Vector2d middle(random.normal(0.0, 0.4), top * random.uniform(0.42, 0.62));
  const double height = random.uniform(0.5, 1.8), edge = random.uniform(0.15, 0.3);
  const auto box = [&](double x, double limit) { return 1 / (1 + std::exp((std::abs(x) - limit) / edge)); };
  for (std::size_t v = 0; v < tooth.crown.size(); ++v) {
    Point& p = tooth.mesh.vertices[v];
    if (tooth.crown[v] == 0 || p.y() <= 0) continue;
    // Only the outer face: further in there are cusps and the other side of thin crowns.
    const double outer = 1 / (1 + std::exp(-(p.y() - 1.0) / 0.25));
    p.y() += height * outer * box(p.x() - middle.x(), half.x()) * box(p.z() - middle.y(), half.y());
  }
}

}  // namespace

void mark_crown(SyntheticTooth& tooth, const ToothVariation& variation, const std::optional<double>& wear_rank,
                RandomStream& random) {
  const double own = random.uniform(), rank = wear_rank ? 0.5 * std::erfc(-*wear_rank / std::numbers::sqrt2) : own;
  const bool is_decayed = random.chance(variation.decay_share), has_bracket = random.chance(variation.bracket_share);
  if (rank > 1 - variation.wear_share)
    wear(tooth, (rank - 1 + variation.wear_share) / variation.wear_share, variation, random);
  if (is_decayed) hollow_out(tooth, random);
  if (has_bracket) put_bracket(tooth, random);
}

}  // namespace rhizodont
