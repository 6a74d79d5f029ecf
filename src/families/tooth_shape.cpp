// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A chain of maps each of which is one-to-one: stretching along the axis (crown, trunk and roots each by its own
// factor), scaling across, tapering around each root's centreline, shearing (lean, bends), and gentle waves.
// Mean dimensions: Wheeler; Ash and Nelson, "Wheeler's Dental Anatomy".
#include "families/tooth_shape.hpp"

#include "mesh/smooth_functions.hpp"
#include "teeth/fdi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

Eigen::Vector3d unit(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Vector3d(x, y, z) / std::max(1e-9, std::sqrt(x * x + y * y + z * z));
}

// How often the roots of a multi-rooted type hang together for most of their length, as a share of its teeth: upper
// 1..8, lower 1..8. Round figures between those of Asian and European studies; single-rooted types have no use for
// them.
constexpr std::array<double, tooth_type_count> fused_share{0, 0, 0, 0.15, 0, 0.06, 0.22, 0.45,
                                                           0, 0, 0, 0,    0, 0.05, 0.20, 0.40};

// Millimetres from the cemento-enamel junction amid the cheek's side to where the roots part, on average; 0: where the
// template's do. One template says little of it: that of 36 parts at 5.1 mm. Lower first molars: entrances at 3.07
// (cheek) and 3.54 mm (tongue) in 96 teeth ("Biometric study of the prefurcation area of human mandibular first
// molars"), at 2.49 and 3.18 mm in 30 (Odontology 2021, doi 10.1007/s10266-021-00645-w), roots apart at 4.0 mm in 20
// ("Root surface measurements of the mandibular first molar"). Upper first molars: the first root apart at 5.0 mm in 20
// ("Linear variation of the root surface area of the maxillary first molar"). Second molars' trunks are longer than
// first ones' (Mabrouk et al., International Journal of Dentistry 2020, 8846273); by how much here, and third molars,
// are round figures.
constexpr std::array<double, tooth_type_count> trunk_mm{0, 0, 0, 0, 0, 5.0, 5.3, 5.3, 0, 0, 0, 0, 0, 3.4, 3.7, 3.7};

// Slope of the lowest part of the height map that gives the wanted root length.
void fit_root_length(HeightMap& map, double template_length, double wanted) {
  double low = 0.1, high = 4;
  for (int i = 0; i < 50; ++i) {
    map.branch = 0.5 * (low + high);
    (-map(-template_length) < wanted ? low : high) = map.branch;
  }
}

// Where the roots part, as a share of the root's length, and whether they count as fused.
struct Branching {
  double share = 0.3;
  bool fused = false;
};

/// `below`: how far the junction's middle on the cheek's side lies below its mean height, millimetres.
Branching draw_branching(const FamilyTemplate& source, const ToothDimensions& mean, int type, double below,
                         const ToothVariation& variation, RandomStream& random) {
  const double published = trunk_mm[static_cast<std::size_t>(type)];
  const double own = published > 0 ? (published + below) / (mean.root_length + below)
                                   : std::max(1.0, -source.furcation_z) / source.root_length;
  if (random.chance(variation.fusion * fused_share[static_cast<std::size_t>(type)]))
    return {random.uniform(0.62, 0.86), true};
  // Two-rooted upper premolars part anywhere from the neck's third to the tips.
  if (type == 3 && variation.fusion > 0) return {random.uniform(0.3, 0.72), false};
  return {std::clamp(own * random.normal(1.0, variation.trunk), 0.12, 0.6), false};
}

RootShape draw_root(const FamilyTemplate& source, const TemplateRoot& root, const Eigen::Vector2d& centre,
                    double spread, bool fused, const ToothVariation& variation, RandomStream& random) {
  RootShape drawn;
  if (source.roots.size() > 1) {
    const Eigen::Vector2d outward = source.mesh.vertices[root.apex].head<2>() - centre;
    const double own = random.normal(0.0, 0.5 * variation.divergence_mm);
    const Eigen::Vector2d aside =
        Eigen::Vector2d(random.normal(0.0, 0.4), random.normal(0.0, 0.4)) * variation.divergence_mm;
    drawn.shift = (spread + own) * outward.normalized() + aside;
    if (fused) drawn.shift = 0.3 * drawn.shift - random.uniform(0.0, 0.45) * outward;
    drawn.stretch = random.normal(0.0, 0.07) * std::min(1.0, variation.divergence_mm);
  }
  drawn.shift_power = random.uniform(1.2, 2.5);
  drawn.taper = random.normal(0.0, 0.7 * variation.taper);
  drawn.cross_section = random.normal(0.0, 0.8 * variation.root_thickness);
  if (random.chance(variation.blunt_share)) drawn.blunt = random.uniform(0.0, 0.7);
  return drawn;
}

void draw_bends(ToothShape& shape, int type, double length, const ToothVariation& variation, RandomStream& random) {
  const double distal = type < 8 ? 1 : -1;  // direction of x
  const double lean = length * std::tan(variation.lean_degrees * std::numbers::pi / 180);
  shape.lean = {random.normal(0.0, lean), random.normal(0.0, lean)};
  const double bend = variation.distal_bend_mm;
  shape.bend = {random.normal(distal * 0.4, 1.0) * bend, random.normal(0.0, 0.8) * bend};
  shape.bend_power = random.uniform(1.3, 3.0);
  if (random.chance(variation.dilaceration_share)) {
    // A sharp turn of the last quarter to third, mostly to distal.
    const double angle = random.uniform(0, 2 * std::numbers::pi), size = random.uniform(1.0, 2.4);
    shape.tip_bend = size * Eigen::Vector2d(0.9 * distal + 0.6 * std::cos(angle), 0.6 * std::sin(angle));
    shape.tip_power = random.uniform(5.0, 8.0);
  } else if (random.chance(0.3)) {
    shape.tip_bend = Eigen::Vector2d(random.normal(distal * 0.8, 0.8), random.normal(0.0, 0.6)) * bend;
  }
}

// Immature and resorbed roots: short, and blunt in their different ways.
void shorten(ToothShape& shape, double& length, const ToothVariation& variation, RandomStream& random) {
  if (random.chance(variation.open_apex_share)) {
    length *= random.uniform(0.55, 0.9);
    shape.taper += random.uniform(0.1, 0.35);
    for (RootShape& root : shape.roots) root.blunt = random.uniform(0.8, 2.2);
  } else if (random.chance(variation.resorption_share)) {
    length *= random.uniform(0.68, 0.92);
    for (RootShape& root : shape.roots) root.blunt = random.uniform(0.4, 1.6);
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
                      const ToothVariation& variation, const SharedDraws& shared, RandomStream& random) {
  // Against the table: scanned crowns (means of the statistical crown models of about 95 people) are a little larger,
  // roots of living populations a little shorter.
  constexpr double crown_population = 1.02, root_population = 0.98;
  ToothShape shape;
  const double own_size = random.normal(1.0, variation.size, 2.8);
  const double size = shared.size ? 1 + variation.size * std::clamp(*shared.size, -2.8, 2.8) : own_size;
  const auto proportion = [&] { return random.normal(1.0, variation.proportion); };
  shape.scale.x() = crown_population * size * proportion() * mean.crown_mesiodistal / source.crown_width.x();
  shape.scale.y() = crown_population * size * proportion() * mean.crown_buccolingual / source.crown_width.y();
  // The table measures from the junction amid the buccal side, which lies below the junction's mean height.
  const double buccal = -source.junction(0, source.junction.half_width.y());
  const double crown_height = size * random.normal(1.0, variation.crown_height) * mean.crown_height;
  shape.scale.z() = crown_height / (source.crown_height + buccal);
  shape.junction_scale = random.normal(1.0, variation.junction_curve) * shape.scale.z();
  const double below = buccal * shape.junction_scale;

  const Branching branching =
      source.roots.size() > 1 ? draw_branching(source, mean, type, below, variation, random) : Branching{};
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const TemplateRoot& root : source.roots)
    centre += source.mesh.vertices[root.apex].head<2>() / static_cast<double>(source.roots.size());
  double spread = random.normal(0.0, variation.divergence_mm);
  shape.taper = random.normal(0.0, variation.taper);
  const bool deciduous = random.chance(variation.deciduous_share);
  if (deciduous) spread += random.uniform(0.5, 2.0);
  for (const TemplateRoot& root : source.roots)
    shape.roots.push_back(draw_root(source, root, centre, spread, branching.fused, variation, random));

  double length = root_population * mean.root_length * std::pow(size, variation.root_size_correlation) + below;
  const double own_length = random.normal(0.0, variation.root_length_mm);
  length += shared.root_length ? variation.root_length_mm * std::clamp(*shared.root_length, -2.8, 2.8) : own_length;
  if (deciduous) {  // squat crowns, slender short roots
    const double small = random.uniform(0.68, 0.9);
    shape.scale = shape.scale.cwiseProduct(Eigen::Vector3d(small, small, small * random.uniform(0.75, 0.9)));
    length *= random.uniform(0.6, 0.95);
    shape.taper -= 0.15;
  }
  length = std::max(length, 0.55 * mean.root_length);
  shorten(shape, length, variation, random);

  shape.height.crown = shape.scale.z();
  if (source.roots.size() > 1) {
    shape.height.trunk_depth = std::max(1.0, -source.furcation_z);
    shape.height.trunk = branching.share * length / shape.height.trunk_depth;
  } else {
    shape.height.trunk_depth = 3.0;
    shape.height.trunk = shape.scale.z() * random.normal(1.0, variation.trunk);
  }
  fit_root_length(shape.height, source.root_length, length);
  shape.root_section = {random.normal(1.0, variation.root_thickness), random.normal(1.0, variation.root_thickness)};
  if (shared.root_thickness)
    for (double& width : shape.root_section)
      width =
          1 + std::sqrt(0.5) * (width - 1 + variation.root_thickness * std::clamp(*shared.root_thickness, -2.3, 2.3));
  draw_bends(shape, type, length, variation, random);
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
    const Eigen::Vector2d factor(1 + ease * (drawn.taper * u + drawn.cross_section),
                                 1 + ease * (drawn.taper * u - drawn.cross_section));
    xy = centre + (xy - centre).cwiseProduct(factor) + std::pow(u, drawn.shift_power) * drawn.shift;
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
