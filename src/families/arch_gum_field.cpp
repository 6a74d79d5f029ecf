// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_fields.hpp"
#include "mesh/smooth_functions.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

namespace rhizodont {
namespace {

constexpr float no_level = -1000;

/// What surrounds a tooth's root, or stands where one is missing.
class Collar {
 public:
  Collar(const ArchCrown& crown, const GumForm& form, double distal)
      : crown_(crown), form_(form), inverse_(crown.to_work.inverse()), distal_(distal) {}

  /// mm, negative inside; right near 0.
  double operator()(const Point& work) const {
    const Point p = inverse_ * work;
    const double across = p.head<2>().norm(), angle = std::atan2(p.y(), p.x());
    const double sine = across > 0 ? p.y() / across : 0, cosine = across > 0 ? p.x() / across : 0;
    const auto [radius, height] = crown_.rim.at(angle);
    const double hood = crown_.hood_mm > 0 ? crown_.hood_mm * smooth_step(0.5 + 0.9 * distal_ * cosine) : 0;
    const double depth = height + crown_.margin_shift + hood - p.z();
    const double buccal = 0.5 + 0.5 * sine;
    const double slope =
        std::abs(sine) * (form_.buccal_slope * buccal + form_.oral_slope * (1 - buccal)) + 0.08 * std::abs(cosine);
    if (crown_.ghost) {
      constexpr double dome = 4;
      if (depth <= 0) return std::hypot(across, depth);
      const double part = 1 - std::min(depth, dome) / dome;
      return across - radius * std::sqrt(1 - part * part) - slope * depth;
    }
    if (depth <= 0) return std::hypot(std::max(0.0, across - radius + 0.12), depth);
    double thick = -0.12 + form_.rise * (1 - std::exp(-depth / form_.rise_length)) + slope * depth;
    if (sine > 0) thick += sine * form_.flare * soft_plus(depth - form_.vestibule, 1.0);
    // Farther down the jaw alone shows, not each root.
    thick -= 0.5 * soft_plus(depth - form_.root_shows, 0.7);
    return std::max(across - radius - thick, -depth);
  }

 private:
  const ArchCrown& crown_;
  const GumForm& form_;
  Eigen::Isometry3d inverse_;
  double distal_;
};

/// The ridges behind the last crowns, lower and lower.
std::vector<ArchCrown> ridges_behind(const ArchCrowns& arch) {
  std::vector<ArchCrown> ridges;
  for (const bool first : {true, false}) {
    const ArchCrown& last = first ? arch.crowns.front() : arch.crowns.back();
    const double step = first ? -1 : 1;
    for (int k = 1; k <= 2; ++k) {
      ArchCrown ridge = last;
      ridge.fdi = 0;
      ridge.ghost = true;
      ridge.mesh = {};
      ridge.hood_mm = 0;
      ridge.along += step * 0.8 * k * last.width;
      const Eigen::Vector2d moved = arch.curve.at(ridge.along) - arch.curve.at(last.along);
      ridge.to_work.pretranslate(Eigen::Vector3d(moved.x(), last.ghost ? -0.6 * k : -0.3 - 1.2 * k, moved.y()));
      for (double& r : ridge.rim.radius) r *= 0.95;
      ridges.push_back(std::move(ridge));
    }
  }
  return ridges;
}

/// Height of the necks along the curve, mm.
double neck_level(const ArchCrowns& arch, double along) {
  const auto& crowns = arch.crowns;
  std::size_t i = 0;
  while (i + 2 < crowns.size() && crowns[i + 1].along < along) ++i;
  const double length = std::max(1e-3, crowns[i + 1].along - crowns[i].along);
  const double part = std::clamp((along - crowns[i].along) / length, 0.0, 1.0);
  const double a = crowns[i].to_work.translation().y(), b = crowns[i + 1].to_work.translation().y();
  return a + part * (b - a);
}

/// Repeats `relax` over the cells that are inside; those at the map's sides have a neighbour fewer.
void relax(const PlanMap& map, const std::vector<bool>& inside, std::vector<float>& values, float source) {
  constexpr int sweeps = 250;
  constexpr float over = 1.8F;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int z = 0; z < map.nz; ++z)
      for (int x = 0; x < map.nx; ++x) {
        const auto i = static_cast<std::size_t>(z * map.nx + x);
        if (!inside[i]) continue;
        float sum = 0, neighbours = 0;
        const auto add = [&](int xx, int zz) {
          if (xx < 0 || zz < 0 || xx >= map.nx || zz >= map.nz) return;
          sum += values[static_cast<std::size_t>(zz * map.nx + xx)];
          neighbours += 1;
        };
        add(x - 1, z);
        add(x + 1, z);
        add(x, z - 1);
        add(x, z + 1);
        values[i] += over * ((sum + source) / neighbours - values[i]);
      }
}

/// Palate or floor of the mouth: a membrane under load that hangs between the necks.
void hang_level(const ArchCrowns& arch, const GumForm& form, PlanMap& map) {
  constexpr float edge = -2.5F;
  const auto cells = static_cast<std::size_t>(map.nx * map.nz);
  std::vector<bool> inside(cells);
  std::vector<float> load(cells, 0), necks(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    inside[i] = map.off[i] < edge;
    necks[i] = static_cast<float>(neck_level(arch, static_cast<double>(map.along[i])));
  }
  relax(map, inside, load, 1.0F);
  relax(map, inside, necks, 0.0F);
  const float most = std::max(1.0F, *std::max_element(load.begin(), load.end()));
  const bool upper = arch.jaw == Jaw::upper;
  map.level.assign(cells, no_level);
  for (std::size_t i = 0; i < cells; ++i) {
    if (!inside[i]) continue;
    const double part = static_cast<double>(std::max(0.0F, load[i] / most));
    const double depth =
        upper ? 1.0 + form.palate_depth * std::pow(part, form.palate_power) : form.floor_depth - 3 * std::sqrt(part);
    if (upper || form.floor) map.level[i] = necks[i] - static_cast<float>(depth);
  }
}

PlanMap plan_of(const ArchCrowns& arch, const Lattice& lattice) {
  PlanMap map;
  map.x0 = lattice.origin.x();
  map.z0 = lattice.origin.z();
  map.nx = static_cast<int>(std::ceil(lattice.cell * (lattice.count[0] - 1))) + 2;
  map.nz = static_cast<int>(std::ceil(lattice.cell * (lattice.count[2] - 1))) + 2;
  for (int z = 0; z < map.nz; ++z)
    for (int x = 0; x < map.nx; ++x) {
      const Eigen::Vector2d p(map.x0 + x, map.z0 + z);
      const double along = arch.curve.nearest(p);
      const Eigen::Vector2d away = p - arch.curve.at(along);
      map.along.push_back(static_cast<float>(along));
      map.off.push_back(static_cast<float>(std::copysign(away.norm(), away.dot(arch.outward_at(along)))));
    }
  return map;
}

/// The ridge that carries the teeth, a wall along the arch: fills between the collars, its top makes the papillae.
class RidgeWall {
 public:
  RidgeWall(const ArchCrowns& arch, const std::vector<ArchCrown>& behind, const GumForm& form) : form_(form) {
    add(arch, behind[1]);
    add(arch, behind[0]);
    for (const ArchCrown& crown : arch.crowns) add(arch, crown);
    add(arch, behind[2]);
    add(arch, behind[3]);
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      Knot &a = knots_[i], &b = knots_[i + 1];
      b.along = std::max(b.along, a.along + 0.5);
      const double gap = b.along - a.along - 0.5 * (a.width + b.width);
      const double papilla = form.papilla * (1 - smooth_step(gap / 2.5)) - 0.6 * smooth_step((gap - 1) / 3);
      a.papilla = a.ghost || b.ghost ? 0 : papilla;
    }
  }

  /// What a column of the lattice meets of it; nothing beyond its ends.
  struct Column {
    double off = 0, half = 0, top = 0;
    bool buccal = true;
  };
  std::optional<Column> column(double along, double off) const {
    std::size_t i = 0;
    while (i + 1 < knots_.size() && knots_[i + 1].along < along) ++i;
    if (i + 1 == knots_.size() || along < knots_[0].along) return {};
    const Knot &a = knots_[i], &b = knots_[i + 1];
    const double part = (along - a.along) / (b.along - a.along), smooth = smooth_step(part);
    const auto mix = [&](double from, double to) { return from + smooth * (to - from); };
    const double middle = mix(a.off, b.off), peak = 4 * part * (1 - part);
    return Column{std::abs(off - middle), mix(a.half, b.half), mix(a.top, b.top) + a.papilla * peak * peak,
                  off > middle};
  }

  double operator()(const Column& at, double height) const {
    constexpr double round = 1.6;
    const double depth = std::max(0.0, at.top - height);
    const double slope = at.buccal ? form_.buccal_slope : form_.oral_slope;
    const double half = at.half + (form_.rise + form_.jaw) * (1 - std::exp(-depth / 2.5)) + slope * depth +
                        (at.buccal ? form_.flare * soft_plus(depth - form_.vestibule, 1.0) : 0);
    const double side = at.off - half + round, above = height - at.top + round;
    return std::hypot(std::max(side, 0.0), std::max(above, 0.0)) + std::min(std::max(side, above), 0.0) - round;
  }

 private:
  struct Knot {
    double along = 0, off = 0, half = 0, top = 0, width = 0, papilla = 0;
    bool ghost = false;
  };

  void add(const ArchCrowns& arch, const ArchCrown& crown) {
    const Point at = crown.to_work.translation();
    const Eigen::Vector2d away = Eigen::Vector2d(at.x(), at.z()) - arch.curve.at(crown.along);
    Knot knot;
    knot.along = crown.along;
    knot.off = away.dot(arch.outward_at(crown.along));
    knot.half = 0.5 * (crown.rim.at(0.5 * std::numbers::pi).first + crown.rim.at(1.5 * std::numbers::pi).first) *
                (crown.ghost ? 0.85 : form_.wall);
    double rim = 0;
    for (const double height : crown.rim.height) rim += height / rim_sectors;
    knot.top = at.y() + rim + (crown.ghost ? -0.8 : crown.margin_shift - 0.5);
    knot.width = crown.ghost ? 0 : crown.width;
    knot.ghost = crown.ghost;
    knots_.push_back(knot);
  }

  const GumForm& form_;
  std::vector<Knot> knots_;
};

/// Adds exp(-distance / blend) of what is at hand to the sums.
void add_collar(const Collar& collar, const ArchCrown& crown, const GumForm& form, const Lattice& lattice,
                std::vector<float>& sums) {
  const Point middle = crown.to_work.translation();
  const double widest = *std::max_element(crown.rim.radius.begin(), crown.rim.radius.end());
  const double highest = *std::max_element(crown.rim.height.begin(), crown.rim.height.end());
  std::array<int, 3> low{}, high{};
  const auto bound = [&](std::size_t axis, double from, double to) {
    const auto i = static_cast<Eigen::Index>(axis);
    low[axis] = std::clamp(static_cast<int>((from - lattice.origin[i]) / lattice.cell), 0, lattice.count[axis] - 1);
    high[axis] = std::clamp(static_cast<int>((to - lattice.origin[i]) / lattice.cell) + 1, 0, lattice.count[axis] - 1);
  };
  // Leaning roots lead away from the crown as they go down.
  const double aside = widest + 9;
  bound(0, middle.x() - aside, middle.x() + aside);
  bound(1, -1e3, middle.y() + highest + crown.margin_shift + crown.hood_mm + 3);
  bound(2, middle.z() - aside, middle.z() + aside);
  const double reach = 4 * form.blend;
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const double distance = collar(lattice.at(x, y, z));
        if (distance < reach)
          sums[lattice.index(x, y, z)] +=
              static_cast<float>(std::exp(-std::max(distance, -2.0 * static_cast<double>(field_reach)) / form.blend));
      }
}

}  // namespace

double PlanMap::sample(const std::vector<float>& values, double x, double z) const {
  const double px = std::clamp(x - x0, 0.0, nx - 1.001), pz = std::clamp(z - z0, 0.0, nz - 1.001);
  const int ix = static_cast<int>(px), iz = static_cast<int>(pz);
  const double fx = px - ix, fz = pz - iz;
  const auto at = [&](int i, int k) { return static_cast<double>(values[static_cast<std::size_t>(k * nx + i)]); };
  return (1 - fz) * ((1 - fx) * at(ix, iz) + fx * at(ix + 1, iz)) +
         fz * ((1 - fx) * at(ix, iz + 1) + fx * at(ix + 1, iz + 1));
}

GumForm draw_gum_form(Jaw jaw, RandomStream& random) {
  GumForm form;
  form.rise = random.uniform(0.6, 1.5);
  form.rise_length = random.uniform(0.6, 1.6);
  form.buccal_slope = random.uniform(0.05, 0.4);
  form.oral_slope = random.uniform(0.15, jaw == Jaw::upper ? 0.7 : 0.5);
  form.papilla = random.uniform(0.4, 2.2);
  form.wall = random.uniform(0.7, 0.95);
  form.vestibule = random.uniform(4, 12);
  form.flare = random.uniform(0.0, 1.1);
  form.jaw = random.uniform(0.2, 1.6);
  form.root_shows = random.uniform(0.8, 4);
  form.blend = random.uniform(0.35, 0.9);
  form.palate_depth = random.uniform(8, 19);
  form.palate_power = random.uniform(0.5, 0.85);
  form.floor_depth = random.uniform(7, 14);
  form.floor = random.chance(0.3);
  return form;
}

void add_gum(const ArchCrowns& arch, const GumForm& form, ArchFields& fields) {
  const Lattice& lattice = fields.lattice;
  fields.plan = plan_of(arch, lattice);
  hang_level(arch, form, fields.plan);
  std::vector<float> sums(lattice.size(), 0);
  const double middle = 0.5 * (arch.crowns[7].along + arch.crowns[8].along);
  const auto distal_of = [&](const ArchCrown& crown) {
    const Eigen::Vector2d t = arch.curve.tangent(crown.along);
    const double facing = crown.to_work.linear().col(0).dot(Eigen::Vector3d(t.x(), 0, t.y()));
    return (facing > 0) == (crown.along > middle) ? 1.0 : -1.0;
  };
  const std::vector<ArchCrown> ridges = ridges_behind(arch);
  for (const std::vector<ArchCrown>* group : {&arch.crowns, &ridges})
    for (const ArchCrown& crown : *group) add_collar(Collar(crown, form, distal_of(crown)), crown, form, lattice, sums);
  const RidgeWall wall(arch, ridges, form);
  fields.gum.assign(lattice.size(), field_reach);
  for (int z = 0; z < lattice.count[2]; ++z)
    for (int x = 0; x < lattice.count[0]; ++x) {
      const Point foot = lattice.at(x, 0, z);
      const PlanMap& plan = fields.plan;
      // The cell's own value decides whether there is a level: between cells with and without one there is none.
      const double level = plan.sample(plan.level, foot.x(), foot.z());
      const auto column =
          wall.column(plan.sample(plan.along, foot.x(), foot.z()), plan.sample(plan.off, foot.x(), foot.z()));
      for (int y = 0; y < lattice.count[1]; ++y) {
        const std::size_t i = lattice.index(x, y, z);
        const double height = lattice.at(x, y, z).y();
        float sum = sums[i];
        const auto add = [&](double distance) {
          if (distance < 4 * form.blend)
            sum +=
                static_cast<float>(std::exp(-std::max(distance, -2.0 * static_cast<double>(field_reach)) / form.blend));
        };
        if (level > -500) add(0.75 * (height - level));
        if (column) add(wall(*column, height));
        if (sum > 0)
          fields.gum[i] = std::clamp(static_cast<float>(-form.blend) * std::log(sum), -field_reach, field_reach);
      }
    }
}

}  // namespace rhizodont
