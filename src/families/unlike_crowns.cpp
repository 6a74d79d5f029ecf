// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Preparations: total convergence of 10 to 20 degrees, chamfers of about 1 mm and 1.5 to 2 mm off the top are what
// textbooks ask for. Scan bodies are 4 to 6 mm wide and 5 to 10 mm high.
#include "families/unlike_crowns.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/smooth_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace rhizodont {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Height of a crown's border by direction about its axis, smooth.
class BorderHeight {
 public:
  explicit BorderHeight(const TriangleMesh& crown) : centre_(bounding_box(crown.vertices).center()) {
    std::vector<std::array<double, 3>> border;  // cosine, sine, height
    for (const auto& loop : border_loops(crown))
      for (const int v : loop) {
        const Point p = crown.vertices[static_cast<std::size_t>(v)] - centre_;
        const double r = std::hypot(p.x(), p.y());
        border.push_back({p.x() / r, p.y() / r, p.z() + centre_.z()});
      }
    for (std::size_t i = 0; i < height_.size(); ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(height_.size());
      double sum = 0, weights = 0;
      for (const auto& [c, s, z] : border) {
        const double w = std::exp(12 * (c * std::cos(angle) + s * std::sin(angle) - 1)) + 1e-9;
        sum += w * z, weights += w;
      }
      height_[i] = sum / weights;
    }
  }

  const Point& centre() const { return centre_; }

  double operator()(const Point& p) const {
    const double turns = std::atan2(p.y() - centre_.y(), p.x() - centre_.x()) / (2 * std::numbers::pi) + 1;
    const double at = turns * static_cast<double>(height_.size());
    const auto i = static_cast<std::size_t>(at);
    return std::lerp(height_[i % height_.size()], height_[(i + 1) % height_.size()], at - std::floor(at));
  }

 private:
  Point centre_;
  std::array<double, 48> height_{};
};

/// What grinding does to a crown. All in mm and radians.
struct Grinding {
  double margin, chamfer, taper, off_the_top, flatness;
};

TriangleMesh ground(TriangleMesh crown, const Grinding& how) {
  const BorderHeight border(crown);
  const double top = bounding_box(crown.vertices).max().z();
  for (Point& p : crown.vertices) {
    const double foot = border(p) + how.margin, over = p.z() - foot;
    if (over <= 0) continue;
    const double dx = p.x() - border.centre().x(), dy = p.y() - border.centre().y();
    const double radius = std::hypot(dx, dy);
    const double inward = how.chamfer * smooth_step(over / 0.6) + std::tan(how.taper) * over;
    const double share = radius > 0 ? std::max(0.3, 1 - inward / radius) : 1;
    p.x() = border.centre().x() + share * dx;
    p.y() = border.centre().y() + share * dy;
    // Heights are squeezed, near the top most, so that cusps and grooves go.
    const double whole = top - foot, left = std::max(1.0, whole - how.off_the_top);
    double height = over / whole * left;
    const double knee = left - 1.2;
    if (height > knee) height = knee + how.flatness * (height - knee);
    p.z() = foot + height;
  }
  return crown;
}

/// A surface of revolution about z, open below, facing outward: (radius, height) from the border to the top, where the
/// radius is 0.
TriangleMesh revolved(const std::vector<std::pair<double, double>>& profile) {
  constexpr int around = 40;
  TriangleMesh mesh;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      mesh.vertices.emplace_back(profile[i].first * std::cos(angle), profile[i].first * std::sin(angle),
                                 profile[i].second);
    }
  const int rings = static_cast<int>(profile.size()) - 1, top = rings * around;
  mesh.vertices.emplace_back(0, 0, profile.back().second);
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k) {
      const int a = i * around + k, b = i * around + (k + 1) % around;
      if (i + 1 == rings) {
        mesh.triangles.push_back({a, b, top});
        continue;
      }
      mesh.triangles.push_back({a, b, b + around});
      mesh.triangles.push_back({a, b + around, a + around});
    }
  return mesh;
}

/// Straight lines between corners, cut into pieces of about 0.4 mm.
std::vector<std::pair<double, double>> profile_through(const std::vector<std::pair<double, double>>& corners) {
  std::vector<std::pair<double, double>> profile;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const auto [r, z] = corners[i];
    const auto [r2, z2] = corners[i + 1];
    const int pieces = std::max(1, static_cast<int>(std::hypot(r2 - r, z2 - z) / 0.4));
    for (int k = 0; k < pieces; ++k) profile.emplace_back(r + (r2 - r) * k / pieces, z + (z2 - z) * k / pieces);
  }
  profile.push_back(corners.back());
  return profile;
}

TriangleMesh turned_stump(RandomStream& random) {
  const double radius = random.uniform(2.5, 5), margin = random.uniform(0.2, 1), height = random.uniform(3, 7);
  const double shoulder = radius - random.uniform(0.6, 1.3);
  const double upper = std::max(0.8, shoulder - std::tan(degree * random.uniform(4, 12)) * height);
  const double round = random.uniform(0.1, 0.8);
  return revolved(profile_through({{radius, 0},
                                   {radius, margin},
                                   {shoulder, margin + 0.4},
                                   {upper, height - round},
                                   {upper - 0.6, height},
                                   {0, height}}));
}

TriangleMesh scan_body(RandomStream& random) {
  const double radius = random.uniform(1.8, 3), height = random.uniform(5, 10), bevel = random.uniform(0.1, 0.8);
  TriangleMesh body =
      revolved(profile_through({{radius, 0}, {radius, height - bevel}, {radius - bevel, height}, {0, height}}));
  if (random.chance(0.6)) {
    const double flat = random.uniform(0.5, 0.9) * radius, from = height * random.uniform(0.2, 0.7);
    for (Point& p : body.vertices)
      if (p.z() > from) p.x() = std::min(p.x(), flat);
  }
  return body;
}

TriangleMesh dome(RandomStream& random) {
  const Eigen::Vector3d half(random.uniform(2.5, 5.5), random.uniform(2.5, 5.5), random.uniform(3, 8));
  const double power = random.chance(0.6) ? 2 : random.uniform(2.2, 6);
  std::vector<std::pair<double, double>> profile;
  constexpr int steps = 20;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / steps;
    profile.emplace_back(i == steps ? 0.0 : std::cos(angle), std::sin(angle));
  }
  TriangleMesh mesh = revolved(profile);
  for (Point& p : mesh.vertices) {
    double sum = 0;
    for (Eigen::Index k = 0; k < 3; ++k) sum += std::pow(std::abs(p[k]), power);
    p = (p / std::pow(sum, 1 / power)).cwiseProduct(half);
  }
  return mesh;
}

/// What lies on one side of a plane about along the axis; `place`: from the crown's middle, in half widths.
TriangleMesh beside_plane(const TriangleMesh& crown, double place, double lean, RandomStream& random) {
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d normal(std::cos(angle) * std::cos(lean), std::sin(angle) * std::cos(lean), std::sin(lean));
  const Point middle = area_centroid(crown);
  double reach = 0;
  for (const Point& p : crown.vertices) reach = std::max(reach, normal.dot(p - middle));
  std::vector<bool> keep;
  for (const Triangle& t : crown.triangles)
    keep.push_back(std::all_of(t.begin(), t.end(), [&](int v) {
      return normal.dot(crown.vertices[static_cast<std::size_t>(v)] - middle) < place * reach;
    }));
  const TriangleMesh part = submesh(crown, keep).mesh;
  const ConnectedComponents pieces = connected_components(part);
  std::vector<int> size(static_cast<std::size_t>(pieces.count), 0);
  for (const int piece : pieces.of_triangle) ++size[static_cast<std::size_t>(piece)];
  const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
  std::vector<bool> in_largest;
  for (const int piece : pieces.of_triangle) in_largest.push_back(piece == largest);
  return submesh(part, in_largest).mesh;
}

TriangleMesh joined(const TriangleMesh& crown, RandomStream& random) {
  const Eigen::AlignedBox3d box = bounding_box(crown.vertices);
  TriangleMesh both = crown;
  const int first = static_cast<int>(crown.vertices.size());
  const double size = random.uniform(0.85, 1.15), overlap = random.uniform(0.9, 1);
  for (const Point& p : crown.vertices) {
    Point q = box.center() + size * (p - box.center());
    q.x() += overlap * 0.5 * (1 + size) * box.sizes().x();
    q.z() += random.uniform(0, 0.01);
    both.vertices.push_back(q);
  }
  for (const Triangle& t : crown.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  // Where they touch, either ends at the plane between them.
  const double plane = box.center().x() + 0.5 * overlap * box.sizes().x();
  std::vector<bool> keep;
  for (const Triangle& t : both.triangles)
    keep.push_back(std::all_of(t.begin(), t.end(), [&](int v) {
      return (v < first) == (both.vertices[static_cast<std::size_t>(v)].x() < plane);
    }));
  return submesh(both, keep).mesh;
}

}  // namespace

std::string name_of(UnlikeKind kind) {
  constexpr std::array<const char*, unlike_kind_count> names{"stump",        "turned stump", "scan body", "half",
                                                             "side missing", "dome",         "hollow",    "joined"};
  return names[static_cast<std::size_t>(kind)];
}

TriangleMesh unlike_crown(const TriangleMesh& crown, UnlikeKind kind, RandomStream& random) {
  switch (kind) {
    case UnlikeKind::stump:
      return ground(crown, {random.uniform(0.2, 0.8), random.uniform(0.6, 1.3), degree * random.uniform(5, 10),
                            random.uniform(1.2, 2.2), random.uniform(0.2, 0.6)});
    case UnlikeKind::turned_stump:
      return turned_stump(random);
    case UnlikeKind::scan_body:
      return scan_body(random);
    case UnlikeKind::half:
      return beside_plane(crown, random.uniform(-0.15, 0.15), degree * random.uniform(-15, 15), random);
    case UnlikeKind::side_missing:
      return beside_plane(crown, random.uniform(0.15, 0.5), degree * random.uniform(-25, 25), random);
    case UnlikeKind::dome:
      return dome(random);
    case UnlikeKind::hollow:
      return ground(crown, {0, random.uniform(0.5, 1), degree * random.uniform(2, 8), random.uniform(1, 2),
                            random.uniform(0.15, 0.4)});
    case UnlikeKind::joined:
      return joined(crown, random);
  }
  return crown;
}

}  // namespace rhizodont
