// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A chain of maps each of which is one-to-one: stretching along the axis (crown, trunk and roots each by its own
// factor), scaling across, tapering around each root's centreline, shearing (lean, bends), and gentle waves.
// Mean dimensions of crowns: Wheeler; Ash and Nelson, "Wheeler's Dental Anatomy". Roots: populations/middle.json, which
// names its sources. Angles of curved roots are those of S. W. Schneider, "A comparison of canal preparations in
// straight and curved root canals", 1971: of the chord from where the curve begins to the tip.
#include "families/tooth_shape.hpp"

#include "mesh/smooth_functions.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace rhizodont {
namespace {

Eigen::Vector3d unit(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z) / std::max(1e-9, std::sqrt(x * x + y * y + z * z));
}

// Slope of the lowest part of the height map that gives the wanted root length.
void fit_root_length(HeightMap& map, double template_length, double wanted) {
  double low = 0.1, high = 4;
  for (int i = 0; i < 50; ++i) {
    map.branch = 0.5 * (low + high);
    (-map(-template_length) < wanted ? low : high) = map.branch;
  }
}

// Of how the length of a single root's neck is stretched against its rest, relative (ours).
constexpr double neck_deviation = 0.25;

// Where the roots part, as a share of the root's length, and whether they count as fused.
struct Branching {
  double share = 0.3;
  bool fused = false;
};

/// `length`: of the root from the junction's mean height; `below`: how far the junction's middle on the cheek's side
/// lies below that, millimetres.
Branching draw_branching(const FamilyTemplate& source, const ToothPopulation& people, int type, double length,
                         double below, const ToothVariation& variation, RandomStream& random) {
  if (random.chance(variation.fusion * people.fused_share)) return {random.uniform(0.62, 0.86), true};
  // Two-rooted upper premolars part anywhere from the neck's third to the tips.
  if (source.roots.size() == 2 && (type == 3 || type == 4) && variation.fusion > 0)
    return {random.uniform(0.3, 0.72), false};
  const double usual = people.trunk_mm > 0
                           ? people.trunk_mm + below
                           : std::max(1.0, -source.furcation_z) * (people.root_length_mm + below) / source.root_length;
  // Long trunks go with short roots (Hou, Tsai 1997); by how much is ours.
  constexpr double per_mm = 0.1;
  const double trunk = usual + random.normal(0.0, variation.trunk * people.trunk_deviation_mm) -
                       (variation.trunk > 0 ? per_mm * (length - below - people.root_length_mm) : 0.0);
  return {std::clamp(trunk / length, 0.12, 0.6), false};
}

// Shift of the tip of a root, in the directions of the tooth, that gives the chord from the curve's beginning to the
// tip the angle drawn. `usual`: unit, where such roots mostly curve to.
Eigen::Vector2d draw_curve(const ToothPopulation& people, const Eigen::Vector2d& usual, double length, double power,
                           const ToothVariation& variation, RandomStream& random) {
  const bool is_curved = random.chance(people.curved_share), is_usual = random.chance(people.curve_usual_share);
  const double angle = std::abs(random.normal(people.curve_degrees, people.curve_deviation_degrees));
  const double anywhere = random.uniform(0, 2 * std::numbers::pi), aside = random.normal(0.0, 0.35);
  if (!is_curved) return Eigen::Vector2d::Zero();
  // The curve begins where it has made a twentieth of its way.
  constexpr double begun = 0.05;
  const double run = length * (1 - std::pow(begun, 1 / power));
  constexpr double most_degrees = 60;  // beyond, the root's tip would be farther aside than down
  const double turn = std::min(variation.curvature * angle, most_degrees) * std::numbers::pi / 180;
  const double size = std::tan(turn) * run / (1 - begun);
  const Eigen::Vector2d direction = is_usual ? Eigen::Vector2d(Eigen::Rotation2Dd(aside) * usual)
                                             : Eigen::Vector2d(std::cos(anywhere), std::sin(anywhere));
  return size * direction;
}

// Where the parted root mostly curves to: roots towards the tooth's middle, mesiodistally where they stand side by
// side.
Eigen::Vector2d usual_curve(const Eigen::Vector2d& outward, std::size_t roots, double distal) {
  const bool is_beside = std::abs(outward.x()) > 0.35 * outward.norm();
  if (is_beside) return {outward.x() > 0 ? -1.0 : 1.0, 0};
  return roots == 2 ? Eigen::Vector2d(distal, 0) : Eigen::Vector2d(0, outward.y() > 0 ? -1.0 : 1.0);
}

RootShape draw_root(const FamilyTemplate& source, const TemplateRoot& root, const Eigen::Vector2d& centre,
                    double spread, bool fused, double parted_length, double distal, const ToothPopulation& people,
                    const ToothVariation& variation, RandomStream& random) {
  RootShape drawn;
  if (source.roots.size() > 1) {
    drawn.curve_power = random.uniform(2.2, 4.0);
    const Eigen::Vector2d outward = source.mesh.vertices[root.apex].head<2>() - centre;
    const double own = random.normal(0.0, 0.5 * variation.divergence_mm);
    const Eigen::Vector2d aside =
        Eigen::Vector2d(random.normal(0.0, 0.4), random.normal(0.0, 0.4)) * variation.divergence_mm;
    drawn.shift = (spread + own) * outward.normalized() + aside;
    if (fused) drawn.shift = 0.3 * drawn.shift - random.uniform(0.0, 0.45) * outward;
    drawn.stretch = random.normal(0.0, 0.07) * std::min(1.0, variation.divergence_mm);
    const Eigen::Vector2d curve = draw_curve(people, usual_curve(outward, source.roots.size(), distal), parted_length,
                                             drawn.curve_power, variation, random);
    drawn.curve = fused ? 0.4 * curve : curve;
  }
  drawn.shift_power = random.uniform(1.2, 2.5);
  drawn.taper = random.normal(0.0, 0.7 * variation.taper);
  drawn.cross_section = random.normal(0.0, 0.8 * variation.root_thickness * people.root_thickness_deviation);
  if (random.chance(variation.blunt_share)) drawn.blunt = random.uniform(0.0, 0.7);
  return drawn;
}

void draw_bends(const FamilyTemplate& source, ToothShape& shape, double distal, double length,
                const ToothPopulation& people, const ToothVariation& variation, RandomStream& random) {
  const auto lean = [&](double degrees) {
    return length * std::tan(random.normal(0.0, variation.lean * degrees) * std::numbers::pi / 180);
  };
  shape.lean.x() = lean(people.lean_mesiodistal_degrees);
  shape.lean.y() = lean(people.lean_buccolingual_degrees);
  const double bend = variation.distal_bend_mm;
  shape.bend = {random.normal(distal * 0.4, 1.0) * bend, random.normal(0.0, 0.8) * bend};
  shape.bend_power = random.uniform(1.3, 3.0);
  if (random.chance(variation.dilaceration * people.dilaceration_share)) {
    // A sharp turn of the last quarter to third, mostly to distal.
    const double angle = random.uniform(0, 2 * std::numbers::pi), size = random.uniform(1.0, 2.4);
    shape.tip_bend = size * Eigen::Vector2d(0.9 * distal + 0.6 * std::cos(angle), 0.6 * std::sin(angle));
    shape.tip_power = random.uniform(5.0, 8.0);
  } else if (source.roots.size() == 1) {
    shape.tip_power = random.uniform(2.5, 6.0);
    shape.tip_bend = draw_curve(people, {distal, 0}, length, shape.tip_power, variation, random);
  }
}

// Immature, resorbed and short roots, blunt in their different ways, and roots that swell.
void deform_root(ToothShape& shape, double& length, const ToothPopulation& people, const ToothVariation& variation,
                 RandomStream& random) {
  if (random.chance(variation.open_apex_share)) {
    length *= random.uniform(0.55, 0.9);
    shape.taper += random.uniform(0.1, 0.35);
    for (RootShape& root : shape.roots) root.blunt = random.uniform(0.8, 2.2);
  } else if (random.chance(variation.resorption_share)) {
    length *= random.uniform(0.68, 0.92);
    for (RootShape& root : shape.roots) root.blunt = random.uniform(0.4, 1.6);
  } else if (random.chance(variation.short_roots * people.short_root_share)) {
    length *= random.uniform(0.55, 0.75);
    for (RootShape& root : shape.roots) root.blunt = random.uniform(0.6, 1.4);
  } else if (random.chance(variation.bulbous_share)) {
    for (RootShape& root : shape.roots) root.swelling = random.uniform(0.2, 0.6);
  }
}

Eigen::Vector2d centre_at(const TemplateRoot& root, double z) {
  const double at = std::clamp((root.branch_z - z) / TemplateRoot::centreline_step, 0.0,
                               static_cast<double>(root.centreline.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), root.centreline.size() - 1);
  const auto j = std::min(i + 1, root.centreline.size() - 1);
  const double t = at - static_cast<double>(i);
  return (1 - t) * root.centreline[i] + t * root.centreline[j];
}

}  // namespace

double HeightMap::operator()(double h) const {
  constexpr double width = 0.6;  // of the change from one slope to the next, millimetres
  return trunk * h + (crown - trunk) * (soft_plus(h, width) - soft_plus(0, width)) -
         (branch - trunk) * (soft_plus(-h - trunk_depth, width) - soft_plus(-trunk_depth, width));
}

ToothShape draw_shape(const FamilyTemplate& source, const ToothDimensions& mean, int type,
                      const ToothPopulation& people, const ToothVariation& variation, const SharedDraws& shared,
                      RandomStream& random) {
  constexpr double furthest = 2.8;          // deviations
  const double distal = type < 8 ? 1 : -1;  // direction of x
  ToothShape shape;
  const auto drawn = [&](const std::optional<double>& given) {
    const double own = random.normal(0.0, 1.0, furthest);
    return given ? std::clamp(*given, -furthest, furthest) : own;
  };
  const double size = 1 + variation.size * people.crown_size_deviation * drawn(shared.size);
  const auto proportion = [&] {
    return people.crown_size * size * random.normal(1.0, variation.proportion * people.crown_proportion_deviation);
  };
  shape.scale.x() = proportion() * mean.crown_mesiodistal / source.crown_width.x();
  shape.scale.y() = proportion() * mean.crown_buccolingual / source.crown_width.y();
  // Tables measure from the junction amid the buccal side, which lies below the junction's mean height.
  const double buccal = -source.junction(0, source.junction.half_width.y());
  const double crown_height = size * random.normal(1.0, variation.crown_height) * mean.crown_height;
  shape.scale.z() = crown_height / (source.crown_height + buccal);
  shape.junction_scale = random.normal(1.0, variation.junction_curve) * shape.scale.z();
  const double below = buccal * shape.junction_scale;

  const double with_size = people.root_follows_crown * people.crown_size_deviation * mean.root_length;
  const double own_deviation =
      std::sqrt(std::max(0.0, std::pow(people.root_length_deviation_mm, 2) - with_size * with_size));
  double length = mean.root_length * std::pow(size, people.root_follows_crown) + below +
                  variation.root_length * own_deviation * drawn(shared.root_length);
  length = std::max(length, 0.55 * mean.root_length);
  const Branching branching =
      source.roots.size() > 1 ? draw_branching(source, people, type, length, below, variation, random) : Branching{};
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const TemplateRoot& root : source.roots)
    centre += source.mesh.vertices[root.apex].head<2>() / static_cast<double>(source.roots.size());
  double spread = random.normal(0.0, variation.divergence_mm);
  shape.taper = random.normal(0.0, variation.taper);
  const bool deciduous = random.chance(variation.deciduous_share);
  if (deciduous) spread += random.uniform(0.5, 2.0);
  const double parted_length = (1 - branching.share) * length / shape.scale.head<2>().mean();
  for (const TemplateRoot& root : source.roots)
    shape.roots.push_back(
        draw_root(source, root, centre, spread, branching.fused, parted_length, distal, people, variation, random));
  if (deciduous) {  // squat crowns, slender short roots
    const double small = random.uniform(0.68, 0.9);
    shape.scale = shape.scale.cwiseProduct(Eigen::Vector3d(small, small, small * random.uniform(0.75, 0.9)));
    length *= random.uniform(0.6, 0.95);
    shape.taper -= 0.15;
  }
  deform_root(shape, length, people, variation, random);

  shape.height.crown = shape.scale.z();
  if (source.roots.size() > 1) {
    shape.height.trunk_depth = std::max(1.0, -source.furcation_z);
    shape.height.trunk = branching.share * length / shape.height.trunk_depth;
  } else {
    shape.height.trunk_depth = 3.0;
    shape.height.trunk = shape.scale.z() * random.normal(1.0, variation.trunk * neck_deviation);
  }
  fit_root_length(shape.height, source.root_length, length);
  const double thickness = variation.root_thickness * people.root_thickness_deviation;
  shape.root_section = {random.normal(1.0, thickness), random.normal(1.0, thickness)};
  if (shared.root_thickness)
    for (double& width : shape.root_section)
      width = 1 + std::sqrt(0.5) * (width - 1 + thickness * std::clamp(*shared.root_thickness, -2.3, 2.3));
  draw_bends(source, shape, distal, length, people, variation, random);
  shape.lean -= (1 - variation.template_lean) * centre.cwiseProduct(shape.scale.head<2>());
  return shape;
}

Point shaped(const FamilyTemplate& source, const ToothShape& shape, const Point& p, int root) {
  const double junction = source.junction(p.x(), p.y());
  const double h = p.z() - junction;
  Eigen::Vector2d xy = p.head<2>();
  double z = p.z();
  if (root >= 0) {
    const TemplateRoot& line = source.roots[static_cast<std::size_t>(root)];
    const RootShape& drawn = shape.roots[static_cast<std::size_t>(root)];
    const double bottom = source.mesh.vertices[line.apex].z();
    const double length = line.branch_z - bottom;
    const double depth = std::max(0.0, line.branch_z - z), u = depth / length;
    const Eigen::Vector2d centre = centre_at(line, z);
    const double ease = smooth_step(depth / 2.5);
    const double wider = drawn.taper * u + drawn.swelling * smooth_step(2 * u - 0.8);
    const Eigen::Vector2d factor(1 + ease * (wider + drawn.cross_section), 1 + ease * (wider - drawn.cross_section));
    xy = centre + (xy - centre).cwiseProduct(factor) + std::pow(u, drawn.shift_power) * drawn.shift +
         std::pow(u, drawn.curve_power) * drawn.curve;
    z = line.branch_z - depth - drawn.stretch * depth * depth / length;
    if (drawn.blunt > 0 && depth > 0) {
      const double below = bottom + drawn.blunt - z;
      z += 0.75 * (soft_plus(below, 0.25) - soft_plus(drawn.blunt - length, 0.25));
    }
  }
  const double mapped = shape.junction_scale * junction + shape.height(z - junction);
  if (h >= 0) return {xy.x() * shape.scale.x(), xy.y() * shape.scale.y(), mapped};
  const double down = smooth_step(-h / 4);
  const double u = -h / source.root_length;
  const double taper = 1 + shape.taper * (std::min(u, 1.0) - 0.35) * down;
  const Eigen::Vector2d section = Eigen::Vector2d::Ones() + (shape.root_section - Eigen::Vector2d::Ones()) * down;
  xy = taper * xy.cwiseProduct(shape.scale.head<2>()).cwiseProduct(section);
  xy += std::pow(u, shape.bend_power) * shape.bend + std::pow(u, shape.tip_power) * shape.tip_bend;
  xy += u * smooth_step(-h / 3) * shape.lean;
  return {xy.x(), xy.y(), mapped};
}

Waves::Waves(RandomStream& random, int count, double shortest, double longest, double deviation) {
  for (int i = 0; i < count; ++i) {
    const double length = shortest * std::pow(longest / shortest, random.uniform());
    const Eigen::Vector3d direction = unit(random);
    // Long waves may be higher than short ones at the same slope; the root of 6 makes the deviation that of one axis.
    const double height = deviation * std::sqrt(6.0 / count) * length / (0.5 * (shortest + longest));
    const double phase = random.uniform(0, 2 * std::numbers::pi);
    const double strength = random.normal(1.0, 0.3);
    waves_.push_back({2 * std::numbers::pi / length * direction, phase, height * strength * unit(random)});
  }
}

Eigen::Vector3d Waves::operator()(const Point& p) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Wave& wave : waves_) sum += std::sin(wave.frequency.dot(p) + wave.phase) * wave.height;
  return sum;
}

}  // namespace rhizodont
