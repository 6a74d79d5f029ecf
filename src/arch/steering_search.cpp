// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/steering_search.hpp"

#include "arch/least_change.hpp"
#include "base/parallel_tasks.hpp"
#include "mesh/at.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace rhizodont {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double reach = 1.0;         // mm beyond what is wanted from which on zones have no say in a step
constexpr double to_be_sure = 0.01;   // mm that are sought beyond what is wanted, for rounding
constexpr double longest_step = 0.7;  // mm, of each variable
constexpr double least_step = 5e-3;
constexpr double not_touching = 0.05;  // mm: what comes nearer counts as a collision
// Per mm. A root may move far to be out of another one; for more room it may not where it hardly gains any.
constexpr WishPrice price_of_collision{4e3, 4e3}, price_of_room{4e3, 40};
constexpr int turns = 4;  // variables per tooth: tip, torque, bend, length

using Change = Eigen::Vector4d;  // what tip, torque, bend and length of one tooth cost, mm

/// From costs to steering and back, of one tooth.
struct Levers {
  const SteerableRoot* root;
  Change per_unit;  // degrees, and mm of length, per mm of cost
  Change low, high;

  Levers(const SteerableRoot& given, bool fixed, const SteeringSearchOptions& options) : root(&given) {
    // A turned root starts over 3 mm, a bent one over its lower half: see `steer_root`.
    const double turn_lever = std::max(given.length_mm - 1.5, 1.0), bend_lever = std::max(given.length_mm / 4, 0.5);
    per_unit << 1 / (turn_lever * degree), 1 / (turn_lever * degree), 1 / (options.bend_weight * bend_lever * degree),
        1 / options.shorten_weight;
    const RootSteering& start = given.start;
    const Change now(start.tip_degrees, start.torque_degrees, start.bend_degrees, 0);
    const Change range(30, 30, 45, 0);
    const Change most(options.largest_turn_degrees, options.largest_turn_degrees, options.largest_bend_degrees, 0);
    low = (-range - now).cwiseMax(-most).cwiseMin(0).cwiseQuotient(per_unit);
    high = (range - now).cwiseMin(most).cwiseMax(0).cwiseQuotient(per_unit);
    if (!start.length_mm) high[3] = std::max(0.0, given.length_mm - shortest()) / per_unit[3];
    if (fixed) low = high = Change::Zero();
  }

  double shortest() const { return std::max(root->shortest_mm, shortest_root_mm); }

  static double rounded(double value) { return std::round(100 * value) / 100; }

  /// A change of 0 leaves the start's bits.
  RootSteering steering(const Change& x, bool round) const {
    const Change by = x.cwiseProduct(per_unit);
    RootSteering wish = root->start;
    const auto change = [&](double& value, double more) {
      if (more != 0) value = round ? rounded(value + more) : value + more;
    };
    change(wish.tip_degrees, by[0]);
    change(wish.torque_degrees, by[1]);
    change(wish.bend_degrees, by[2]);
    if (by[3] == 0) return wish;
    // A turned root reaches less far down by itself.
    const double whole = root->length(wish);
    const double shorter = std::max(shortest(), round ? rounded(whole - by[3]) : whole - by[3]);
    if (shorter < whole) wish.length_mm = shorter;
    return wish;
  }

  Change cost(const RootSteering& wish) const {
    RootSteering whole = wish;
    whole.length_mm = root->start.length_mm;
    const bool shortened = wish.length_mm && !root->start.length_mm;
    const Change by(wish.tip_degrees - root->start.tip_degrees, wish.torque_degrees - root->start.torque_degrees,
                    wish.bend_degrees - root->start.bend_degrees,
                    shortened ? root->length(whole) - *wish.length_mm : 0);
    return by.cwiseQuotient(per_unit);
  }
};

bool moves(int zone) { return zone > static_cast<int>(RootZone::neck); }
bool is_crown(int zone) { return zone == static_cast<int>(RootZone::crown); }

/// The vertices of a root, or nothing for a steering that cannot be made.
std::vector<Point> vertices_or_none(const SteerableRoot& root, const RootSteering& steering) {
  try {
    return root.vertices(steering);
  } catch (const Error&) {
    return {};
  }
}

using Clearances = std::vector<std::optional<Approach>>;

/// All teeth with some change.
struct Stand {
  Eigen::VectorXd x;
  std::vector<std::shared_ptr<const SolidSurface>> teeth;  // null where one cannot be steered
  std::vector<Clearances> clearances;                      // per pair
  double merit = std::numeric_limits<double>::infinity();
};

struct PairWish {
  ToothPair teeth;
  double wanted;
  std::vector<double> least;  // per pair of zones; minus infinity where nothing is asked
};

class Search {
 public:
  Search(const std::vector<SteerableRoot>& roots, const SteeringSearchOptions& options,
         const std::map<ToothPair, double>& extra)
      : roots_(roots), options_(options) {
    zones_.resize(roots.size());
    parallel_tasks(roots.size(), [&](std::size_t i) { zones_[i] = root_zones(roots[i]); });
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const bool fixed = std::none_of(zones_[i].begin(), zones_[i].end(), moves);
      levers_.emplace_back(roots[i], fixed, options);
    }
    for (std::size_t i = 0; i < roots.size(); ++i)
      for (std::size_t j = i + 1; j < roots.size(); ++j) {
        const auto more = extra.find({i, j});
        pairs_.push_back({{i, j}, options.clearance + (more == extra.end() ? 0 : more->second), {}});
      }
    now_.x = Eigen::VectorXd::Zero(turns * static_cast<Eigen::Index>(roots.size()));
    now_.teeth.resize(roots.size());
    now_.clearances.resize(pairs_.size());
    std::vector<char> all(roots.size(), 1);
    place(now_, all);
    set_wishes();
    now_.merit = merit(now_);
  }

  void run() {
    approach();
    if (leap_apart()) approach();
    if (leave_small_changes()) approach();
  }

  FoundSteering result() const {
    FoundSteering found;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      const Change x = change_of(now_.x, i);
      found.steering.push_back(levers_[i].steering(x, true));
      found.cost_mm.push_back(levers_[i].cost(found.steering.back()).norm());
      const auto& lever = levers_[i];
      found.at_limit.push_back((x.array() != 0 && (x - lever.low).cwiseMin(lever.high - x).array() < 1e-6 &&
                                lever.low.array() < lever.high.array())
                                   .any());
    }
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      std::vector<double> missing(pairs_[k].least.size(), 0);
      for_each_missing(k, now_, 0, [&](int z, const Approach& approach, double least) {
        missing[at(z)] = std::max(0.0, least - to_be_sure - approach.mm);
      });
      if (std::any_of(missing.begin(), missing.end(), [](double mm) { return mm > 0; }))
        found.missing[pairs_[k].teeth] = std::move(missing);
    }
    return found;
  }

 private:
  void approach() {
    double longest = longest_step;
    for (int step = 0; step < options_.steps && missing_anything() && longest > least_step; ++step) {
      const Eigen::VectorXd x = proposal(longest);
      if ((x - now_.x).cwiseAbs().maxCoeff() < least_step) break;
      Stand next = moved_to(x);
      if (next.merit < now_.merit) {
        const bool hardly = next.merit > (1 - 1e-4) * now_.merit;
        now_ = std::move(next);
        if (hardly) break;
        longest = std::min(longest_step, 1.5 * longest);
      } else {
        longest *= 0.4;
      }
    }
  }

  bool run_into_each_other(std::size_t k) const {
    bool collide = false;
    for_each_missing(k, now_, 0, [&](int z, const Approach& approach, double) {
      collide |= approach.mm < 0 && (moves(z / root_zone_count) || moves(z % root_zone_count));
    });
    return collide;
  }

  /// Roots that have gone past each other's middle see the nearest way out on the wrong side, and small steps leave
  /// them there: tries large ones, for each pair still in each other. False if none is better.
  bool leap_apart() {
    constexpr std::array<std::array<int, 4>, 6> ways{
        // tip and torque of the first tooth, then of the second
        {{1, 0, -1, 0}, {-1, 0, 1, 0}, {1, 0, 1, 0}, {-1, 0, -1, 0}, {0, 1, 0, -1}, {0, -1, 0, 1}}};
    bool any = false;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!run_into_each_other(k)) continue;
      const auto [i, j] = pairs_[k].teeth;
      Stand best = now_;
      for (const double far : {1.0, 2.0, 3.5})
        for (const auto& way : ways) {
          Eigen::VectorXd x = now_.x;
          for (const auto& [tooth, first] : {std::pair(i, std::size_t{0}), std::pair(j, std::size_t{2})}) {
            auto change = x.segment<turns>(turns * static_cast<Eigen::Index>(tooth));
            change[0] += far * way[first];
            change[1] += far * way[first + 1];
            change = change.cwiseMax(levers_[tooth].low).cwiseMin(levers_[tooth].high).eval();
          }
          Stand there = moved_to(x);
          if (there.merit < best.merit) best = std::move(there);
        }
      any |= best.merit < now_.merit;
      now_ = std::move(best);
    }
    return any;
  }

  /// Takes back what adds little to a root's change, for good: a turn alone is easier told than one with a trace of
  /// everything. False if there is no such thing.
  bool leave_small_changes() {
    constexpr double little = 0.1;  // of the whole change, and mm
    Stand next = now_;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      auto x = next.x.segment<turns>(turns * static_cast<Eigen::Index>(i));
      const double whole = x.norm();
      for (Eigen::Index k = 0; k < turns; ++k) {
        if (x[k] == 0 || std::abs(x[k]) > little * std::min(1.0, whole)) continue;
        x[k] = levers_[i].low[k] = levers_[i].high[k] = 0;
      }
    }
    if (next.x == now_.x) return false;
    now_ = moved_to(next.x);
    return true;
  }

  static Change change_of(const Eigen::VectorXd& x, std::size_t tooth) {
    return x.segment<turns>(turns * static_cast<Eigen::Index>(tooth));
  }

  /// Calls `use(zones, approach, least)` for clearances of pair k that are less than asked for and `beyond`.
  template <class Use>
  void for_each_missing(std::size_t k, const Stand& stand, double beyond, const Use& use) const {
    if (stand.clearances[k].empty()) return;
    for (std::size_t z = 0; z < pairs_[k].least.size(); ++z) {
      const std::optional<Approach>& approach = stand.clearances[k][z];
      if (approach && approach->mm < pairs_[k].least[z] + beyond)
        use(static_cast<int>(z), *approach, pairs_[k].least[z]);
    }
  }

  bool missing_anything() const {
    bool any = false;
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      for_each_missing(k, now_, 0, [&](int, const Approach&, double) { any = true; });
    return any || !now_.x.isZero(0);
  }

  double merit(const Stand& stand) const {
    double sum = stand.x.squaredNorm();
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      for_each_missing(k, stand, 0, [&](int, const Approach& approach, double least) {
        sum += price_of(least - approach.mm, price_of_room);
        sum += price_of(std::max(0.0, std::min(least, not_touching) - approach.mm), price_of_collision);
      });
    return sum;
  }

  /// Builds the teeth that are marked, and measures their pairs. False if one of them cannot be made.
  bool place(Stand& stand, const std::vector<char>& marked) const {
    parallel_tasks(roots_.size(), [&](std::size_t i) {
      if (!marked[i]) return;
      const SteerableRoot& root = roots_[i];
      std::vector<Point> vertices = vertices_or_none(root, levers_[i].steering(change_of(stand.x, i), false));
      stand.teeth[i] = vertices.empty()
                           ? nullptr
                           : std::make_shared<SolidSurface>(TriangleMesh{std::move(vertices), root.triangles},
                                                            zones_[i], root_zone_count);
    });
    for (std::size_t i = 0; i < roots_.size(); ++i)
      if (marked[i] && !stand.teeth[i] && !stand.x.isZero(0)) return false;
    parallel_tasks(pairs_.size(), [&](std::size_t k) {
      const auto [i, j] = pairs_[k].teeth;
      if (!marked[i] && !marked[j]) return;
      stand.clearances[k].clear();
      const double within = pairs_[k].wanted + reach + to_be_sure;
      if (!stand.teeth[i] || !stand.teeth[j]) return;
      if (stand.teeth[i]->box().squared_gap(stand.teeth[j]->box()) >= within * within) return;
      stand.clearances[k] = part_clearances(*stand.teeth[i], *stand.teeth[j], within);
    });
    return true;
  }

  Stand moved_to(const Eigen::VectorXd& x) const {
    Stand next = now_;
    next.x = x;
    std::vector<char> marked;
    for (std::size_t i = 0; i < roots_.size(); ++i) marked.push_back(change_of(x, i) != change_of(now_.x, i));
    next.merit = place(next, marked) ? merit(next) : std::numeric_limits<double>::infinity();
    return next;
  }

  /// What is asked of each pair of zones, by how they stand at the start.
  void set_wishes() {
    constexpr double may_come_nearer = 0.1;  // mm, at necks: else hardly any root could turn
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      PairWish& pair = pairs_[k];
      for (int z = 0; z < root_zone_count * root_zone_count; ++z) {
        const int i = z / root_zone_count, j = z % root_zone_count;
        double least = pair.wanted + to_be_sure;
        if (is_crown(i) && is_crown(j)) {
          least = -std::numeric_limits<double>::infinity();
        } else if (!moves(i) && !moves(j)) {
          const bool near = !now_.clearances[k].empty() && now_.clearances[k][at(z)];
          least = std::min(options_.clearance, near ? now_.clearances[k][at(z)]->mm - may_come_nearer : least);
        }
        pair.least.push_back(least);
      }
    }
  }

  /// How the vertices of each tooth move per mm of each variable; of teeth without a say none.
  std::vector<std::array<std::vector<Eigen::Vector3d>, turns>> rates(const std::vector<char>& asked) const {
    std::vector<std::array<std::vector<Eigen::Vector3d>, turns>> all(roots_.size());
    parallel_tasks(turns * roots_.size(), [&](std::size_t n) {
      constexpr double by = 0.05;  // mm
      const std::size_t tooth = n / turns, variable = n % turns;
      if (!asked[tooth]) return;
      const Change here = change_of(now_.x, tooth);
      const auto i = static_cast<Eigen::Index>(variable);
      Change less = here, more = here;
      less[i] = std::max(levers_[tooth].low[i], here[i] - by);
      more[i] = std::min(levers_[tooth].high[i], here[i] + by);
      if (!(more[i] > less[i])) return;
      std::vector<Point> from = vertices_or_none(roots_[tooth], levers_[tooth].steering(less, false));
      const std::vector<Point> to = vertices_or_none(roots_[tooth], levers_[tooth].steering(more, false));
      if (from.empty() || to.empty()) return;
      for (std::size_t v = 0; v < from.size(); ++v) from[v] = (to[v] - from[v]) / (more[i] - less[i]);
      all[tooth][variable] = std::move(from);
    });
    return all;
  }

  /// How much the point of a triangle moves along a direction, if its corners move so.
  static double rate_at(const SolidSurface& tooth, int triangle, const Point& p, const Eigen::Vector3d& along,
                        const std::vector<Eigen::Vector3d>& rates) {
    const std::array<double, 3> shares = tooth.barycentric(triangle, p);
    const Triangle& t = tooth.mesh().triangles[at(triangle)];
    return along.dot(shares[0] * rates[at(t[0])] + shares[1] * rates[at(t[1])] + shares[2] * rates[at(t[2])]);
  }

  /// The least change that would do if clearances went on as they do here.
  Eigen::VectorXd proposal(double longest) const {
    std::vector<char> asked(roots_.size(), 0);
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      for_each_missing(k, now_, reach, [&](int, const Approach&, double) {
        asked[pairs_[k].teeth.first] = asked[pairs_[k].teeth.second] = 1;
      });
    const auto moving = rates(asked);
    std::vector<LinearWish> wishes;
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      for_each_missing(k, now_, reach, [&](int, const Approach& approach, double least) {
        wishes.push_back(linear_wish(pairs_[k].teeth, approach, least, moving));
        wishes.back().price = price_of_room;
        if (approach.mm > not_touching + reach) return;
        wishes.push_back(wishes.back());
        wishes.back().least -= std::max(0.0, least - not_touching);
        wishes.back().price = price_of_collision;
      });
    Eigen::VectorXd low = now_.x, high = now_.x;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      const Eigen::Index first = turns * static_cast<Eigen::Index>(i);
      low.segment<turns>(first) = (change_of(now_.x, i).array() - longest).matrix().cwiseMax(levers_[i].low);
      high.segment<turns>(first) = (change_of(now_.x, i).array() + longest).matrix().cwiseMin(levers_[i].high);
    }
    return least_change(wishes, low, high);
  }

  LinearWish linear_wish(const ToothPair& teeth, const Approach& approach, double least,
                         const std::vector<std::array<std::vector<Eigen::Vector3d>, turns>>& moving) const {
    const SolidSurface &first = *now_.teeth[teeth.first], &second = *now_.teeth[teeth.second];
    Eigen::Vector3d along = approach.on_first - approach.on_second;
    if (approach.mm < 0) along = -along;
    // Points that touch tell no direction; the surface does.
    if (along.norm() < 1e-9) along = triangle_normal(second.mesh(), at(approach.second_triangle));
    along.normalize();
    LinearWish wish;
    wish.least = least - approach.mm;
    const auto add = [&](std::size_t tooth, const SolidSurface& surface, int triangle, const Point& p, double sign) {
      for (std::size_t variable = 0; variable < turns; ++variable) {
        const std::vector<Eigen::Vector3d>& rates = moving[tooth][variable];
        const double rate = rates.empty() ? 0 : sign * rate_at(surface, triangle, p, along, rates);
        if (rate == 0) continue;
        const int number = static_cast<int>(turns * tooth + variable);
        wish.terms.emplace_back(number, rate);
        wish.least += rate * now_.x[number];
      }
    };
    add(teeth.first, first, approach.first_triangle, approach.on_first, 1);
    add(teeth.second, second, approach.second_triangle, approach.on_second, -1);
    return wish;
  }

  const std::vector<SteerableRoot>& roots_;
  SteeringSearchOptions options_;
  std::vector<std::vector<int>> zones_;
  std::vector<Levers> levers_;
  std::vector<PairWish> pairs_;
  Stand now_;
};

}  // namespace

void require_options_in_range(const SteeringSearchOptions& options) {
  const auto require = [](bool holds, const char* what, double value) {
    if (!holds) throw UsageError(fmt::format("{} of {} is out of its range.", what, value));
  };
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  require(within(options.clearance, 0, 3), "A clearance (mm, 0 to 3)", options.clearance);
  require(within(options.bend_weight, 1, 1e3), "A weight of bends (1 to 1000)", options.bend_weight);
  require(within(options.shorten_weight, 1, 1e3), "A weight of shortening (1 to 1000)", options.shorten_weight);
  require(within(options.largest_turn_degrees, 1e-3, 60), "A largest turn (degrees, up to 60)",
          options.largest_turn_degrees);
  require(within(options.largest_bend_degrees, 1e-3, 90), "A largest bend (degrees, up to 90)",
          options.largest_bend_degrees);
  require(options.steps >= 0, "A number of steps", options.steps);
}

std::vector<int> root_zones(const SteerableRoot& root) {
  const std::vector<Point> now = vertices_or_none(root, root.start);
  std::vector<double> movement(root.source.size(), 0);
  for (double RootSteering::*const turn : {&RootSteering::tip_degrees, &RootSteering::torque_degrees}) {
    RootSteering turned = root.start;
    turned.*turn += turned.*turn > 0 ? -10 : 10;
    const std::vector<Point> there = root.may_change ? vertices_or_none(root, turned) : std::vector<Point>();
    if (now.empty() || there.empty()) continue;
    for (std::size_t v = 0; v < now.size(); ++v) movement[v] = std::max(movement[v], (there[v] - now[v]).norm());
  }
  const double most = movement.empty() ? 0 : *std::max_element(movement.begin(), movement.end());
  std::vector<int> zones;
  for (const Triangle& t : root.triangles) {
    double share = 0;
    bool crown = true;
    for (const int v : t) {
      if (most > 0.1) share = std::max(share, movement[at(v)] / most);
      crown &= root.source[at(v)] == VertexSource::scan;
    }
    const RootZone zone = crown          ? RootZone::crown
                          : share < 0.05 ? RootZone::neck
                          : share < 0.35 ? RootZone::upper
                          : share < 0.65 ? RootZone::middle
                                         : RootZone::lower;
    zones.push_back(static_cast<int>(zone));
  }
  return zones;
}

std::vector<double> missing_where_roots_move(const SolidSurface& first, const SolidSurface& second, double wanted) {
  std::vector<double> missing(at(first.part_count() * second.part_count()), 0);
  if (first.box().squared_gap(second.box()) > wanted * wanted) return missing;
  const auto clearances = part_clearances(first, second, wanted + to_be_sure);
  for (int i = 0; i < first.part_count(); ++i)
    for (int j = 0; j < second.part_count(); ++j) {
      const int z = i * second.part_count() + j;
      if ((moves(i) || moves(j)) && clearances[at(z)]) missing[at(z)] = std::max(0.0, wanted - clearances[at(z)]->mm);
    }
  return missing;
}

FoundSteering find_least_steering(const std::vector<SteerableRoot>& roots, const SteeringSearchOptions& options,
                                  const std::map<ToothPair, double>& extra) {
  require_options_in_range(options);
  Search search(roots, options, extra);
  search.run();
  return search.result();
}

}  // namespace rhizodont
