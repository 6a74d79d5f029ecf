// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/resolve_collisions.hpp"

#include "base/parallel_tasks.hpp"
#include "mesh/at.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace rhizodont {
namespace {

constexpr double enough = 1e-3;  // mm: to be as near as this to what was wanted is to have it
constexpr double hardly_less = 0.9;

bool same(const RootSteering& a, const RootSteering& b) {
  return a.length_mm == b.length_mm && a.tip_degrees == b.tip_degrees && a.torque_degrees == b.torque_degrees &&
         a.bend_degrees == b.bend_degrees;
}

/// The parts that clearances are told by. Anew wherever a tooth is pressed: vertices go from one to the other.
std::vector<VertexSource> crown_and_root(const SourcedTooth& tooth, const TriangleMesh& pressed) {
  std::vector<VertexSource> parts = tooth.source;
  if (tooth.up.isZero(0)) return parts;
  for (std::size_t v = 0; v < parts.size(); ++v)
    if (tooth.up.dot(pressed.vertices[v]) > tooth.root_begins) parts[v] = VertexSource::scan;
  return parts;
}

/// A finished tooth in the zones of its trial tooth: each new triangle is where the trial tooth is nearest. `trial`: so
/// steered; empty of a root that stays as it is, all of which is neck.
SolidSurface in_zones(const TriangleMesh& tooth, const std::vector<VertexSource>& source, const TriangleMesh& trial,
                      const std::vector<int>& trial_zones) {
  std::optional<SolidSurface> guide;
  if (!trial.vertices.empty()) guide.emplace(trial, trial_zones, root_zone_count);
  std::vector<int> zones(tooth.triangles.size(), static_cast<int>(RootZone::crown));
  tbb::parallel_for(std::size_t{0}, zones.size(), [&](std::size_t k) {
    const Triangle& t = tooth.triangles[k];
    if (std::all_of(t.begin(), t.end(), [&](int v) { return source[at(v)] == VertexSource::scan; })) return;
    Point middle = Point::Zero();
    for (const int v : t) middle += tooth.vertices[at(v)] / 3;
    const int zone = guide ? guide->part_of(guide->signed_distance(middle)->triangle) : 0;
    zones[k] = std::max(zone, static_cast<int>(RootZone::neck));
  });
  return SolidSurface(tooth, std::move(zones), root_zone_count);
}

/// The teeth as made in one round.
struct Round {
  std::vector<RootSteering> steering;
  std::vector<SourcedTooth> teeth;  // before they are pressed apart
  PressedTeeth pressed;
  std::vector<double> cost;
  std::vector<bool> at_limit;
  std::map<ToothPair, std::vector<double>> missing;  // per pair of zones, where roots move; of finished teeth

  /// As the search weighs it: to run into another root is ten times as bad as to lack room.
  double all_missing(double wanted) const {
    double sum = 0;
    for (const auto& [pair, zones] : missing)
      for (const double mm : zones) sum += mm + 10 * std::max(0.0, mm - wanted);
    return sum;
  }
};

class Resolving {
 public:
  Resolving(const std::vector<SteerableRoot>& roots, const std::vector<SourcedTooth>& teeth, const FinishTooth& finish,
            const ResolveOptions& options)
      : roots_(roots), finish_(finish), options_(options) {
    for (const SteerableRoot& root : roots_) now_.steering.push_back(root.start);
    now_.teeth = teeth;
    now_.cost.assign(teeth.size(), 0);
    now_.at_limit.assign(teeth.size(), false);
    for (const SourcedTooth& tooth : teeth) now_.pressed.meshes.push_back(tooth.mesh);
    now_.pressed.largest_mm.assign(teeth.size(), 0);
    zoned_.resize(teeth.size());
  }

  ResolvedCollisions run() {
    ResolvedCollisions resolved;
    const bool any_too_near = !too_near().empty();
    // Also where roots stand apart: what closes crowns at their contacts is no root.
    press();
    Round best = now_;
    if (any_too_near) {
      press_trials();
      measure();
      best = now_;
      std::map<ToothPair, double> extra;
      for (int round = 0; round < options_.rounds; ++round) {
        const FoundSteering found = find_least_steering(roots_, options_.search, extra);
        const bool all_made = make(found, resolved.notes);
        press();
        measure();
        const double before = best.all_missing(wanted()), after = now_.all_missing(wanted());
        if (after < before - enough) best = now_;
        // Rounds that help are worth their time; a tooth that could not be made is worth another.
        if (all_made && (after > hardly_less * before || !ask_for_more(found, extra))) break;
      }
    }
    now_ = std::move(best);
    resolved.unresolved = unresolved();
    resolved.steering = std::move(now_.steering);
    resolved.teeth = std::move(now_.teeth);
    for (std::size_t i = 0; i < resolved.teeth.size(); ++i) resolved.teeth[i].mesh = std::move(now_.pressed.meshes[i]);
    resolved.pressed_mm = std::move(now_.pressed.largest_mm);
    resolved.cost_mm = std::move(now_.cost);
    return resolved;
  }

 private:
  double wanted() const { return options_.search.clearance; }

  /// The smallest clearances of roots that are less than wanted.
  std::map<ToothPair, double> too_near() const {
    std::vector<std::unique_ptr<const SolidSurface>> teeth(now_.teeth.size());
    parallel_tasks(teeth.size(), [&](std::size_t i) {
      teeth[i] = std::make_unique<SolidSurface>(
          tooth_surface(now_.pressed.meshes[i], crown_and_root(now_.teeth[i], now_.pressed.meshes[i])));
    });
    std::vector<const SolidSurface*> surfaces(teeth.size());
    std::transform(teeth.begin(), teeth.end(), surfaces.begin(), [](const auto& tooth) { return tooth.get(); });
    NeighbourOptions near;
    near.within = wanted() + enough;
    std::map<ToothPair, double> found;
    for (const NeighbourClearance& n : neighbour_clearances(surfaces, near))
      if (const auto nearest = n.clearance.of_roots(); nearest && nearest->mm < wanted() - enough)
        found[{n.first, n.second}] = nearest->mm;
    return found;
  }

  void press() {
    std::vector<JoinedTooth> joined(now_.teeth.size());
    for (std::size_t i = 0; i < joined.size(); ++i) {
      const SourcedTooth& tooth = now_.teeth[i];
      joined[i].mesh = tooth.mesh;
      joined[i].crown_vertices = tooth.scanned_vertices;
      joined[i].crown_triangles = tooth.scanned_triangles;
    }
    PressedTeeth pressed = press_apart(joined, options_.press);
    for (std::size_t i = 0; i < joined.size(); ++i)
      if (pressed.meshes[i].vertices != now_.pressed.meshes[i].vertices) zoned_[i] = nullptr;
    now_.pressed = std::move(pressed);
  }

  /// The trial teeth give way, too, where turning moves them little: else roots would be turned as far as they may for
  /// what pressing does better. What lies farther down shall turn out of the other's way.
  void press_trials() {
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      SteerableRoot& root = roots_[i];
      // A tooth that its user steered has other triangles than its trial.
      if (now_.pressed.largest_mm[i] == 0 || root.start.any() || now_.teeth[i].mesh.triangles != root.triangles)
        continue;
      std::vector<Eigen::Vector3d> moves(now_.teeth[i].mesh.vertices.size());
      for (std::size_t v = 0; v < moves.size(); ++v)
        moves[v] = now_.pressed.meshes[i].vertices[v] - now_.teeth[i].mesh.vertices[v];
      const std::vector<int> zones = root_zones(root);
      for (std::size_t t = 0; t < zones.size(); ++t)
        if (zones[t] > static_cast<int>(RootZone::upper))
          for (const int v : root.triangles[t]) moves[at(v)].setZero();
      root.vertices = [unpressed = root.vertices, moves = std::move(moves)](const RootSteering& steering) {
        std::vector<Point> vertices = unpressed(steering);
        for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] += moves[v];
        return vertices;
      };
    }
  }

  /// Makes the teeth whose steering is another one. False if one could not be made: it stays as it is from now on.
  bool make(const FoundSteering& found, std::vector<std::string>& notes) {
    bool all = true;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (same(found.steering[i], now_.steering[i])) continue;
      try {
        SourcedTooth tooth = finish_(i, found.steering[i]);
        // Until it is pressed.
        now_.pressed.meshes[i] = tooth.mesh;
        now_.teeth[i] = std::move(tooth);
        now_.steering[i] = found.steering[i];
        now_.cost[i] = found.cost_mm[i];
        now_.at_limit[i] = found.at_limit[i];
        zoned_[i] = nullptr;
      } catch (const Error& error) {
        notes.push_back(fmt::format("Tooth {} keeps its root, for it could not be made otherwise: {}", roots_[i].fdi,
                                    error.what()));
        roots_[i].start = now_.steering[i];
        roots_[i].may_change = false;
        zoned_[i] = nullptr;
        all = false;
      }
    }
    return all;
  }

  void measure() {
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (zoned_[i]) continue;
      TriangleMesh trial;
      if (roots_[i].may_change) trial = {roots_[i].vertices(now_.steering[i]), roots_[i].triangles};
      const TriangleMesh& pressed = now_.pressed.meshes[i];
      zoned_[i] = std::make_shared<SolidSurface>(
          in_zones(pressed, crown_and_root(now_.teeth[i], pressed), trial, root_zones(roots_[i])));
    }
    now_.missing.clear();
    for (std::size_t i = 0; i < roots_.size(); ++i)
      for (std::size_t j = i + 1; j < roots_.size(); ++j) {
        std::vector<double> missing = missing_where_roots_move(*zoned_[i], *zoned_[j], wanted());
        if (std::any_of(missing.begin(), missing.end(), [](double mm) { return mm > enough; }))
          now_.missing[{i, j}] = std::move(missing);
      }
  }

  /// Has the trial teeth keep more where they stood apart and the teeth made do not. False if there is nothing to gain.
  bool ask_for_more(const FoundSteering& found, std::map<ToothPair, double>& extra) const {
    bool any = false;
    for (const auto& [pair, missing] : now_.missing) {
      const auto of_trial = found.missing.find(pair);
      double unexpected = 0;
      for (std::size_t z = 0; z < missing.size(); ++z)
        if (missing[z] > enough)
          unexpected = std::max(unexpected, missing[z] - (of_trial == found.missing.end() ? 0 : of_trial->second[z]));
      if (unexpected <= enough) continue;
      extra[pair] += unexpected;
      any = true;
    }
    return any;
  }

  std::vector<UnresolvedCollision> unresolved() const {
    std::vector<UnresolvedCollision> all;
    for (const auto& [pair, mm] : too_near()) {
      const auto [i, j] = pair;
      const bool fixed_i = !roots_[i].may_change, fixed_j = !roots_[j].may_change;
      CollisionCause cause = CollisionCause::out_of_proportion;
      if (!now_.missing.contains(pair)) {
        cause = fixed_i && fixed_j ? CollisionCause::at_limit : CollisionCause::necks;
      } else if (now_.at_limit[i] || now_.at_limit[j] || fixed_i || fixed_j) {
        cause = CollisionCause::at_limit;
      }
      all.push_back({i, j, mm, cause, sentence(roots_[i].fdi, roots_[j].fdi, mm, cause)});
    }
    return all;
  }

  std::string sentence(int first, int second, double mm, CollisionCause cause) const {
    std::string text = mm < 0 ? fmt::format("Teeth {} and {} still run {:.2f} mm into each other", first, second, -mm)
                              : fmt::format("Teeth {} and {} still come within {:.2f} mm of each other below the crown",
                                            first, second, mm);
    if (mm >= 0) text += fmt::format(", where {:.2f} mm were asked for", wanted());
    switch (cause) {
      case CollisionCause::necks:
        return text + ": the crowns, which never move, leave no more at their necks.";
      case CollisionCause::at_limit:
        return text + ": their roots would have to be turned, bent or shortened more than they may.";
      case CollisionCause::out_of_proportion:
        break;
    }
    return text +
           ": so close to the crowns turning and bending hardly move their roots, and more would be out of proportion.";
  }

  std::vector<SteerableRoot> roots_;
  const FinishTooth& finish_;
  ResolveOptions options_;
  Round now_;
  std::vector<std::shared_ptr<const SolidSurface>> zoned_;
};

}  // namespace

ResolvedCollisions resolve_collisions(const std::vector<SteerableRoot>& roots, const std::vector<SourcedTooth>& teeth,
                                      const FinishTooth& finish, const ResolveOptions& options) {
  require_options_in_range(options.search);
  if (options.rounds < 1) throw UsageError(fmt::format("{} rounds are too few to bring roots apart.", options.rounds));
  if (roots.size() != teeth.size())
    throw UsageError(fmt::format("{} teeth are given with {} roots for trials.", teeth.size(), roots.size()));
  return Resolving(roots, teeth, finish, options).run();
}

}  // namespace rhizodont
