// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A generated tooth is a template sent through a chain of maps each of which is one-to-one: stretching along the axis
// (crown, trunk and roots each by its own factor), scaling across, tapering around each root's centreline, shearing
// (bends), and gentle waves. So the surface stays embedded, but for roots that run into each other, which is tested.
// Mean dimensions: Wheeler; Ash and Nelson, "Wheeler's Dental Anatomy".
#include "atlas/tooth_family.hpp"

#include "atlas/random_stream.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

namespace rhizodont {
namespace {

double soft_plus(double x, double width) {
  const double t = x / width;
  return width * (t > 30 ? t : std::log1p(std::exp(t)));
}

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

// Monotone map of heights over the junction: slopes for crown, trunk (down to -trunk_depth) and the rest.
struct HeightMap {
  double crown = 1, trunk = 1, branch = 1;
  double trunk_depth = 3;

  double operator()(double h) const {
    constexpr double width = 0.6;  // of the change from one slope to the next, millimetres
    return trunk * h + (crown - trunk) * (soft_plus(h, width) - soft_plus(0, width)) -
           (branch - trunk) * (soft_plus(-h - trunk_depth, width) - soft_plus(-trunk_depth, width));
  }
};

// A sum of sine waves in space with a bounded gradient.
class Waves {
 public:
  Waves(RandomStream& random, int count, double shortest, double longest, double deviation) {
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

  Eigen::Vector3d operator()(const Point& p) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Wave& wave : waves_) sum += std::sin(wave.frequency.dot(p) + wave.phase) * wave.height;
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector3d frequency;
    double phase;
    Eigen::Vector3d height;
  };

  static Eigen::Vector3d unit(RandomStream& random) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Eigen::Vector3d(x, y, z) / std::max(1e-9, std::sqrt(x * x + y * y + z * z));
  }

  std::vector<Wave> waves_;
};

// The type's own template or a borrowed one.
TemplateLoan choose_template(int type, RandomStream& random, const ToothFamilies& families) {
  double draw = random.uniform();
  for (const TemplateLoan& loan : families.loans) {
    if (loan.type != type) continue;
    if (draw < loan.share) return loan;
    draw -= loan.share;
  }
  return {type, type, 1, 0};
}

// What is drawn for one root.
struct RootShape {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the apex against the trunk, millimetres
  double shift_power = 2;
  double taper = 0, stretch = 0;
  double cross_section = 0;  ///< relative, along x against y
  double blunt = 0;          ///< millimetres taken off the tip, softly
};

// All that is drawn for one tooth.
struct ToothShape {
  Eigen::Vector3d scale{1, 1, 1};  ///< of the crown
  HeightMap height;
  double junction_scale = 1;
  Eigen::Vector2d root_section{1, 1};
  double taper = 0;
  Eigen::Vector2d bend = Eigen::Vector2d::Zero(), tip_bend = Eigen::Vector2d::Zero();
  double bend_power = 2;
  std::vector<RootShape> roots;
  double wear = 0;
  Eigen::Vector2d wear_slope = Eigen::Vector2d::Zero();
};

// Slope of the lowest part of the height map that gives the wanted root length.
void fit_root_length(HeightMap& map, double template_length, double wanted) {
  double low = 0.2, high = 4;
  for (int i = 0; i < 50; ++i) {
    map.branch = 0.5 * (low + high);
    (-map(-template_length) < wanted ? low : high) = map.branch;
  }
}

ToothShape draw_shape(const FamilyTemplate& source, const ToothDimensions& mean, int type,
                      const ToothVariation& variation, RandomStream& random) {
  // Against the table: scanned crowns (means of the statistical crown models of about 95 people) are a little larger,
  // roots of living populations a little shorter.
  constexpr double crown_population = 1.02, root_population = 0.98;
  ToothShape shape;
  const double size = random.normal(1.0, variation.size);
  const auto proportion = [&] { return random.normal(1.0, variation.proportion); };
  shape.scale.x() = crown_population * size * proportion() * mean.crown_mesiodistal / source.crown_width.x();
  shape.scale.y() = crown_population * size * proportion() * mean.crown_buccolingual / source.crown_width.y();
  // The table measures from the junction amid the buccal side, which lies below the junction's mean height.
  const double buccal = -source.junction(0, source.junction.half_width.y());
  const double crown_height = size * proportion() * mean.crown_height;
  shape.scale.z() = crown_height / (source.crown_height + buccal);
  shape.junction_scale = random.normal(1.0, variation.junction_curve) * shape.scale.z();
  const double below = buccal * shape.junction_scale;

  double length = root_population * mean.root_length * std::pow(size, variation.root_size_correlation) + below;
  length += random.normal(0.0, variation.root_length_mm);
  length = std::max(length, 0.55 * mean.root_length);
  shape.height.crown = shape.scale.z();
  shape.height.trunk_depth = source.roots.size() > 1 ? std::max(1.0, -source.furcation_z) : 3.0;
  shape.height.trunk = shape.scale.z() * random.normal(1.0, variation.trunk);
  fit_root_length(shape.height, source.root_length, length);

  shape.root_section = {random.normal(1.0, variation.root_thickness), random.normal(1.0, variation.root_thickness)};
  shape.taper = random.normal(0.0, variation.taper);
  const double distal = type < 8 ? 1 : -1;  // direction of x
  shape.bend = {random.normal(distal * 0.4, 1.0) * variation.distal_bend_mm,
                random.normal(0.0, 0.8) * variation.distal_bend_mm};
  shape.bend_power = random.uniform(1.3, 3.0);
  if (random.chance(0.3))
    shape.tip_bend =
        Eigen::Vector2d(random.normal(distal * 0.8, 0.8), random.normal(0.0, 0.6)) * variation.distal_bend_mm;

  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const TemplateRoot& root : source.roots)
    centre += source.mesh.vertices[root.apex].head<2>() / static_cast<double>(source.roots.size());
  const double spread = random.normal(0.0, variation.divergence_mm);
  for (const TemplateRoot& root : source.roots) {
    RootShape drawn;
    if (source.roots.size() > 1) {
      const Eigen::Vector2d outward = source.mesh.vertices[root.apex].head<2>() - centre;
      drawn.shift = (spread + random.normal(0.0, 0.5 * variation.divergence_mm)) * outward.normalized() +
                    Eigen::Vector2d(random.normal(0.0, 0.4), random.normal(0.0, 0.4)) * variation.divergence_mm;
      drawn.stretch = random.normal(0.0, 0.05) * std::min(1.0, variation.divergence_mm);
    }
    drawn.shift_power = random.uniform(1.2, 2.5);
    drawn.taper = random.normal(0.0, 0.7 * variation.taper);
    drawn.cross_section = random.normal(0.0, 0.8 * variation.root_thickness);
    if (random.chance(variation.blunt_share)) drawn.blunt = random.uniform(0.0, 0.7);
    shape.roots.push_back(drawn);
  }
  if (random.chance(variation.wear_share)) {
    shape.wear = random.uniform(0.0, variation.wear_mm);
    shape.wear_slope = {random.normal(0.0, 0.08), random.normal(0.0, 0.12)};
  }
  return shape;
}

Eigen::Vector2d centre_at(const TemplateRoot& root, double z) {
  const double at = std::clamp((root.branch_z - z) / TemplateRoot::centreline_step, 0.0,
                               static_cast<double>(root.centreline.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), root.centreline.size() - 1);
  const auto j = std::min(i + 1, root.centreline.size() - 1);
  const double t = at - static_cast<double>(i);
  return (1 - t) * root.centreline[i] + t * root.centreline[j];
}

// Position of a template vertex after all maps but waves and wear.
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
  const double down = smooth_step(-h / 4);
  const double u = std::max(0.0, -h) / source.root_length;
  const double taper = 1 + shape.taper * (std::min(u, 1.0) - 0.35) * down;
  xy = xy.cwiseProduct(shape.scale.head<2>())
           .cwiseProduct(
               Eigen::Vector2d(1 + (shape.root_section.x() - 1) * down, 1 + (shape.root_section.y() - 1) * down)) *
       taper;
  xy += std::pow(u, shape.bend_power) * shape.bend + std::pow(u, 5) * shape.tip_bend;
  return {xy.x(), xy.y(), mapped};
}

// True if two roots run into each other, judged by vertices that lie beneath a close vertex of another root.
bool roots_collide(const SyntheticTooth& tooth, const std::vector<Eigen::Vector3d>& normals) {
  constexpr double cell = 0.6;
  const auto key = [](const Point& p, int dx, int dy, int dz) {
    const auto i = static_cast<std::int64_t>(std::floor(p.x() / cell)) + dx + 512;
    const auto j = static_cast<std::int64_t>(std::floor(p.y() / cell)) + dy + 512;
    const auto k = static_cast<std::int64_t>(std::floor(p.z() / cell)) + dz + 512;
    return (i << 20) | (j << 10) | k;
  };
  std::unordered_map<std::int64_t, std::vector<int>> cells;
  for (std::size_t v = 0; v < tooth.root.size(); ++v)
    if (tooth.root[v] >= 0) cells[key(tooth.mesh.vertices[v], 0, 0, 0)].push_back(static_cast<int>(v));
  for (std::size_t v = 0; v < tooth.root.size(); ++v) {
    if (tooth.root[v] < 0) continue;
    const Point& p = tooth.mesh.vertices[v];
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find(key(p, n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
      if (found == cells.end()) continue;
      for (int w : found->second) {
        const auto other = static_cast<std::size_t>(w);
        if (tooth.root[other] == tooth.root[v]) continue;
        const Eigen::Vector3d d = p - tooth.mesh.vertices[other];
        // Facing walls look at each other; the saddle between them, where normals agree, is left alone.
        if (d.norm() < cell && normals[v].dot(normals[other]) < -0.2 && d.dot(normals[other]) < 0.08) return true;
      }
    }
  }
  return false;
}

bool is_sound(const FamilyTemplate& source, const SyntheticTooth& tooth) {
  const double now = volume(tooth.mesh), before = volume(source.mesh);
  if (!(now > 0.35 * before && now < 3.5 * before)) return false;
  std::size_t turned = 0;
  for (std::size_t t = 0; t < tooth.mesh.triangles.size(); ++t)
    if (triangle_area_vector(tooth.mesh, t).dot(triangle_area_vector(source.mesh, t)) < 0) ++turned;
  if (turned * 2000 > tooth.mesh.triangles.size()) return false;
  return source.roots.size() < 2 || !roots_collide(tooth, vertex_normals(tooth.mesh));
}

// Rotation about z that brings the vertices `from` nearest to `to`, crown only: closed form of the planar Procrustes
// problem.
double crown_turn(const std::vector<Point>& from, const std::vector<Point>& to,
                  const std::vector<std::uint8_t>& crown) {
  Eigen::Vector2d mean_from = Eigen::Vector2d::Zero(), mean_to = mean_from;
  double count = 0;
  for (std::size_t v = 0; v < crown.size(); ++v) {
    if (crown[v] == 0) continue;
    mean_from += from[v].head<2>(), mean_to += to[v].head<2>(), count += 1;
  }
  mean_from /= count, mean_to /= count;
  double sine = 0, cosine = 0;
  for (std::size_t v = 0; v < crown.size(); ++v) {
    if (crown[v] == 0) continue;
    const Eigen::Vector2d a = from[v].head<2>() - mean_from, b = to[v].head<2>() - mean_to;
    sine += a.x() * b.y() - a.y() * b.x(), cosine += a.dot(b);
  }
  return std::atan2(sine, cosine);
}

SyntheticTooth draw_tooth(const FamilyTemplate& source, const ToothDimensions& mean, int type,
                          const ToothVariation& variation, RandomStream& random) {
  const ToothShape shape = draw_shape(source, mean, type, variation, random);
  // Small teeth would be bent out of shape by what large ones bear.
  const double warp = variation.warp_mm * std::clamp((mean.crown_mesiodistal + mean.crown_buccolingual) / 16, 0.7, 1.2);
  const Waves whole(random, 10, 7.0, 20.0, warp);
  const Waves fine(random, 8, 2.5, 6.0, 0.35 * warp);
  SyntheticTooth tooth;
  tooth.type = type;
  tooth.mesh.triangles = source.mesh.triangles;
  tooth.crown = source.crown;
  tooth.root = source.root;
  tooth.mesh.vertices.reserve(source.mesh.vertices.size());
  double top = -1e9;
  for (std::size_t v = 0; v < source.mesh.vertices.size(); ++v) {
    Point p = shaped(source, shape, source.mesh.vertices[v], source.root[v]);
    const double on_crown = smooth_step((p.z() + 1.5) / 3);
    p += whole(p) + (0.25 + 0.75 * on_crown) * fine(p);
    top = std::max(top, p.z());
    tooth.mesh.vertices.push_back(p);
  }
  if (shape.wear > 0) {
    for (Point& p : tooth.mesh.vertices) {
      const double over = p.z() - (top - shape.wear + shape.wear_slope.dot(p.head<2>()));
      if (over > -1) p.z() -= 0.92 * soft_plus(over, 0.15);
    }
  }
  tooth.junction = source.junction;
  tooth.junction.half_width = source.junction.half_width.cwiseProduct(shape.scale.head<2>());
  const Eigen::Vector2d s = shape.scale.head<2>();
  const std::array<double, 6> shrink{1, s.x(), s.y(), s.x() * s.x(), s.x() * s.y(), s.y() * s.y()};
  for (std::size_t i = 0; i < 6; ++i) tooth.junction.coefficients[i] *= shape.junction_scale / shrink[i];

  for (std::size_t r = 0; r < source.roots.size(); ++r) {
    Point lowest(0, 0, 1e9);
    for (std::size_t v = 0; v < tooth.root.size(); ++v)
      if (tooth.root[v] == static_cast<int>(r) && tooth.mesh.vertices[v].z() < lowest.z())
        lowest = tooth.mesh.vertices[v];
    tooth.apices.push_back(lowest);
  }
  tooth.crown_turn = crown_turn(source.mesh.vertices, tooth.mesh.vertices, tooth.crown);
  double bottom = 1e9;
  top = -1e9;
  for (const Point& p : tooth.mesh.vertices) bottom = std::min(bottom, p.z()), top = std::max(top, p.z());
  tooth.crown_height = top;
  tooth.root_length = -bottom;
  if (source.roots.size() > 1) tooth.furcation_z = shape.height(source.furcation_z);
  return tooth;
}

ToothVariation no_variation() {
  ToothVariation none;
  none.size = none.proportion = none.root_length_mm = none.trunk = none.warp_mm = none.root_thickness = none.taper = 0;
  none.distal_bend_mm = none.divergence_mm = none.wear_mm = none.wear_share = none.junction_curve = 0;
  none.blunt_share = 0;
  return none;
}

void require_type(const ToothFamilies& families, int type) {
  if (type < 0 || type >= tooth_type_count) throw UsageError("Tooth types go from 0 to 15.");
  if (families.templates[static_cast<std::size_t>(type)].mesh.vertices.empty())
    throw UsageError("The template of tooth type " + std::to_string(type) + " was not loaded.");
}

}  // namespace

SyntheticTooth generate_tooth(const ToothFamilies& families, int type, std::uint64_t seed,
                              const ToothVariation& variation) {
  require_type(families, type);
  RandomStream random(seed, static_cast<std::uint64_t>(type) + 1);
  for (int draw = 0; draw < 20; ++draw) {
    const TemplateLoan loan = choose_template(type, random, families);
    const FamilyTemplate& source = families.templates[static_cast<std::size_t>(loan.from)];
    SyntheticTooth tooth =
        draw_tooth(source, families.dimensions[static_cast<std::size_t>(type)], type, variation, random);
    tooth.crown_turn += loan.turn;
    if (is_sound(source, tooth)) return tooth;
  }
  throw NoResultError("No sound tooth of type " + std::to_string(type) + " came out of 20 draws.");
}

SyntheticTooth mean_tooth(const ToothFamilies& families, int type) {
  require_type(families, type);
  RandomStream unused(0);
  return draw_tooth(families.templates[static_cast<std::size_t>(type)],
                    families.dimensions[static_cast<std::size_t>(type)], type, no_variation(), unused);
}

}  // namespace rhizodont
