// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The gum beside a tooth as scanners see it: "Completing Dental Models While Preserving Crown Geometry and Meshing
// Topology", 3.2 and figure 2: the margin bulges and falls off, and between teeth, where a scanner cannot see, a web
// spans to the neighbour.
#include "families/gum_flange.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/smooth_functions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

constexpr double pi = std::numbers::pi;

double bump(double angle, double middle, double half_width) {
  const double d = std::remainder(angle - middle, 2 * pi) / half_width;
  return std::exp(-0.5 * d * d);
}

/// What is drawn for one flange; angles of the surface are against the horizontal, positive downwards.
struct Profile {
  AroundTooth width, first_angle, last_angle, turn, roughness;
  std::array<double, 2> web_width{}, web_half_width{0.3, 0.3}, web_first{}, web_last{};
  struct Flare {
    double middle, half_width, length;
  };
  std::vector<Flare> flares;
  double side = 1;  // -1: inwards

  double width_at(double angle) const {
    double w = std::max(width(angle), 0.0);
    for (std::size_t s = 0; s < 2; ++s) w += web_width[s] * bump(angle, s == 0 ? pi : 0.0, web_half_width[s]);
    for (const Flare& flare : flares) {
      const double d = std::abs(std::remainder(angle - flare.middle, 2 * pi)) / flare.half_width;
      if (d < 1) w += flare.length * (1 - d);
    }
    return w;
  }

  /// Angle of the surface at a distance from the border.
  double slope_at(double angle, double distance) const {
    const double away = smooth_step(distance / std::max(turn(angle), 0.2));
    double slope = std::lerp(first_angle(angle), last_angle(angle), away);
    for (std::size_t s = 0; s < 2; ++s) {
      if (web_width[s] == 0) continue;
      const double share = std::min(1.0, 1.3 * bump(angle, s == 0 ? pi : 0.0, 1.3 * web_half_width[s]));
      slope = std::lerp(slope, std::lerp(web_first[s], web_last[s], away), share);
    }
    return slope;
  }
};

void draw_webs(Profile& profile, double probability, RandomStream& random) {
  for (std::size_t s = 0; s < 2; ++s) {
    if (!random.chance(probability)) continue;
    profile.web_width[s] = random.uniform(0.4, 2.6);
    profile.web_half_width[s] = random.uniform(0.18, 0.5);
    profile.web_first[s] = random.uniform(-0.7, 0.35);
    profile.web_last[s] = random.chance(0.3) ? random.uniform(-1.2, -0.2) : random.uniform(-0.2, 1.0);
  }
}

Profile draw_profile(FlangeKind kind, RandomStream& random) {
  Profile profile;
  profile.first_angle = AroundTooth(random, random.uniform(-0.35, 0.55), 0.22);
  profile.last_angle = AroundTooth(random, random.uniform(0.5, 1.35), 0.15);
  profile.turn = AroundTooth(random, random.uniform(0.5, 1.6), 0.25);
  profile.roughness = AroundTooth(random, 0.05, 0.03);
  switch (kind) {
    case FlangeKind::band:
      profile.width = AroundTooth(random, random.uniform(0.6, 3.2), random.uniform(0.1, 0.6));
      draw_webs(profile, 0.6, random);
      break;
    case FlangeKind::webs:
      profile.width = AroundTooth(random, random.uniform(-0.5, 0.2), 0.2);
      draw_webs(profile, 0.8, random);
      if (profile.web_width[0] + profile.web_width[1] == 0)
        profile.web_width[random.index(2)] = random.uniform(0.6, 2.4);
      break;
    case FlangeKind::parts:
      profile.width = AroundTooth(random, random.uniform(-0.8, 0.4), random.uniform(0.5, 1.1));
      draw_webs(profile, 0.3, random);
      break;
    case FlangeKind::lip:
      profile.width = AroundTooth(random, random.uniform(0.15, 0.7), 0.12);
      profile.first_angle = AroundTooth(random, random.uniform(0.9, 1.3), 0.1);
      profile.last_angle = AroundTooth(random, random.uniform(0.0, 0.5), 0.1);
      profile.turn = AroundTooth(random, random.uniform(0.4, 0.9), 0.1);
      profile.side = -1;
      return profile;
  }
  for (std::uint64_t i = 0, count = random.chance(0.6) ? random.index(5) : 0; i < count; ++i)
    profile.flares.push_back({random.uniform(0, 2 * pi), random.uniform(0.04, 0.16), random.uniform(0.6, 2.0)});
  return profile;
}

/// Directions from the border's middle, along the border's loop smoothed so that rings do not cross.
std::vector<Eigen::Vector2d> outward_directions(const TriangleMesh& crown, const std::vector<int>& loop) {
  const std::size_t n = loop.size();
  const auto at = [&](std::size_t i) -> const Point& { return crown.vertices[static_cast<std::size_t>(loop[i % n])]; };
  std::vector<Eigen::Vector2d> directions(n);
  for (std::size_t i = 0; i < n; ++i) {
    // The mesh lies to the left of the loop when seen from outside: away from it is to the right as seen from above.
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d along = (at(i + k + 1) - at(i + n - 1 - k)).head<2>();
      sum += Eigen::Vector2d(along.y(), -along.x()).normalized();
    }
    directions[i] = sum;
  }
  Point middle = Point::Zero();
  for (std::size_t i = 0; i < n; ++i) middle += at(i) / static_cast<double>(n);
  double agreement = 0;
  for (std::size_t i = 0; i < n; ++i) agreement += directions[i].dot((at(i) - middle).head<2>());
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d radial = (at(i) - middle).head<2>().normalized();
    directions[i] = ((agreement < 0 ? -1.0 : 1.0) * directions[i].normalized() + 0.7 * radial).normalized();
  }
  for (int round = 0; round < 4; ++round) {
    std::vector<Eigen::Vector2d> smooth(n);
    for (std::size_t i = 0; i < n; ++i)
      smooth[i] = (directions[(i + n - 1) % n] + 2 * directions[i] + directions[(i + 1) % n]).normalized();
    directions = std::move(smooth);
  }
  return directions;
}

}  // namespace

AroundTooth::AroundTooth(RandomStream& random, double mean_value, double deviation) : mean(mean_value) {
  for (std::size_t k = 0; k < height.size(); ++k) {
    height[k] = random.normal(0.0, deviation / std::sqrt(static_cast<double>(k + 1)));
    phase[k] = random.uniform(0, 2 * pi);
  }
}

double AroundTooth::operator()(double angle) const {
  double value = mean;
  for (std::size_t k = 0; k < height.size(); ++k)
    value += height[k] * std::sin(static_cast<double>(k + 1) * angle + phase[k]);
  return value;
}

Flange add_flange(const TriangleMesh& crown, FlangeKind kind, RandomStream& random) {
  constexpr double step = 0.25;  // mm between rings
  const Profile profile = draw_profile(kind, random);
  Flange flange{crown, crown.triangles.size(), std::vector<double>(crown.vertices.size(), 0)};
  const std::vector<std::vector<int>> loops = border_loops(crown);
  const std::vector<int>& loop =
      *std::max_element(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const std::size_t n = loop.size();
  const std::vector<Eigen::Vector2d> directions = outward_directions(crown, loop);
  Point middle = Point::Zero();
  for (const int v : loop) middle += crown.vertices[static_cast<std::size_t>(v)] / static_cast<double>(n);

  std::vector<double> angle(n), width(n);
  double widest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d d = (crown.vertices[static_cast<std::size_t>(loop[i])] - middle).head<2>();
    angle[i] = std::atan2(d.y(), d.x());
    width[i] = profile.width_at(angle[i]);
    widest = std::max(widest, width[i]);
  }
  // Rings of vertices; where the flange has ended, those of the ring before are used again.
  std::vector<int> ring = loop;
  for (double distance = step; distance < widest + step; distance += step) {
    std::vector<int> next = ring;
    for (std::size_t i = 0; i < n; ++i) {
      const double reached = std::min(distance, width[i]);
      const double part = reached - (distance - step);
      if (part < 0.2 * step) continue;
      const double slope = profile.slope_at(angle[i], distance);
      const double rough = profile.roughness(angle[i] * 5 + distance) * std::sin(7 * angle[i] + 3 * distance);
      const Eigen::Vector2d away = profile.side * std::cos(slope) * directions[i];
      next[i] = static_cast<int>(flange.mesh.vertices.size());
      flange.mesh.vertices.emplace_back(flange.mesh.vertices[static_cast<std::size_t>(ring[i])] +
                                        part * Eigen::Vector3d(away.x(), away.y(), -std::sin(slope)) +
                                        rough * Eigen::Vector3d(0, 0, part));
      flange.outwards.push_back(reached / std::max(width[i], 1e-9));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const auto add = [&](int a, int b, int c) {
        if (a != b && b != c && c != a) flange.mesh.triangles.push_back({a, b, c});
      };
      add(ring[j], ring[i], next[i]);
      add(ring[j], next[i], next[j]);
    }
    ring = std::move(next);
  }
  return flange;
}

}  // namespace rhizodont
