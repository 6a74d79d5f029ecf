// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_crowns.hpp"

#include "teeth/fdi.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

int permanent(Jaw jaw, std::size_t j) {
  const int quadrant = jaw == Jaw::upper ? (arch_right(j) ? 1 : 2) : (arch_right(j) ? 4 : 3);
  return 10 * quadrant + arch_place(j);
}

/// How a milk tooth is made of a permanent crown: of which place, and its size along the arch, across and up.
struct MilkForm {
  int of_place = 1;
  Eigen::Vector3d size;
};

MilkForm milk_form(Jaw jaw, int place) {
  if (place == 1) return {1, {0.78, 0.75, 0.62}};
  if (place == 2) return {2, {0.80, 0.78, 0.64}};
  if (place == 3) return {3, {0.86, 0.78, 0.68}};
  if (jaw == Jaw::upper) return place == 4 ? MilkForm{6, {0.70, 0.76, 0.85}} : MilkForm{6, {0.84, 0.86, 0.88}};
  return place == 4 ? MilkForm{6, {0.72, 0.68, 0.85}} : MilkForm{6, {0.86, 0.84, 0.88}};
}

/// Coefficients of a crown model for the left side and the right one, which resemble each other.
std::array<Eigen::VectorXf, 2> draw_coefficients(const ArchCrownForm& form, double factor, RandomStream& random) {
  constexpr double alike = 0.8;
  const auto count = static_cast<Eigen::Index>(form.modes.size());
  std::array<Eigen::VectorXf, 2> both{Eigen::VectorXf(count), Eigen::VectorXf(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const double deviation = factor * form.deviations[static_cast<std::size_t>(k)];
    const double left = random.normal(0.0, 1.0), own = random.normal(0.0, 1.0);
    both[0][k] = static_cast<float>(deviation * left);
    both[1][k] = static_cast<float>(deviation * (alike * left + std::sqrt(1 - alike * alike) * own));
  }
  return both;
}

TriangleMesh formed_crown(const ArchCrownForm& form, const Eigen::VectorXf& coefficients) {
  Eigen::MatrixX3f moved = Eigen::MatrixX3f::Zero(static_cast<Eigen::Index>(form.mean.vertices.size()), 3);
  for (std::size_t k = 0; k < form.modes.size(); ++k)
    moved += coefficients[static_cast<Eigen::Index>(k)] * form.modes[k];
  TriangleMesh mesh = form.mean;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] += moved.row(static_cast<Eigen::Index>(v)).transpose().cast<double>();
  return mesh;
}

/// The same with the finer forms of a real crown. @param back  how far it goes back to the mean first, 0..1
TriangleMesh formed_crown(const RealCrown& crown, const ArchCrownForm& form, const Eigen::VectorXf& coefficients,
                          double back) {
  const TriangleMesh drawn = formed_crown(form, coefficients);
  TriangleMesh mesh{crown.as_mean, crown.mesh.triangles};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    mesh.vertices[v] += back * crown.to_mean[v];
    for (const auto& [index, share] : crown.carriers[v]) {
      const auto at = static_cast<std::size_t>(index);
      mesh.vertices[v] += static_cast<double>(share) * (drawn.vertices[at] - form.mean.vertices[at]);
    }
  }
  return mesh;
}

void mirror_x(TriangleMesh& mesh) {
  for (Point& p : mesh.vertices) p.x() = -p.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Places 1..8 of the left side, arch's frame: of a person or of the mean arch.
std::array<Point, 8> left_places(const ArchSource& source, const ArchPerson& person, Jaw jaw) {
  std::array<Point, 8> places;
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t row = i + (jaw == Jaw::upper ? 0 : 7);
    const auto& forms = source.forms[row];
    places[i] = 0.5 * (forms[0].place + forms[1].place);
    if (person.real_person >= 0) {
      const auto& crowns = source.people[static_cast<std::size_t>(person.real_person)][row];
      places[i] = 0.5 * (crowns[0].place + crowns[1].place);
    }
  }
  places[7] = places[6] + 0.97 * (places[6] - places[5]);
  return places;
}

/// Width along the arch and height of a crown in its own frame.
void measure_crown(ArchCrown& crown) {
  double low = 0, high = 0;
  for (const Point& p : crown.mesh.vertices) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
    crown.height = std::max(crown.height, p.z());
  }
  crown.width = high - low;
}

}  // namespace

ArchPerson draw_arch_person(const ArchSource& source, std::uint64_t seed, const ArchDrawOptions& options) {
  RandomStream random(seed, 500);
  ArchPerson person;
  Eigen::Matrix<double, 2 * arch_rows, 1> draw;
  for (double& value : draw) value = random.normal(0.0, 1.0);
  const Eigen::Matrix<double, 2 * arch_rows, 1> sizes = options.shape * (source.size_root * draw);
  const double overall = random.normal(0.0, 0.025);
  for (std::size_t i = 0; i < person.size.size(); ++i)
    person.size[i] = 1 + options.shape * overall + std::clamp(sizes[static_cast<Eigen::Index>(i)], -0.2, 0.2);
  const double worn = random.uniform();
  if (random.chance(options.wear_share)) person.wear_mm = 2.2 * worn * worn * worn + 0.1;
  person.margin_shift = options.shape * random.normal(0.1, 0.25);
  if (random.chance(0.1 * options.shape)) person.margin_shift -= random.uniform(0.5, 2.2);
  const double kind = random.uniform();
  person.crowded = kind < options.crowding_share;
  person.spaced = !person.crowded && kind < options.crowding_share + options.spacing_share;
  const double room = random.uniform();
  person.room_mm = person.crowded ? 0.3 + 1.9 * room * room : person.spaced ? random.uniform(0.2, 1.3) : 0;
  person.child = random.chance(options.milk_share);
  person.brackets = random.chance(options.bracket_share);
  person.mirrored = random.chance(0.5);
  const double real = random.uniform();
  if (!source.people.empty() && !person.child && real < options.real_crown_share)
    person.real_person = static_cast<int>(random.index(source.people.size()));
  const double detail = random.uniform();
  if (!source.people.empty() && detail < 0.75) person.detail = 1;
  person.disorder = random.uniform(0.45, 1.1);
  return person;
}

std::vector<LooseCrown> draw_loose_crowns(const ArchSource& source, const ArchPerson& person, Jaw jaw,
                                          RandomStream& random, const ArchDrawOptions& options) {
  // The upper jaw is turned about z, so that its crowns point up too.
  const double sense = jaw == Jaw::upper ? -1 : 1;
  const Eigen::Vector3d turned(sense, sense, 1);
  const std::array<Point, 8> left = left_places(source, person, jaw);
  std::vector<Point> places;
  for (std::size_t j = 0; j < arch_places; ++j) {
    Point p = left[static_cast<std::size_t>(arch_place(j) - 1)];
    if (arch_right(j)) p.x() = -p.x();
    places.emplace_back(p.cwiseProduct(turned));
  }
  std::array<std::size_t, arch_rows> side{};
  std::vector<std::array<Eigen::VectorXf, 2>> coefficients;
  std::array<const std::array<RealCrown, 2>*, arch_rows> detail{};
  const double back = random.uniform(0.2, 1.0);
  for (std::size_t row = 0; row < arch_rows; ++row) {
    side[row] = random.index(2);
    if (random.chance(person.detail) && !source.people.empty())
      detail[row] = &source.people[random.index(source.people.size())][row];
    coefficients.push_back(draw_coefficients(source.forms[row][side[row]], options.shape, random));
  }
  std::vector<LooseCrown> loose(arch_places);
  for (std::size_t j = 0; j < arch_places; ++j) {
    LooseCrown& one = loose[j];
    const bool right = arch_right(j);
    const int place = arch_place(j);
    // Whether a child's tooth is a milk tooth; the first permanent ones are incisors and first molars.
    const bool milk = person.child && place <= 5 && !(place <= 2 && random.chance(0.65)) && random.chance(0.85);
    const MilkForm as_milk = milk ? milk_form(jaw, place) : MilkForm{};
    const int of_place = milk ? as_milk.of_place : std::min(place, 7);
    const std::size_t row = static_cast<std::size_t>(of_place - 1) + (jaw == Jaw::upper ? 0 : 7);
    one.crown.fdi = permanent(jaw, j) + (milk ? 40 : 0);
    TriangleMesh mesh;
    if (person.real_person >= 0) {
      const std::size_t of_side = right != person.mirrored ? 1 : 0;
      mesh = source.people[static_cast<std::size_t>(person.real_person)][row][of_side].mesh;
    } else if (detail[row] != nullptr) {
      mesh =
          formed_crown((*detail[row])[side[row]], source.forms[row][side[row]], coefficients[row][right ? 1 : 0], back);
    } else {
      mesh = formed_crown(source.forms[row][side[row]], coefficients[row][right ? 1 : 0]);
    }
    if (right) mirror_x(mesh);
    double size = person.size[row + (right ? arch_rows : 0)];
    if (place == 8) size *= random.normal(0.92, 0.07);
    for (Point& p : mesh.vertices) p = size * p.cwiseProduct(turned);
    one.place = places[j];
    const Point before = places[j > 0 ? j - 1 : j], after = places[std::min(j + 1, arch_places - 1)];
    one.tangent = Eigen::Vector2d(after.x() - before.x(), after.z() - before.z()).normalized();
    const Eigen::Vector2d outward = sense * Eigen::Vector2d(-one.tangent.y(), one.tangent.x());
    one.crown.rim =
        find_rim(mesh, Eigen::Vector3d::UnitY(), Eigen::Vector3d(outward.x(), 0, outward.y()), one.crown.to_work);
    Eigen::Vector3d stretch(1, 1, 1);
    for (double& value : stretch) value += options.shape * random.normal(0.0, 0.025);
    if (milk) stretch = stretch.cwiseProduct(as_milk.size);
    const Eigen::Isometry3d inverse = one.crown.to_work.inverse();
    for (Point& p : mesh.vertices) p = (inverse * p).cwiseProduct(stretch);
    for (std::size_t i = 0; i < rim_sectors; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / rim_sectors;
      one.crown.rim.radius[i] *= std::hypot(stretch.x() * std::cos(angle), stretch.y() * std::sin(angle));
      one.crown.rim.height[i] *= stretch.z();
    }
    one.crown.mesh = std::move(mesh);
    measure_crown(one.crown);
  }
  return loose;
}

}  // namespace rhizodont
