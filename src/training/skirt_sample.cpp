// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Crowns with skirts, labelled: "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", 3.2.
#include "training/skirt_sample.hpp"

#include "base/float_bits.hpp"
#include "base/option_range.hpp"
#include "families/crown_crop.hpp"
#include "families/gum_flange.hpp"
#include "families/remeshing.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "skirt/skirt_features.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace rhizodont {
namespace {

void require_in_range(const SkirtSampleOptions& options) {
  require_ranges(
      "a training sample",
      {{"type", options.type, OptionRange::at_least(-1).below(tooth_type_count)},
       {"finest_edge_mm", options.finest_edge_mm, OptionRange::at_least(0.1).at_most(1)},
       {"coarsest_edge_mm", options.coarsest_edge_mm, OptionRange::at_least(options.finest_edge_mm).at_most(1)},
       {"clean_share", options.clean_share, share_range},
       {"hole_share", options.hole_share, share_range},
       {"largest_noise", options.largest_noise, OptionRange::at_least(0).at_most(0.3)}});
}

/// Between 0 and 1, smooth at the scale of a wavelength.
class SpatialNoise {
 public:
  SpatialNoise(RandomStream& random, double wavelength) {
    for (Wave& wave : waves_) {
      Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
      wave.frequency = direction.normalized() * (2 * std::numbers::pi / wavelength) * random.uniform(0.7, 1.4);
      wave.phase = random.uniform(0, 2 * std::numbers::pi);
    }
  }
  double operator()(const Point& p) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += std::sin(wave.frequency.dot(p) + wave.phase);
    return std::clamp(0.5 + sum / (2 * std::sqrt(static_cast<double>(waves_.size()))), 0.0, 1.0);
  }

 private:
  struct Wave {
    Eigen::Vector3d frequency;
    double phase;
  };
  std::array<Wave, 6> waves_;
};

/// The surface with what is known of each vertex.
struct Scan {
  TriangleMesh mesh;
  std::vector<double> outwards;  ///< 0 on the crown, towards 1 at a flange's outer edge
  std::vector<std::uint8_t> is_tooth;
};

Scan scan_of(const Flange& flange, bool flange_is_tooth, double edge, double noise, RandomStream& random) {
  Scan scan;
  scan.mesh = remeshed(flange.mesh, edge);
  const ClosestPointIndex surface(flange.mesh);
  for (const Point& p : scan.mesh.vertices) {
    const ClosestPoint near = surface.closest(p);
    const Triangle& t = flange.mesh.triangles[static_cast<std::size_t>(near.triangle)];
    const auto at = [&](std::size_t i) -> const Point& { return flange.mesh.vertices[static_cast<std::size_t>(t[i])]; };
    Eigen::Vector3d share;  // barycentric
    for (std::size_t i = 0; i < 3; ++i)
      share[static_cast<Eigen::Index>(i)] = (at((i + 1) % 3) - near.point).cross(at((i + 2) % 3) - near.point).norm();
    share /= std::max(share.sum(), 1e-300);
    double outwards = 0;
    for (std::size_t i = 0; i < 3; ++i)
      outwards += share[static_cast<Eigen::Index>(i)] * flange.outwards[static_cast<std::size_t>(t[i])];
    const bool on_crown = static_cast<std::size_t>(near.triangle) < flange.crown_triangles || outwards < 1e-6;
    scan.outwards.push_back(on_crown ? 0 : outwards);
    scan.is_tooth.push_back(on_crown || flange_is_tooth ? 1 : 0);
  }
  const auto normals = vertex_normals(scan.mesh);
  for (std::size_t v = 0; v < normals.size(); ++v) scan.mesh.vertices[v] += random.normal(0.0, noise) * normals[v];
  return scan;
}

Point middle_of(const TriangleMesh& mesh, const Triangle& t) {
  Point sum = Point::Zero();
  for (const int v : t) sum += mesh.vertices[static_cast<std::size_t>(v)] / 3;
  return sum;
}

/// How a segmentation cuts: triangle by triangle, with teeth, holes and bridges towards the outer edge.
void cut_raggedly(Scan& scan, RandomStream& random) {
  const SpatialNoise coarse(random, random.uniform(1.2, 3.0)), fine(random, random.uniform(0.5, 1.2));
  const double depth = random.uniform(0.0, 0.4), teeth = random.uniform(0.0, 0.25);
  const double holes = random.chance(0.5) ? random.uniform(0.0, 0.12) : 0;
  std::erase_if(scan.mesh.triangles, [&](const Triangle& t) {
    double outwards = 0;
    for (const int v : t) outwards += scan.outwards[static_cast<std::size_t>(v)] / 3;
    const Point p = middle_of(scan.mesh, t);
    const double lost = depth * coarse(p) + teeth * fine(p) + 0.06 * random.uniform();
    const bool hole = random.chance(holes);
    return outwards > 0 && (outwards > 1 - lost || (outwards > 0.4 && hole));
  });
}

/// Takes some of the triangles at the border away.
void fray_border(TriangleMesh& mesh, double share, RandomStream& random) {
  std::vector<bool> at_border(mesh.triangles.size(), false);
  const EdgeTable edges = edge_table(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.triangle_count(e) == 1)
      at_border[static_cast<std::size_t>(edges.half_edges[static_cast<std::size_t>(edges.first[e])] / 3)] = true;
  std::size_t t = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return at_border[t++] && random.chance(share); });
}

std::vector<int> border_vertices(const TriangleMesh& mesh) {
  std::vector<bool> at_border(mesh.vertices.size(), false);
  const EdgeTable edges = edge_table(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.triangle_count(e) == 1)
      for (const int v : edges.vertices[e]) at_border[static_cast<std::size_t>(v)] = true;
  std::vector<int> vertices;
  for (int v = 0; v < static_cast<int>(at_border.size()); ++v)
    if (at_border[static_cast<std::size_t>(v)]) vertices.push_back(v);
  return vertices;
}

/// Spikes and small webs: the scan's surface leaves the tooth towards a neighbour or the gum that it saw together with
/// it. Mostly at the sides where the neighbours are.
void pull_border(Scan& scan, std::uint64_t count, double edge, RandomStream& random) {
  const std::vector<int> border = border_vertices(scan.mesh);
  Point middle = Point::Zero();
  for (const int v : border)
    middle += scan.mesh.vertices[static_cast<std::size_t>(v)] / static_cast<double>(border.size());
  const TriangleMesh before = scan.mesh;
  for (std::uint64_t i = 0; i < count; ++i) {
    Eigen::Vector3d at;
    do {
      at = before.vertices[static_cast<std::size_t>(border[random.index(border.size())])] - middle;
    } while (std::abs(at.x()) < std::abs(at.y()) && random.chance(0.6));
    const double reach = std::max(random.uniform(0.5, 1.9), 1.3 * edge), length = random.uniform(0.4, 2.4);
    const double slope = random.uniform(-0.5, 0.9), power = random.uniform(1.2, 2.5);
    const Eigen::Vector2d radial = at.head<2>().normalized();
    const Eigen::Vector3d away(radial.x() * std::cos(slope), radial.y() * std::cos(slope), -std::sin(slope));
    for (std::size_t v = 0; v < before.vertices.size(); ++v) {
      const double near = 1 - (before.vertices[v] - middle - at).norm() / reach;
      if (near <= 0) continue;
      const double moved = length * std::pow(near, power);
      scan.mesh.vertices[v] += moved * away;
      if (moved > 0.15) {
        scan.is_tooth[v] = 0;
        scan.outwards[v] = std::max(scan.outwards[v], 1e-3);
      }
    }
  }
}

/// Missing patches, mostly where neighbours hide the surface.
void make_holes(TriangleMesh& mesh, RandomStream& random) {
  for (std::uint64_t i = 0, count = 1 + random.index(2); i < count; ++i) {
    const Point middle = mesh.vertices[static_cast<std::size_t>(random.index(mesh.vertices.size()))];
    const double radius = random.uniform(0.3, 1.0);
    const SpatialNoise noise(random, 1.0);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      const Point p = middle_of(mesh, t);
      return (p - middle).norm() < radius * (0.5 + noise(p));
    });
  }
}

/// Only the largest piece, its vertices, half of the time mirrored.
SkirtSample finished(const Scan& scan, RandomStream& random) {
  const ConnectedComponents pieces = connected_components(scan.mesh);
  std::vector<int> size(static_cast<std::size_t>(pieces.count), 0);
  for (const int c : pieces.of_triangle) ++size[static_cast<std::size_t>(c)];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<bool> mask;
  for (const int c : pieces.of_triangle) mask.push_back(c == largest);
  Submesh part = submesh(scan.mesh, mask);
  SkirtSample sample;
  sample.mesh = std::move(part.mesh);
  for (const int v : part.old_vertices) sample.is_tooth.push_back(scan.is_tooth[static_cast<std::size_t>(v)]);
  const bool mirror = sample.mirrored = random.chance(0.5);
  for (Point& p : sample.mesh.vertices) {
    if (mirror) p.x() = -p.x();
    p = nearest_float(p);
  }
  if (mirror) sample.mesh = flipped(sample.mesh);
  return sample;
}

std::optional<SkirtSample> draw(const ToothFamilies& families, const SkirtSampleOptions& options,
                                RandomStream& random) {
  const int type = options.type >= 0 ? options.type : static_cast<int>(random.index(tooth_type_count));
  const SyntheticTooth tooth = generate_tooth(families, type, random.bits());
  const CroppedCrown crop = draw_cropped_crown(tooth, 0.05, 0.3, random);
  const double edge =
      options.finest_edge_mm * std::pow(options.coarsest_edge_mm / options.finest_edge_mm, random.uniform());
  const double noise = edge * options.largest_noise * random.uniform();
  const bool clean = random.chance(options.clean_share);
  const double kind = random.uniform();
  Flange flange{crop.mesh, crop.mesh.triangles.size(), std::vector<double>(crop.mesh.vertices.size(), 0)};
  if (clean && kind < 0.45) flange = add_flange(crop.mesh, FlangeKind::lip, random);
  if (!clean && kind < 0.7)
    flange = add_flange(crop.mesh,
                        kind < 0.35   ? FlangeKind::band
                        : kind < 0.55 ? FlangeKind::webs
                                      : FlangeKind::parts,
                        random);
  const bool spikes_alone = !clean && kind >= 0.7;
  if (spikes_alone && random.chance(0.4)) flange = add_flange(crop.mesh, FlangeKind::lip, random);
  if (!diagnose(flange.mesh).is_oriented_manifold()) return std::nullopt;
  Scan scan = scan_of(flange, clean || spikes_alone, edge, noise, random);
  if (!clean && !spikes_alone) cut_raggedly(scan, random);
  if (spikes_alone || (!clean && random.chance(0.3))) pull_border(scan, 1 + random.index(4), edge, random);
  if (random.chance(0.7)) fray_border(scan.mesh, random.uniform(0.0, 0.4), random);
  if (random.chance(options.hole_share)) make_holes(scan.mesh, random);
  SkirtSample sample = finished(scan, random);
  if (sample.mesh.vertices.size() < 150) return std::nullopt;
  sample.type = type;
  sample.has_skirt = !clean;
  return sample;
}

}  // namespace

SkirtSample make_skirt_sample(const ToothFamilies& families, std::uint64_t seed, const SkirtSampleOptions& options) {
  require_in_range(options);
  RandomStream random(seed, 400);
  for (int attempt = 0; attempt < 20; ++attempt) {
    try {
      if (auto sample = draw(families, options, random)) return std::move(*sample);
    } catch (const NoResultError&) {
      // No gum line left a crown: another tooth.
    }
  }
  throw NoResultError("No crown with a skirt came out of 20 draws.");
}

SurfaceSample make_skirt_training_sample(const ToothFamilies& families, std::uint64_t seed,
                                         const SkirtSampleOptions& options, int eigenvectors) {
  SkirtSample crown = make_skirt_sample(families, seed, options);
  SurfaceSample sample = skirt_features(crown.mesh, eigenvectors);
  sample.labels = std::move(crown.is_tooth);
  return sample;
}

std::vector<std::uint8_t> label_by_restored(const TriangleMesh& crown, const TriangleMesh& restored,
                                            double tolerance_mm) {
  if (!(tolerance_mm > 0)) throw UsageError("The tolerance of labels must be positive.");
  const ClosestPointIndex surface(restored);
  std::vector<std::uint8_t> labels;
  for (const Point& p : crown.vertices) labels.push_back(surface.closest(p).distance <= tolerance_mm ? 1 : 0);
  return labels;
}

MeshFile skirt_sample_file(const SkirtSample& sample) {
  MeshFile file;
  file.mesh = sample.mesh;
  file.vertex_attributes["tooth"] = {AttributeType::uint8, {sample.is_tooth.begin(), sample.is_tooth.end()}};
  file.comments = {"tooth: 1 on the tooth's surface, 0 skirt; made by rhizodont synth"};
  return file;
}

MeshFile labelled_crown_file(MeshFile crown, const std::vector<std::uint8_t>& is_tooth) {
  crown.vertex_attributes["tooth"] = {AttributeType::uint8, {is_tooth.begin(), is_tooth.end()}};
  crown.triangle_attributes.clear();  // what else the scan's triangles carry is no label of the crown
  crown.comments = {"tooth: 1 on the restored tooth's surface, 0 skirt"};
  return crown;
}

}  // namespace rhizodont
