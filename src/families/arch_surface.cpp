// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/arch_scan.hpp"
#include "families/wave_noise.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/smooth_functions.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace rhizodont {
namespace {

float soft_min(float a, float b, float width) {
  const float h = std::max(width - std::abs(a - b), 0.0F) / width;
  return std::min(a, b) - 0.25F * h * h * width;
}

}  // namespace

void add_model_base(const ArchCrowns& arch, RandomStream& random, ArchFields& fields) {
  const Lattice& lattice = fields.lattice;
  const double bottom = lattice.origin.y() + random.uniform(0.8, 3.0);
  double necks = 0, back = 1e9;
  for (const ArchCrown& crown : arch.crowns) {
    necks += crown.to_work.translation().y() / static_cast<double>(arch.crowns.size());
    back = std::min(back, crown.to_work.translation().z());
  }
  back -= random.uniform(3, 7);
  const double shoulder = std::max(bottom + 1, necks - random.uniform(6, 11));
  const double cheek = random.uniform(6, 9), tongue = random.uniform(6, 10);
  const bool horseshoe = arch.jaw == Jaw::lower && random.chance(0.7);
  for (int z = 0; z < lattice.count[2]; ++z)
    for (int x = 0; x < lattice.count[0]; ++x) {
      const Point foot = lattice.at(x, 0, z);
      const double off = fields.plan.sample(fields.plan.off, foot.x(), foot.z());
      const double sides = horseshoe ? std::max(off - cheek, -tongue - off) : off - cheek;
      for (int y = 0; y < lattice.count[1]; ++y) {
        const double height = lattice.at(x, y, z).y();
        const std::size_t i = lattice.index(x, y, z);
        const auto base = static_cast<float>(std::max(sides, height - shoulder));
        const auto ends = static_cast<float>(std::max(bottom - height, back - foot.z()));
        const float all = std::max(std::min(fields.gum[i], base), ends);
        fields.gum[i] = std::clamp(all, -field_reach, field_reach);
        fields.tooth[i] = std::max(fields.tooth[i], std::min(ends, field_reach));
      }
    }
}

ScanSurface surface_of(const ArchCrowns& arch, const ArchFields& fields, double soft) {
  std::vector<float> values(fields.lattice.size());
  const auto width = static_cast<float>(soft);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = soft_min(soft_min(fields.tooth[i], fields.second[i], 2 * width), fields.gum[i], width);
  ZeroSurface surface = zero_surface(fields.lattice, values);
  ScanSurface scan;
  for (const ZeroSurface::Between& at : surface.between) {
    const auto mixed = [&](const std::vector<float>& field) {
      return field[at.from] + at.share * (field[at.to] - field[at.from]);
    };
    const std::size_t nearer = fields.tooth[at.from] < fields.tooth[at.to] ? at.from : at.to;
    const std::uint8_t owner = fields.owner[nearer];
    scan.fdi.push_back(owner != 255 && mixed(fields.tooth) < mixed(fields.gum) ? arch.crowns[owner].fdi : 0);
  }
  scan.mesh = std::move(surface.mesh);
  if (scan.mesh.triangles.empty()) throw NoResultError("A generated arch has no surface.");
  return scan;
}

void form_gum(const ArchCrowns& arch, const ArchFields& fields, RandomStream& random, ScanSurface& scan) {
  std::vector<Point> enamel;
  for (std::size_t v = 0; v < scan.fdi.size(); ++v)
    if (scan.fdi[v] != 0) enamel.push_back(scan.mesh.vertices[v]);
  if (enamel.empty()) return;
  const NearestVertexIndex index(enamel);
  const std::vector<Eigen::Vector3d> normals = vertex_normals(scan.mesh);
  const WaveNoise bumps(random, 5, 16), small(random, 1.5, 4), bend(random, 8, 25);
  const double bump_mm = random.uniform(0.05, 0.25), small_mm = random.uniform(0.01, 0.07);
  const double fold_mm = arch.jaw == Jaw::upper ? random.uniform(0.05, 0.6) : 0, fold_length = random.uniform(3.0, 5.5);
  double front = -1e9, back = 1e9;
  for (const ArchCrown& crown : arch.crowns) {
    front = std::max(front, crown.to_work.translation().z());
    back = std::min(back, crown.to_work.translation().z());
  }
  const double middle = fields.lattice.origin.x() + 0.5 * fields.lattice.cell * fields.lattice.count[0];
  for (std::size_t v = 0; v < scan.fdi.size(); ++v) {
    if (scan.fdi[v] != 0) continue;
    Point& p = scan.mesh.vertices[v];
    const double away = std::sqrt(index.nearest(p).squared_distance);
    const double fade = smooth_step((away - 0.4) / 3.0);
    double lift = fade * (bump_mm * bumps(p) + small_mm * small(p));
    const double off = fields.plan.sample(fields.plan.off, p.x(), p.z());
    if (fold_mm > 0 && off < -4) {
      // Folds behind the incisors, running to the sides, and a seam in the middle.
      const double behind = (front - p.z()) / (front - back), aside = std::abs(p.x() - middle);
      const double where =
          smooth_step((behind - 0.1) / 0.12) * (1 - smooth_step((behind - 0.32) / 0.12)) * smooth_step((-off - 4) / 3);
      const double phase = 2 * std::numbers::pi / fold_length * (p.z() - 0.25 * aside + 1.4 * bend(p));
      lift += where * fold_mm * std::max(0.0, std::sin(phase)) * smooth_step((aside - 0.8) / 1.5) *
              smooth_step(0.5 + 0.6 * bumps(p));
      lift += 0.5 * fold_mm * std::exp(-0.5 * aside * aside) * smooth_step((-off - 5) / 4);
    }
    p += lift * normals[v];
  }
}

void roughen(double amount, RandomStream& random, ScanSurface& scan) {
  const double white = amount * 0.03 * random.uniform() * random.uniform(), wave = amount * random.uniform(0.0, 0.05);
  const WaveNoise waves(random, 0.9, 2.5);
  const std::vector<Eigen::Vector3d> normals = vertex_normals(scan.mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    Point& p = scan.mesh.vertices[v];
    p += (white * random.normal(0.0, 1.0) + wave * waves(p)) * normals[v];
  }
}

}  // namespace rhizodont
