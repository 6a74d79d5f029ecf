// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// A generated tooth is a template whose crown takes the form of a draw from a statistical model of real crowns, sent
// through a chain of one-to-one maps (tooth_shape.cpp) and marked by wear. So the surface stays embedded, but for
// grooves that are squeezed shut and roots that run into each other, which is tested.
#include "families/tooth_family.hpp"

#include "base/random_stream.hpp"
#include "families/crown_features.hpp"
#include "families/self_crossing.hpp"
#include "families/tooth_shape.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace rhizodont {
namespace {

// A type's own template, as if it were borrowed from itself.
TemplateLoan own_template(const ToothFamilies& families, int type) {
  return {type, type, 1, 0, {}, families.crown_axes[static_cast<std::size_t>(type)]};
}

// The type's own template or a borrowed one.
const TemplateLoan& choose_template(int type, RandomStream& random, const ToothFamilies& families,
                                    const TemplateLoan& own) {
  double draw = random.uniform();
  for (const TemplateLoan& loan : families.loans) {
    if (loan.type != type) continue;
    if (draw < loan.share) return loan;
    draw -= loan.share;
  }
  return own;
}

bool is_sound(const FamilyTemplate& source, const SyntheticTooth& tooth) {
  const double now = volume(tooth.mesh), before = volume(source.mesh);
  if (!(now > 0.2 * before && now < 3.5 * before)) return false;
  std::size_t turned = 0;
  for (std::size_t t = 0; t < tooth.mesh.triangles.size(); ++t)
    if (triangle_area_vector(tooth.mesh, t).dot(triangle_area_vector(source.mesh, t)) < 0) ++turned;
  return turned * 500 <= tooth.mesh.triangles.size() && !crosses_itself(tooth.mesh);
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

// Adds a random crown of the type's statistical model, of the left side or the right, to template vertices.
void add_crown_form(const ToothFamilies& families, int type, int from, const ToothVariation& variation,
                    RandomStream& random, std::vector<Point>& vertices) {
  std::vector<const FamilyCrownModel*> models;
  for (const FamilyCrownModel& model : families.crown_models)
    if (model.type == type && model.from == from) models.push_back(&model);
  if (models.empty() || (variation.crown_modes <= 0 && variation.crown_mean <= 0 && type == from)) return;
  const FamilyCrownModel& model = *models[random.index(models.size())];
  const double factor = families.population.teeth[static_cast<std::size_t>(type)].crown_form_factor;
  // From the template's own crown (0) to the form of the model's mean (1) and a little beyond.
  const double share = std::clamp(model.usual_share + random.normal(0.0, variation.crown_mean), 0.0, 1.15);
  const double shift = share - model.template_share;
  Eigen::VectorXf sum = static_cast<float>(shift) * model.modes.mean_shift;
  Eigen::VectorXf coefficients(model.modes.modes.cols());
  for (Eigen::Index k = 0; k < coefficients.size(); ++k) {
    const double deviation = factor * variation.crown_modes * model.modes.deviations[static_cast<std::size_t>(k)];
    coefficients[k] = static_cast<float>(random.normal(0.0, deviation, 2.8));
  }
  sum.noalias() += model.modes.modes * coefficients;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    vertices[v] += sum.segment<3>(static_cast<Eigen::Index>(3 * v)).cast<double>();
}

// The junction's curve scaled like the crown across and like the drawn shape along.
JunctionHeight shaped_junction(const JunctionHeight& source, const ToothShape& shape) {
  JunctionHeight junction = source;
  const Eigen::Vector2d s = shape.scale.head<2>();
  junction.half_width = source.half_width.cwiseProduct(s);
  const std::array<double, 6> shrink{1, s.x(), s.y(), s.x() * s.x(), s.x() * s.y(), s.y() * s.y()};
  for (std::size_t i = 0; i < 6; ++i) junction.coefficients[i] *= shape.junction_scale / shrink[i];
  return junction;
}

// Tips, axes and lengths, read from the finished mesh.
void measure_roots(SyntheticTooth& tooth, std::size_t roots) {
  for (std::size_t r = 0; r < roots; ++r) {
    Point lowest(0, 0, 1e9), middle = Point::Zero();
    double highest = -1e9, count = 0;
    for (std::size_t v = 0; v < tooth.root.size(); ++v) {
      if (tooth.root[v] != static_cast<int>(r)) continue;
      const Point& p = tooth.mesh.vertices[v];
      if (p.z() < lowest.z()) lowest = p;
      highest = std::max(highest, p.z());
    }
    for (std::size_t v = 0; v < tooth.root.size(); ++v) {
      if (tooth.root[v] != static_cast<int>(r) || tooth.mesh.vertices[v].z() < highest - 1.2) continue;
      middle += tooth.mesh.vertices[v], count += 1;
    }
    tooth.apices.push_back(lowest);
    tooth.root_axes.emplace_back((middle / std::max(1.0, count) - lowest).normalized());
  }
  const Eigen::AlignedBox3d box = bounding_box(tooth.mesh.vertices);
  tooth.crown_height = box.max().z();
  tooth.root_length = -box.min().z();
}

SyntheticTooth grow_tooth(const ToothFamilies& families, int type, const TemplateLoan& loan,
                          const ToothVariation& variation, const SharedDraws& shared, RandomStream& random) {
  const int from = loan.from;
  const ToothPopulation& people = families.population.teeth[static_cast<std::size_t>(type)];
  const FamilyTemplate& source = template_of(families, from);
  const ToothDimensions& mean = families.dimensions[static_cast<std::size_t>(type)];
  const ToothShape shape = draw_shape(source, mean, type, people, variation, shared, random);
  // Small teeth would be bent out of shape by what large ones bear.
  const double warp = people.crown_form_factor * variation.warp_mm *
                      std::clamp((mean.crown_mesiodistal + mean.crown_buccolingual) / 16, 0.7, 1.2);
  const Waves whole(random, 10, 7.0, 20.0, warp);
  const Waves fine(random, 8, 2.5, 6.0, 0.35 * warp);
  SyntheticTooth tooth;
  tooth.type = type;
  tooth.own_template = type == from || from >= tooth_type_count;
  tooth.mesh = source.mesh;
  tooth.crown = source.crown;
  tooth.root = source.root;
  add_crown_form(families, type, from, variation, random, tooth.mesh.vertices);
  for (std::size_t v = 0; v < tooth.mesh.vertices.size(); ++v) {
    Point& p = tooth.mesh.vertices[v];
    p = shaped(source, shape, p, source.root[v]);
    if (warp > 0) p += whole(p) + 0.5 * fine(p);
  }
  tooth.crown_turn =
      loan.turn + crown_turn(loan.crown.empty() ? source.mesh.vertices : loan.crown, tooth.mesh.vertices, tooth.crown);
  tooth.crown_axis = Eigen::AngleAxisd(tooth.crown_turn - loan.turn, Eigen::Vector3d::UnitZ()) * loan.crown_axis;
  mark_crown(tooth, variation, shared.wear, random);
  tooth.junction = shaped_junction(source.junction, shape);
  measure_roots(tooth, source.roots.size());
  if (source.roots.size() > 1) tooth.furcation_z = shape.height(source.furcation_z);
  return tooth;
}

void require_type(const ToothFamilies& families, int type) {
  if (type < 0 || type >= tooth_type_count) throw UsageError("Tooth types go from 0 to 15.");
  if (families.templates[static_cast<std::size_t>(type)].mesh.vertices.empty())
    throw UsageError("The template of tooth type " + std::to_string(type) + " was not loaded.");
}

}  // namespace

const FamilyTemplate& template_of(const ToothFamilies& families, int from) {
  return from < tooth_type_count ? families.templates[static_cast<std::size_t>(from)]
                                 : families.further[static_cast<std::size_t>(from - tooth_type_count)];
}

ToothVariation no_variation() {
  ToothVariation none;
  none.crown_modes = none.crown_mean = none.size = none.proportion = none.crown_height = 0;
  none.root_length = none.trunk = none.warp_mm = none.root_thickness = none.taper = none.lean = 0;
  none.distal_bend_mm = none.curvature = none.dilaceration = none.divergence_mm = none.fusion = 0;
  none.junction_curve = none.blunt_share = none.short_roots = none.open_apex_share = none.resorption_share = 0;
  none.bulbous_share = none.deciduous_share = 0;
  none.wear_mm = none.wear_share = none.decay_share = none.bracket_share = 0;
  return none;
}

std::optional<SyntheticTooth> draw_tooth(const ToothFamilies& families, int type, std::uint64_t seed, int draw,
                                         const ToothVariation& variation, const SharedDraws& shared) {
  require_type(families, type);
  // Each draw has a stream of its own, so that teeth that differ in what they share with others do so in nothing else.
  RandomStream random(seed, (static_cast<std::uint64_t>(draw) << 32) + static_cast<std::uint64_t>(type) + 1);
  const TemplateLoan own = own_template(families, type);
  const TemplateLoan& loan = choose_template(type, random, families, own);
  SyntheticTooth tooth = grow_tooth(families, type, loan, variation, shared, random);
  if (!is_sound(template_of(families, loan.from), tooth)) return std::nullopt;
  return tooth;
}

SyntheticTooth generate_tooth(const ToothFamilies& families, int type, std::uint64_t seed,
                              const ToothVariation& variation, const SharedDraws& shared) {
  for (int draw = 0; draw < most_tooth_draws; ++draw)
    if (auto tooth = draw_tooth(families, type, seed, draw, variation, shared)) return std::move(*tooth);
  throw NoResultError(fmt::format("No sound tooth of type {} came out of {} draws.", type, most_tooth_draws));
}

SyntheticTooth mean_tooth(const ToothFamilies& families, int type) {
  require_type(families, type);
  RandomStream unused(0);
  const TemplateLoan own = own_template(families, type);
  return grow_tooth(families, type, own, no_variation(), {}, unused);
}

}  // namespace rhizodont
