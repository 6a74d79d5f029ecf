// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// S. W. Schneider, "A comparison of canal preparations in straight and curved root canals", 1971: the angle between the
// long axis of a canal's upper part and the chord from where the canal leaves that axis to its end. Here of the line
// through the middles of a root's sections, for generated teeth have no canals; the end is the middle of the root's
// last half millimetre.
#include "root_curves.hpp"

#include "base/parallel_tasks.hpp"
#include "mesh/geometry.hpp"
#include "teeth/fdi.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

struct Middle {
  double z = 0;
  Eigen::Vector2d place{0, 0};
};

/// Middles of a root's sections every half millimetre, from where it parts (or the junction) down to the tip.
std::vector<Middle> middles(const SyntheticTooth& tooth, int root) {
  constexpr double step = 0.5;
  std::map<int, std::pair<double, Eigen::Vector2d>> slabs;  // by depth: area and place weighted by it
  double top = -1e9, tip = 1e9;
  for (std::size_t v = 0; v < tooth.root.size(); ++v)
    if (tooth.root[v] == root)
      top = std::max(top, tooth.mesh.vertices[v].z()), tip = std::min(tip, tooth.mesh.vertices[v].z());
  for (std::size_t t = 0; t < tooth.mesh.triangles.size(); ++t) {
    Point middle = Point::Zero();
    bool is_root = true;
    for (const int v : tooth.mesh.triangles[t]) {
      is_root = is_root && tooth.root[static_cast<std::size_t>(v)] == root;
      middle += tooth.mesh.vertices[static_cast<std::size_t>(v)] / 3;
    }
    if (!is_root) continue;
    const double area = triangle_area_vector(tooth.mesh, t).norm();
    auto& [sum, place] =
        slabs.try_emplace(-static_cast<int>(std::floor((middle.z() - tip) / step)), 0.0, Eigen::Vector2d::Zero())
            .first->second;
    sum += area, place += area * middle.head<2>();
  }
  std::vector<Middle> line;
  for (const auto& [slab, sum] : slabs)
    if (sum.first > 0) line.push_back({tip + step * (0.5 - slab), sum.second / sum.first});
  while (line.size() > 1 && line.front().z > top - 1) line.erase(line.begin());  // the last of the parting
  if (!line.empty()) line.back().z = tip;
  return line;
}

/// Degrees: in space, as seen from the cheek's side, and from the neighbouring tooth's.
struct Angles {
  double in_space = 0, from_cheek = 0, from_side = 0;
};

std::optional<Angles> schneider(const std::vector<Middle>& line) {
  if (line.size() < 10) return std::nullopt;
  // The upper part's axis: a straight line through the upper third, by least squares.
  const std::size_t third = std::max<std::size_t>(4, line.size() / 3);
  double z = 0, zz = 0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero(), zp = p;
  for (std::size_t i = 0; i < third; ++i) {
    z += line[i].z / static_cast<double>(third);
    p += line[i].place / static_cast<double>(third);
  }
  for (std::size_t i = 0; i < third; ++i) zz += std::pow(line[i].z - z, 2), zp += (line[i].z - z) * (line[i].place - p);
  const Eigen::Vector2d slope = zp / zz;
  const auto aside = [&](const Middle& m) { return (m.place - p - slope * (m.z - z)).norm(); };
  // The curve begins below the last place within a tenth of the tip's distance from the axis.
  std::size_t begin = third / 2;
  for (std::size_t i = begin; i + 2 < line.size(); ++i)
    if (aside(line[i]) < 0.1 * aside(line.back())) begin = i;
  const Eigen::Vector2d chord =
      (line.back().place - line[begin].place) / (line.back().z - line[begin].z);  // along z, as the slope
  const auto between = [](double a, double b) {
    return std::abs(std::atan(a) - std::atan(b)) * 180 / std::numbers::pi;
  };
  const Eigen::Vector3d a = Eigen::Vector3d(slope.x(), slope.y(), 1).normalized(),
                        b = Eigen::Vector3d(chord.x(), chord.y(), 1).normalized();
  return Angles{std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / std::numbers::pi, between(slope.x(), chord.x()),
                between(slope.y(), chord.y())};
}

std::string root_name(const SyntheticTooth& tooth, std::size_t root) {
  if (tooth.apices.size() == 1) return "the root";
  const Point& apex = tooth.apices[root];
  Point middle = Point::Zero();
  for (const Point& p : tooth.apices) middle += p / static_cast<double>(tooth.apices.size());
  const bool is_premolar = tooth.type % 8 < 5;
  if (is_premolar || tooth.apices.size() == 3) {
    double least = 1e9;
    for (const Point& p : tooth.apices) least = std::min(least, p.y());
    if (apex.y() <= least) return is_premolar ? "tongue's" : "palatal";
    if (is_premolar) return "cheek's";
    // Of the two on the cheek's side.
    double x = 0;
    for (const Point& p : tooth.apices)
      if (p.y() > least) x += 0.5 * p.x();
    return apex.x() < x ? "mesiobuccal" : "distobuccal";
  }
  return apex.x() > middle.x() ? "mesial" : "distal";  // lower teeth: +x is mesial
}

using ByRoot = std::map<std::string, std::vector<Angles>>;

ByRoot angles_of(const ToothFamilies& families, int type, std::uint64_t count, const ToothVariation& variation) {
  ByRoot angles;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const SyntheticTooth tooth = generate_tooth(families, type, (std::uint64_t{1} << 34) + seed, variation);
    for (std::size_t r = 0; r < tooth.apices.size(); ++r)
      if (const auto found = schneider(middles(tooth, static_cast<int>(r))))
        angles[root_name(tooth, r)].push_back(*found);
  }
  return angles;
}

double mean(const std::vector<Angles>& all, double Angles::*view, double above = 0) {
  double sum = 0, count = 0;
  for (const Angles& angles : all)
    if (angles.*view >= above) sum += angles.*view, count += 1;
  return count > 0 ? sum / count : 0;
}

double share_above(const std::vector<Angles>& all, double Angles::*view, double above) {
  return static_cast<double>(std::count_if(all.begin(), all.end(), [&](const Angles& a) { return a.*view >= above; })) /
         static_cast<double>(all.size());
}

}  // namespace

void curve_table(const ToothFamilies& families, std::uint64_t count) {
  ToothVariation straight;
  straight.curvature = straight.dilaceration = 0;
  std::array<ByRoot, tooth_type_count> drawn, plain;
  parallel_tasks(tooth_type_count, [&](int type) {
    const auto t = static_cast<std::size_t>(type);
    drawn[t] = angles_of(families, type, count, {});
    plain[t] = angles_of(families, type, count, straight);
  });
  fmt::print(
      "Schneider's angles, degrees; from the cheek's side if nothing else is said:\n\n"
      "| tooth | root | roots | mean | over 5 % | these, mean | over 20 % | mean in space | mean without drawn curves "
      "| "
      "these over 20 % |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (int type = 0; type < tooth_type_count; ++type) {
    const auto t = static_cast<std::size_t>(type);
    for (const auto& [root, angles] : drawn[t]) {
      const std::vector<Angles>& without = plain[t][root];
      fmt::print("| {} | {} | {} | {:.1f} | {:.0f} | {:.1f} | {:.0f} | {:.1f} | {:.1f} | {:.0f} |\n",
                 fdi_of_type(type, false), root, angles.size(), mean(angles, &Angles::from_cheek),
                 100 * share_above(angles, &Angles::from_cheek, 5), mean(angles, &Angles::from_cheek, 5),
                 100 * share_above(angles, &Angles::from_cheek, 20), mean(angles, &Angles::in_space),
                 mean(without, &Angles::from_cheek),
                 without.empty() ? 0 : 100 * share_above(without, &Angles::from_cheek, 20));
    }
  }
  fmt::print("\n");
}

}  // namespace rhizodont
