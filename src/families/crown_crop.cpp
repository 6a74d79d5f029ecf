// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Cropped crowns as scanners give them. Crown share of 1/2 to 1/8: "Completing Dental Models While Preserving Crown
// Geometry and Meshing Topology", 3.3.
#include "families/crown_crop.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/geometry.hpp"
#include "mesh/principal_axis.hpp"
#include "rhizodont/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace rhizodont {
namespace {

double angle_between(double a, double b) { return std::remainder(a - b, 2 * std::numbers::pi); }

// Cuts triangles where `level` is negative away. Vertices exactly on the line are pushed off it by the caller.
class Clipper {
 public:
  Clipper(const TriangleMesh& mesh, const std::vector<double>& level) : mesh_(mesh), level_(level) {
    kept_.assign(mesh.vertices.size(), -1);
    for (const Triangle& t : mesh.triangles) clip(t);
  }

  TriangleMesh take() { return std::move(result_); }

 private:
  bool inside(int v) const { return level_[static_cast<std::size_t>(v)] > 0; }

  int keep(int v) {
    int& index = kept_[static_cast<std::size_t>(v)];
    if (index < 0) {
      index = static_cast<int>(result_.vertices.size());
      result_.vertices.push_back(mesh_.vertices[static_cast<std::size_t>(v)]);
    }
    return index;
  }

  int crossing(int a, int b) {
    if (a > b) std::swap(a, b);
    const std::uint64_t key = (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
    const auto [found, is_new] = crossings_.try_emplace(key, static_cast<int>(result_.vertices.size()));
    if (is_new) {
      const double la = level_[static_cast<std::size_t>(a)], lb = level_[static_cast<std::size_t>(b)];
      const double t = la / (la - lb);
      result_.vertices.push_back((1 - t) * mesh_.vertices[static_cast<std::size_t>(a)] +
                                 t * mesh_.vertices[static_cast<std::size_t>(b)]);
    }
    return found->second;
  }

  void clip(const Triangle& t) {
    const int count = int{inside(t[0])} + int{inside(t[1])} + int{inside(t[2])};
    if (count == 0) return;
    if (count == 3) {
      result_.triangles.push_back({keep(t[0]), keep(t[1]), keep(t[2])});
      return;
    }
    // Turn the triangle so that the corner that differs from the others comes first.
    std::size_t i = 0;
    while (inside(t[i]) == inside(t[(i + 1) % 3]) || inside(t[i]) == inside(t[(i + 2) % 3])) ++i;
    const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    const int ab = crossing(a, b), ac = crossing(a, c);
    if (count == 1) {
      result_.triangles.push_back({keep(a), ab, ac});
    } else {
      const int kb = keep(b), kc = keep(c);
      result_.triangles.push_back({ab, kb, kc});
      result_.triangles.push_back({ab, kc, ac});
    }
  }

  const TriangleMesh& mesh_;
  const std::vector<double>& level_;
  std::vector<int> kept_;
  std::unordered_map<std::uint64_t, int> crossings_;
  TriangleMesh result_;
};

TriangleMesh highest_piece(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 2; ++i) sets.join(t[i], t[i + 1]);
  std::size_t top = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].z() > mesh.vertices[top].z()) top = v;
  const int wanted = sets.find(static_cast<int>(top));
  TriangleMesh piece;
  std::vector<int> index(mesh.vertices.size(), -1);
  for (const Triangle& t : mesh.triangles) {
    if (sets.find(t[0]) != wanted) continue;
    Triangle kept{};
    for (std::size_t i = 0; i < 3; ++i) {
      int& at = index[static_cast<std::size_t>(t[i])];
      if (at < 0) {
        at = static_cast<int>(piece.vertices.size());
        piece.vertices.push_back(mesh.vertices[static_cast<std::size_t>(t[i])]);
      }
      kept[i] = at;
    }
    piece.triangles.push_back(kept);
  }
  return piece;
}

// A connected piece of a closed surface of genus 0 is a disc just if its Euler number is 1.
bool is_disc(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(std::minmax({t[i], t[(i + 1) % 3]}));
  std::sort(edges.begin(), edges.end());
  const auto count = std::unique(edges.begin(), edges.end()) - edges.begin();
  return static_cast<std::ptrdiff_t>(mesh.vertices.size()) - count +
             static_cast<std::ptrdiff_t>(mesh.triangles.size()) ==
         1;
}

}  // namespace

double GumLine::height(const JunctionHeight& junction, double x, double y) const {
  const double angle = std::atan2(y / junction.half_width.y(), x / junction.half_width.x());
  double z = offset_mm + slope.dot(Eigen::Vector2d(x, y)) + junction_share * junction(x, y);
  for (std::size_t k = 0; k < wave_mm.size(); ++k)
    z += wave_mm[k] * std::sin(static_cast<double>(k + 1) * angle + wave_phase[k]);
  for (std::size_t side = 0; side < 2; ++side) {
    const double d = angle_between(angle, side == 0 ? std::numbers::pi : 0.0) / gap_width[side];
    z += gap_mm[side] * std::exp(-0.5 * d * d);
  }
  const double beside = angle_between(angle, side_angle) / side_width;
  return z + side_mm * std::exp(-0.5 * beside * beside);
}

Eigen::Vector2d slope_across_long_axis(const SyntheticTooth& tooth) {
  constexpr double steepest = 0.36;  // tan 20 degrees
  const Eigen::Vector3d axis = principal_axis(tooth.mesh.vertices);
  const Eigen::Vector2d slope = -axis.head<2>() / axis.z();
  return slope.norm() < steepest ? slope : Eigen::Vector2d::Zero();
}

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double gum_lean = 4.5 * degree;  // along x and y
constexpr double steep_share = 0.08, least_steep = 15 * degree, most_steep = 35 * degree;
constexpr double contact_share = 0.5;  // of crowns that lack their surface below the contacts

Eigen::Vector2d draw_slope(double deviation, RandomStream& random) {
  const double x = random.normal(0.0, deviation), y = random.normal(0.0, deviation);
  return {std::tan(x), std::tan(y)};
}

// The gum's own line: flatter than the junction, with papillae between the teeth. Lean and one-sided margins: as wide
// as the borders of labelled scans (bench_gum_lines).
void draw_gum_margin(GumLine& line, double crown_height, RandomStream& random) {
  line.junction_share = random.uniform(0.4, 1.15);
  const double kind = random.uniform();
  line.offset_mm = kind < 0.7    ? random.uniform(-0.6, 1.6)
                   : kind < 0.93 ? random.uniform(-1.0, 3.0)
                                 : random.uniform(-2.0, 4.0);
  line.slope = draw_slope(gum_lean, random);
  if (random.chance(steep_share)) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const double lean = std::tan(random.uniform(least_steep, most_steep));
    line.slope = lean * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  if (random.chance(0.3)) {
    line.side_mm = random.uniform(0.5, 3.0);
    line.side_angle = random.uniform(0, 2 * std::numbers::pi);
    line.side_width = random.uniform(0.5, 1.2);
  }
  // Between neighbours that touch, no scanner sees the surface below the contact; behind the last tooth it does.
  if (random.chance(contact_share)) {
    for (std::size_t side = 0; side < 2; ++side) {
      line.gap_mm[side] = random.chance(0.85) ? crown_height * random.uniform(0.25, 0.8) : 0.0;
      line.gap_width[side] = random.uniform(0.3, 0.65);
    }
  }
}

}  // namespace

GumLine draw_gum_line(const SyntheticTooth& tooth, double paper_share, double gap_probability, RandomStream& random) {
  GumLine line;
  const double kind = random.uniform();
  for (std::size_t k = 0; k < line.wave_mm.size(); ++k) {
    line.wave_mm[k] = random.normal(0.0, 0.22 / static_cast<double>(k + 1));
    line.wave_phase[k] = random.uniform(0, 2 * std::numbers::pi);
  }
  constexpr double trimmed_lean = 2.5 * degree;
  if (kind < paper_share) {
    const double length = tooth.crown_height + tooth.root_length;
    line.junction_share = random.uniform(0.0, 0.3);
    line.offset_mm = tooth.crown_height - length * random.uniform(1.0 / 8, 1.0 / 2);
    line.slope = slope_across_long_axis(tooth) + draw_slope(trimmed_lean, random);
  } else if (kind < paper_share + 0.35 * (1 - paper_share)) {  // a crown trimmed from a whole tooth: nearly flat
    line.junction_share = random.uniform(0.0, 0.35);
    line.offset_mm = random.uniform(-0.8, 2.2);
    line.slope = slope_across_long_axis(tooth) + draw_slope(trimmed_lean, random);
  } else {
    draw_gum_margin(line, tooth.crown_height, random);
  }
  if (random.chance(gap_probability) && line.gap_mm[0] <= 0 && line.gap_mm[1] <= 0) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double most = random.chance(0.2) ? 4.0 : 2.2;
      line.gap_mm[side] = random.chance(0.7) ? random.uniform(0.0, most) : 0.0;
      line.gap_width[side] = random.uniform(0.15, 0.45);
    }
  }
  return line;
}

std::optional<TriangleMesh> crop_crown(const SyntheticTooth& tooth, const GumLine& line) {
  std::vector<double> level;
  level.reserve(tooth.mesh.vertices.size());
  for (const Point& p : tooth.mesh.vertices) {
    double value = p.z() - line.height(tooth.junction, p.x(), p.y());
    if (std::abs(value) < 1e-3) value = value < 0 ? -1e-3 : 1e-3;  // no slivers through vertices
    level.push_back(value);
  }
  const TriangleMesh above = Clipper(tooth.mesh, level).take();
  if (above.triangles.empty()) return std::nullopt;
  TriangleMesh crown = highest_piece(above);
  if (crown.triangles.size() < 50 || !is_disc(crown)) return std::nullopt;
  return crown;
}

CroppedCrown draw_cropped_crown(const SyntheticTooth& tooth, double paper_share, double gap_probability,
                                RandomStream& random) {
  for (int attempt = 0; attempt < 10; ++attempt) {
    GumLine line = draw_gum_line(tooth, paper_share, gap_probability, random);
    for (int lower = 0; lower < 3; ++lower) {
      if (auto crown = crop_crown(tooth, line)) return {std::move(*crown), line};
      // Cut among the cusps: take more of the tooth. Cut below the furcation: take less.
      line.offset_mm += line.offset_mm > 0 ? -0.8 : 1.5;
    }
  }
  throw NoResultError("No gum line left a crown in one piece with one border.");
}

CroppedCrown trim_clean(const SyntheticTooth& tooth, RandomStream& random) {
  GumLine line;
  line.junction_share = 0.8;
  line.offset_mm = 0.4;
  for (std::size_t k = 1; k < line.wave_mm.size(); ++k) {
    line.wave_mm[k] = random.normal(0.0, 0.08);
    line.wave_phase[k] = random.uniform(0, 6.28);
  }
  auto crown = crop_crown(tooth, line);
  if (!crown) throw NoResultError("This tooth's crown does not come off in one piece.");
  return {std::move(*crown), line};
}

void add_skirt_remains(TriangleMesh& crown, double width_mm, RandomStream& random) {
  // Directed border edges: from each vertex to the next.
  std::unordered_map<std::uint64_t, int> uses;
  const auto key = [](int a, int b) { return (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b); };
  for (const Triangle& t : crown.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++uses[key(t[i], t[(i + 1) % 3])];
  std::vector<std::pair<int, int>> border;
  for (const Triangle& t : crown.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (!uses.contains(key(t[(i + 1) % 3], t[i]))) border.emplace_back(t[i], t[(i + 1) % 3]);

  struct Flap {
    double middle, half_width, length, fall;
  };
  std::vector<Flap> flaps;
  for (std::uint64_t i = 0, count = 1 + random.index(3); i < count; ++i)
    flaps.push_back({random.uniform(0, 2 * std::numbers::pi), random.uniform(0.2, 0.9),
                     width_mm * random.uniform(0.3, 1.0), random.uniform(-0.3, 1.2)});
  Point middle = Point::Zero();
  for (const auto& [from, to] : border)
    middle += crown.vertices[static_cast<std::size_t>(from)] / static_cast<double>(border.size());

  std::map<int, int> outer;  // border vertex to the flap's edge; itself where there is no flap
  const auto outer_of = [&](int v) {
    const auto [found, is_new] = outer.try_emplace(v, v);
    if (!is_new) return found->second;
    const Point p = crown.vertices[static_cast<std::size_t>(v)];
    const Eigen::Vector2d d = p.head<2>() - middle.head<2>();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Flap& flap : flaps) {
      const double a = angle_between(std::atan2(d.y(), d.x()), flap.middle) / flap.half_width;
      if (std::abs(a) >= 1) continue;
      const Eigen::Vector2d away = d.normalized() * std::cos(flap.fall);
      sum += flap.length * (1 - a * a) * Eigen::Vector3d(away.x(), away.y(), -std::sin(flap.fall));
    }
    if (sum.norm() > 0.05) {
      found->second = static_cast<int>(crown.vertices.size());
      crown.vertices.emplace_back(p + sum);
    }
    return found->second;
  };
  for (const auto& [from, to] : border) {
    const int a = outer_of(from), b = outer_of(to);
    if (a != from) crown.triangles.push_back({to, from, a});
    if (b != to) crown.triangles.push_back({to, a, b});
  }
}

CanonicalFrame frame_of_crop(const TriangleMesh& crown, double turn) {
  return frame_of_crop(crown, growth_axis(crown), turn);
}

CanonicalFrame frame_of_crop(const TriangleMesh& crown, const Eigen::Vector3d& axis, double turn) {
  CanonicalFrame frame;
  const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ().eval());
  frame.rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix() * upright.toRotationMatrix();
  frame.centre = area_centroid(crown);
  return frame;
}

}  // namespace rhizodont
