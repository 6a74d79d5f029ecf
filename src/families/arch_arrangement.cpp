// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_crowns.hpp"
#include "teeth/fdi.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

constexpr double one_degree = std::numbers::pi / 180;

std::size_t other_side(std::size_t j) { return arch_places - 1 - j; }

/// Numbers of variance 1 that vary smoothly along the arch, alike on both sides if wanted.
std::array<double, arch_places> smooth_numbers(RandomStream& random, bool symmetric) {
  constexpr double width = 3;  // teeth
  constexpr int margin = 8;
  std::array<double, arch_places + 2 * margin> white{};
  for (double& w : white) w = random.normal(0.0, 1.0);
  std::array<double, arch_places> result{};
  for (std::size_t j = 0; j < arch_places; ++j) {
    double squares = 0;
    for (std::size_t i = 0; i < white.size(); ++i) {
      const double off = (static_cast<double>(i) - margin - static_cast<double>(j)) / width;
      const double weight = std::exp(-0.5 * off * off);
      result[j] += weight * white[i];
      squares += weight * weight;
    }
    result[j] /= std::sqrt(squares);
  }
  if (symmetric)
    for (std::size_t j = 0; j < 8; ++j) result[other_side(j)] = result[j];
  return result;
}

/// Deviations of the places (smooth, own) and turns of the sixteen, in the work frame.
struct Deviations {
  std::array<Eigen::Vector3d, arch_places> smooth, own, turn;
};

Deviations draw_deviations(const ArchSource& source, Jaw jaw, double factor, RandomStream& random) {
  const double sense = jaw == Jaw::upper ? -1 : 1;
  const Eigen::Vector3d turned(sense, sense, 1);
  std::array<std::array<double, arch_places>, 6> symmetric, other;
  for (std::size_t k = 0; k < 6; ++k)
    symmetric[k] = smooth_numbers(random, true), other[k] = smooth_numbers(random, false);
  Deviations result;
  for (std::size_t j = 0; j < arch_places; ++j) {
    const int place = arch_place(j);
    const std::size_t row = static_cast<std::size_t>(std::min(place, 7) - 1) + (jaw == Jaw::upper ? 0 : 7);
    const double own_factor = place == 8 ? 1.5 : 1;
    const Eigen::Vector3d mirror = j < 8 ? Eigen::Vector3d(-1, 1, 1) : Eigen::Vector3d(1, 1, 1);
    const Eigen::Vector3d turn_mirror = j < 8 ? Eigen::Vector3d(1, -1, -1) : Eigen::Vector3d(1, 1, 1);
    Eigen::Vector3d smooth, own, turn;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      smooth[i] = 0.9 * symmetric[k][j] + 0.28 * other[k][j];
      own[i] = 0.33 * random.normal(0.0, 1.0);
      turn[i] = 0.5 * symmetric[k + 3][j] + 0.3 * other[k + 3][j] + 0.81 * random.normal(0.0, 1.0);
    }
    result.smooth[j] = factor * (source.place_root[row] * smooth).cwiseProduct(mirror).cwiseProduct(turned);
    result.own[j] = factor * own_factor * (source.place_root[row] * own).cwiseProduct(mirror).cwiseProduct(turned);
    result.turn[j] =
        factor * own_factor * (source.turn_root[row] * turn).cwiseProduct(turn_mirror).cwiseProduct(turned);
  }
  return result;
}

/// Which of the sixteen are there, and how much of a missing tooth's room is left.
struct Presence {
  std::array<bool, arch_places> there{};
  double room_left = 1;
  std::string why;
};

void drop_some(Presence& presence, RandomStream& random) {
  const double kind = random.uniform();
  constexpr std::array<double, 8> how_often{0, 0.5, 1.2, 0.3, 1.2, 2.0, 3.0, 1.5};
  if (kind < 0.3) {
    const int place = random.chance(0.8) ? 4 : 5;
    for (const std::size_t j : {static_cast<std::size_t>(8 - place), static_cast<std::size_t>(7 + place)})
      if (random.chance(0.9)) presence.there[j] = false;
    presence.room_left = random.chance(0.75) ? random.uniform(-0.02, 0.08) : random.uniform(0.1, 1.0);
    presence.why = "premolars taken out";
  } else if (kind < 0.75) {
    for (std::uint64_t n = 1 + random.index(3); n > 0; --n) {
      double at = random.uniform(0, 19.4);
      std::size_t j = 0;
      while (j + 1 < arch_places && at > how_often[static_cast<std::size_t>(arch_place(j) % 8)])
        at -= how_often[static_cast<std::size_t>(arch_place(j) % 8)], ++j;
      if (arch_place(j) < 8) presence.there[j] = false;
    }
    presence.room_left = random.chance(0.25) ? random.uniform(0.0, 0.3) : random.uniform(0.4, 1.1);
    presence.why = "teeth missing";
  } else if (kind < 0.9) {
    const bool both = random.chance(0.4), right = random.chance(0.5);
    const int last = 3 + static_cast<int>(random.index(3));
    for (std::size_t j = 0; j < arch_places; ++j)
      if (arch_place(j) > last && (both || (j < 8) == right)) presence.there[j] = false;
    presence.why = "shortened arch";
  } else {
    for (bool& there : presence.there)
      if (random.chance(0.4)) there = false;
    presence.room_left = random.uniform(0.6, 1.05);
    presence.why = "many teeth missing";
  }
}

Presence draw_presence(const ArchPerson& person, RandomStream& random, const ArchDrawOptions& options) {
  Presence presence;
  presence.there.fill(true);
  presence.there[0] = presence.there[arch_places - 1] = false;
  if (random.chance(options.wisdom_share) && !person.child) {
    const double kind = random.uniform();
    presence.there[0] = kind < 0.75;
    presence.there[arch_places - 1] = kind > 0.25;
  }
  // Second molars that are not through yet, or that the scanner did not reach.
  const double seconds = random.uniform();
  if (person.child || seconds < 0.12 * options.missing_share / 0.4)
    for (const std::size_t j : {std::size_t{1}, arch_places - 2})
      if (person.child || random.chance(0.8)) {
        presence.there[j] = false;
        presence.there[j == 1 ? 0 : arch_places - 1] = false;
      }
  if (random.chance(options.missing_share)) drop_some(presence, random);
  const auto left = std::count(presence.there.begin(), presence.there.end(), true);
  if (left < 4)
    for (std::size_t j = 3; j < 8; ++j) presence.there[j] = true;
  return presence;
}

/// A crown on its way to its place.
struct Standing {
  ArchCrown crown;
  Point place = Point::Zero();                     // of its middle in the arch as drawn
  double nominal = 0, along = 0;                   // where on the curve, as drawn and now
  double off = 0;                                  // mm towards the cheek
  double mean_turn = 0;                            // of the mean arch's line at it
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();  // rotation vector
  double gap = 0;                                  // mm to the next tooth towards the front
  bool there = true;
};

double angle_of(const Eigen::Vector2d& t) { return std::atan2(t.y(), t.x()); }

Eigen::Isometry3d pose_at(const ArchCrowns& arch, const Standing& one, double along) {
  const Eigen::Vector2d plan = arch.curve.at(along) + one.off * arch.outward_at(along);
  const double yaw = one.mean_turn - angle_of(arch.curve.tangent(along));
  const double size = one.turn.norm();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(plan.x(), one.place.y(), plan.y()));
  pose.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  if (size > 0) pose.rotate(Eigen::AngleAxisd(size, one.turn / size));
  return pose * one.crown.to_work;
}

/// How far two crowns are apart along a direction, seen in rods of that direction; large where none meets both.
double clearance(const TriangleMesh& a, const Eigen::Isometry3d& pose_a, const TriangleMesh& b,
                 const Eigen::Isometry3d& pose_b, const Eigen::Vector2d& direction) {
  constexpr int cells = 40;
  constexpr double cell = 0.6;
  std::vector<double> most(cells * cells, -1e9), least(cells * cells, 1e9);
  const Point middle = 0.5 * (pose_a.translation() + pose_b.translation());
  const Eigen::Vector3d t(direction.x(), 0, direction.y()), across(-direction.y(), 0, direction.x());
  const auto visit = [&](const TriangleMesh& mesh, const Eigen::Isometry3d& pose, auto&& see) {
    for (const Point& local : mesh.vertices) {
      const Point p = pose * local - middle;
      const int row = static_cast<int>(std::floor(p.y() / cell)) + cells / 2;
      const int column = static_cast<int>(std::floor(p.dot(across) / cell)) + cells / 2;
      if (row < 0 || row >= cells || column < 0 || column >= cells) continue;
      see(static_cast<std::size_t>(row * cells + column), p.dot(t));
    }
  };
  visit(a, pose_a, [&](std::size_t i, double value) { most[i] = std::max(most[i], value); });
  visit(b, pose_b, [&](std::size_t i, double value) { least[i] = std::min(least[i], value); });
  double result = 1e9;
  for (std::size_t i = 0; i < most.size(); ++i)
    if (most[i] > -1e8 && least[i] < 1e8) result = std::min(result, least[i] - most[i]);
  return result;
}

/// Moves `one` along the curve until it stands at the wanted gap from `before`. @param step 1: behind it, -1: before it
void bring_together(const ArchCrowns& arch, const Standing& before, Standing& one, double step, double gap) {
  const double widths = 0.5 * (before.crown.width + one.crown.width);
  one.along = before.along + step * widths;
  for (int round = 0; round < 4; ++round) {
    const Eigen::Vector2d direction = step * arch.curve.tangent(0.5 * (before.along + one.along));
    const double now = clearance(before.crown.mesh, pose_at(arch, before, before.along), one.crown.mesh,
                                 pose_at(arch, one, one.along), direction);
    if (now > 1e8) break;
    one.along -= step * std::clamp(now - gap, -2.5, 2.5);
  }
  // Teeth out of line may pass each other, but not by much.
  one.along = before.along + step * std::max(step * (one.along - before.along), 0.55 * widths);
}

/// Overlaps, gaps, turned and tilted teeth.
void disturb(const ArchPerson& person, std::vector<Standing>& teeth, RandomStream& random,
             const ArchDrawOptions& options) {
  for (std::size_t j = 0; j < arch_places; ++j) {
    Standing& one = teeth[j];
    const int place = arch_place(j);
    one.gap = random.normal(-0.02, 0.06);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
    if (person.crowded) {
      constexpr std::array<double, 9> share{0, 0.4, 1, 1, 0.3, 0.5, 0.1, 0.1, 0.3};
      const double size = person.room_mm * share[static_cast<std::size_t>(place)] * options.arrangement;
      const double side = place == 2 ? -1 : place == 3 ? 1 : random.chance(0.5) ? 1 : -1;
      one.off += size * (random.chance(0.85) ? side : -side) * random.uniform(0.1, 1.0);
      one.turn += random.normal(0.0, 11 * one_degree * size) * up;
      one.gap -= random.uniform(0.0, 0.12) * size;
    }
    if (person.spaced)
      one.gap += std::max(0.0, random.normal(person.room_mm, 0.7 * person.room_mm)) * (place <= 4 ? 1 : 0.5);
    if (random.chance(0.03 * options.arrangement)) one.gap += random.uniform(0.2, 2.0);
    if (random.chance(0.04 * options.arrangement)) {
      const bool premolar = place == 4 || place == 5;
      one.turn += random.uniform(-1, 1) * (premolar ? 80 : 35) * one_degree * up;
    }
    if (random.chance(0.03 * options.arrangement)) one.place.y() += random.uniform(-2.0, 1.8);
    if (random.chance(0.02 * options.arrangement)) one.off += random.uniform(-2.5, 2.5);
  }
}

/// Teeth beside a gap lean into it.
void lean_into_gaps(const ArchCrowns& arch, std::vector<Standing>& teeth, const Presence& presence,
                    RandomStream& random, double factor) {
  for (std::size_t j = 1; j + 1 < arch_places; ++j) {
    if (!teeth[j].there) continue;
    for (const int side : {-1, 1}) {
      const std::size_t other = j + static_cast<std::size_t>(side);
      const bool behind = (j < 8) == (side > 0);  // the gap is towards the front
      if (teeth[other].there || arch_place(other) >= 7 || presence.room_left < 0.1) continue;
      const Eigen::Vector2d t = side * arch.curve.tangent(teeth[j].nominal);
      const Eigen::Vector3d axis = Eigen::Vector3d::UnitY().cross(Eigen::Vector3d(t.x(), 0, t.y()));
      teeth[j].turn += factor * std::max(0.0, random.normal(behind ? 10 : 3, behind ? 9 : 4)) * one_degree * axis;
    }
  }
}

/// From the middle outwards, each tooth against the one before it.
void close_contacts(const ArchCrowns& arch, std::vector<Standing>& teeth, const Presence& presence,
                    RandomStream& random) {
  std::vector<double> room(arch_places);
  for (double& r : room) r = std::max(0.0, presence.room_left * random.normal(1.0, 0.12));
  const double middle = 0.5 * (teeth[7].nominal + teeth[8].nominal) + random.normal(0.0, 0.6);
  teeth[8].along = middle + 0.5 * teeth[8].crown.width;
  const auto step_to = [&](std::size_t from, std::size_t to, double step) {
    double gap = teeth[to].gap;
    for (std::size_t j = from; j != to; j = step > 0 ? j + 1 : j - 1)
      if (j != from) gap += room[j] * teeth[j].crown.width;
    bring_together(arch, teeth[from], teeth[to], step, gap);
    for (std::size_t j = step > 0 ? from + 1 : from - 1; j != to; j = step > 0 ? j + 1 : j - 1) {
      const double share = std::abs(static_cast<double>(j) - static_cast<double>(from)) /
                           std::abs(static_cast<double>(to) - static_cast<double>(from));
      teeth[j].along = teeth[from].along + share * (teeth[to].along - teeth[from].along);
    }
  };
  // A missing tooth in the middle is a place like another: the chain begins with what is nearest to it.
  std::size_t first = 8;
  while (first + 1 < arch_places && !teeth[first].there) ++first;
  if (first != 8) {
    teeth[first].along = teeth[first].nominal;
    for (std::size_t j = 8; j < first; ++j) teeth[j].along = teeth[j].nominal;
  }
  std::size_t last = first;
  for (std::size_t j = first + 1; j < arch_places; ++j)
    if (teeth[j].there) step_to(last, j, 1), last = j;
  for (std::size_t j = last + 1; j < arch_places; ++j) teeth[j].along = teeth[j - 1].along + 0.9 * teeth[j].crown.width;
  last = first;
  for (std::size_t j = first; j-- > 0;)
    if (teeth[j].there) step_to(last, j, -1), last = j;
  for (std::size_t j = last; j-- > 0;) teeth[j].along = teeth[j + 1].along - 0.9 * teeth[j].crown.width;
}

/// The ridge where a tooth is missing: lower, narrower.
void make_ghost(ArchCrown& crown, double lower, double narrower) {
  crown.ghost = true;
  crown.mesh = {};
  for (double& r : crown.rim.radius) r *= narrower;
  double mean = 0;
  for (const double h : crown.rim.height) mean += h / rim_sectors;
  for (double& h : crown.rim.height) h = 0.2 * (h - mean) - lower;
}

void add_details(const ArchPerson& person, ArchCrowns& arch, RandomStream& random, const ArchDrawOptions& options) {
  const bool stumps = random.chance(options.stump_share);
  const bool plates = !person.brackets && random.chance(options.bracket_share);
  const std::size_t first_stump = random.index(arch_places), stump_count = 1 + random.index(4);
  std::size_t j = 0;
  for (ArchCrown& crown : arch.crowns) {
    const double kind = random.uniform();
    const int place = crown.fdi % 10;
    crown.margin_shift = person.margin_shift + options.shape * random.normal(0.0, 0.25);
    crown.wear_mm = person.wear_mm * random.uniform(0.4, 1.2) * (place <= 3 ? 1.0 : 0.7);
    crown.stump = stumps && j >= first_stump && j < first_stump + stump_count;
    crown.bracket = person.brackets && kind < 0.93 && place <= 7;
    crown.attachment = plates && kind < 0.45;
    if (place == 8 ? kind < 0.45 : place == 7 && kind < 0.12) {
      crown.hood_mm = random.uniform(1, 4.5);
      crown.to_work.translation().y() -= random.uniform(0.2, 2.0);
    } else if (kind > 0.985) {
      crown.margin_shift += random.uniform(0.8, 2.5);  // on its way through
    }
    ++j;
  }
  if (stumps) arch.drawn.emplace_back("stumps");
  if (person.brackets) arch.drawn.emplace_back("brackets");
  if (plates) arch.drawn.emplace_back("attachments");
}

PlanCurve curve_through(const std::vector<Standing>& teeth) {
  std::vector<Eigen::Vector2d> knots;
  for (const Standing& one : teeth) knots.emplace_back(one.place.x(), one.place.z());
  // The middle of the front is a place of its own, between two: means of neighbours keep the curve smooth.
  std::vector<Eigen::Vector2d> smooth = knots;
  for (std::size_t i = 1; i + 1 < knots.size(); ++i)
    smooth[i] = 0.25 * knots[i - 1] + 0.5 * knots[i] + 0.25 * knots[i + 1];
  for (std::size_t i = 1; i + 1 < knots.size(); ++i) knots[i] += 0.5 * (smooth[i] - knots[i]);
  return PlanCurve(knots);
}

}  // namespace

ArchCrowns draw_crowns(const ArchSource& source, const ArchPerson& person, Jaw jaw, std::uint64_t seed,
                       const ArchDrawOptions& options) {
  RandomStream random(seed, jaw == Jaw::upper ? 501 : 502);
  std::vector<LooseCrown> loose = draw_loose_crowns(source, person, jaw, random, options);
  const double factor = options.arrangement * (person.real_person >= 0 ? 0.5 : person.disorder);
  const Deviations deviations = draw_deviations(source, jaw, factor, random);
  const Presence presence = draw_presence(person, random, options);
  std::vector<Standing> teeth(arch_places);
  const double small = person.child ? random.uniform(0.86, 0.96) : 1;
  for (std::size_t j = 0; j < arch_places; ++j) {
    Standing& one = teeth[j];
    one.crown = std::move(loose[j].crown);
    one.place = (loose[j].place + deviations.smooth[j]).cwiseProduct(Eigen::Vector3d(small, 1, small));
    one.mean_turn = angle_of(loose[j].tangent);
    one.turn = deviations.turn[j];
    one.there = presence.there[j];
  }
  ArchCrowns arch{jaw, curve_through(teeth), jaw == Jaw::upper ? -1.0 : 1.0, {}, {}, 1, {}};
  for (std::size_t j = 0; j < arch_places; ++j) {
    Standing& one = teeth[j];
    one.nominal = one.along = arch.curve.nearest({one.place.x(), one.place.z()});
    one.off = arch.outward_at(one.nominal).dot(Eigen::Vector2d(deviations.own[j].x(), deviations.own[j].z()));
    one.place.y() += deviations.own[j].y();
  }
  disturb(person, teeth, random, options);
  lean_into_gaps(arch, teeth, presence, random, options.arrangement);
  close_contacts(arch, teeth, presence, random);
  double sizes = 0;
  for (const double size : person.size) sizes += size / static_cast<double>(person.size.size());
  arch.size = sizes;
  const double ridge = random.uniform(0.3, 2.2);
  for (std::size_t j = 0; j < arch_places; ++j) {
    Standing& one = teeth[j];
    const int place = arch_place(j);
    if (!one.there && place < 8)
      arch.missing.push_back(one.crown.fdi % 10 +
                             10 * (one.crown.fdi / 10 > 4 ? one.crown.fdi / 10 - 4 : one.crown.fdi / 10));
    if (!one.there)
      make_ghost(one.crown, ridge + random.uniform(0.0, 0.8) + (place == 8 ? 0.6 : 0), random.uniform(0.75, 0.95));
    one.crown.to_work = pose_at(arch, one, one.along);
    one.crown.along = one.along;
    arch.crowns.push_back(std::move(one.crown));
  }
  if (person.crowded) arch.drawn.emplace_back("crowding");
  if (person.spaced) arch.drawn.emplace_back("spacing");
  if (person.child) arch.drawn.emplace_back("milk teeth");
  if (person.real_person >= 0) arch.drawn.emplace_back("crowns of a real person");
  if (person.wear_mm > 0.5) arch.drawn.emplace_back("wear");
  if (!presence.why.empty()) arch.drawn.push_back(presence.why);
  add_details(person, arch, random, options);
  return arch;
}

}  // namespace rhizodont
