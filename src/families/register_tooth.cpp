// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Rigid part: iterative closest points (P. Besl, N. McKay, 1992) with normals and scale, both ways, from many starts.
// Non-rigid part: B. Amberg, S. Romdhani, T. Vetter, "Optimal step nonrigid ICP algorithms for surface registration",
// 2007, with displacements whose second differences cost instead of affine maps: stretching a root is free, bending it
// costs little, and less with each step.
#include "families/register_tooth.hpp"

#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "completion/similarity.hpp"
#include "families/tooth_template.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/pieces.hpp"
#include "mesh/principal_axis.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

namespace rhizodont {
namespace {

/// The tooth as a closed outward surface in one piece, left side. Throws InputError with the reason why it is none.
TriangleMesh whole_tooth(TriangleMesh tooth, bool right_side) {
  constexpr double shortest_mm = 10, longest_mm = 45;
  if (tooth.triangles.empty()) throw InputError("The file has no surface.");
  if (!diagnose(tooth).is_valid()) throw InputError("The tooth's mesh is damaged: indices or coordinates are wrong.");
  tooth = drop_specks(tooth).mesh;
  const Pieces pieces = sort_pieces(tooth);
  if (pieces.kinds.size() > 1)
    throw InputError(
        fmt::format("These are {} pieces, not one tooth: {}", pieces.kinds.size(), describe_pieces(tooth, pieces)));
  const Diagnosis found = diagnose(tooth);
  if (!found.border_edges.empty())
    throw InputError(
        fmt::format("The tooth's surface is open at {} edges; only a whole, closed tooth can be "
                    "registered.",
                    found.border_edges.size()));
  if (!found.is_closed_manifold())
    throw InputError("The tooth's surface is no clean one: edges or vertices where more than two sheets meet.");
  if (found.genus.value_or(0) != 0)
    throw InputError(fmt::format("The tooth's surface has {} tunnels; fill them first.", *found.genus));
  const double length = bounding_box(tooth.vertices).diagonal().norm();
  if (!(length > shortest_mm && length < longest_mm))
    throw InputError(fmt::format("The tooth is {:.3g} mm long: no whole tooth is, is the unit right?", length));
  if (right_side)
    for (Point& p : tooth.vertices) p.x() = -p.x();
  if (volume(tooth) < 0)
    for (Triangle& t : tooth.triangles) std::swap(t[1], t[2]);
  return tooth;
}

/// Points of a surface with normals, for quick comparisons.
struct Samples {
  std::vector<Point> points;
  std::vector<Eigen::Vector3d> normals;
};

Samples samples_of(const TriangleMesh& mesh, std::size_t count) {
  SurfaceSamples many = sample_surface(mesh, count, 1);
  return {std::move(many.points), std::move(many.normals)};
}

/// Of a pair of points: their distance in mm, and how far their normals disagree, as mm.
double disagreement(const Point& a, const Eigen::Vector3d& na, const Point& b, const Eigen::Vector3d& nb) {
  constexpr double normal_mm = 1.5;  // what a difference of 1 between unit normals counts for
  return std::sqrt((a - b).squaredNorm() + normal_mm * normal_mm * (na - nb).squaredNorm());
}

struct RigidStart {
  Similarity map;  // template to tooth
  double residual = std::numeric_limits<double>::max();
};

/// A fixed surface to lay a template on.
class Target {
 public:
  explicit Target(const TriangleMesh& mesh, std::size_t count)
      : samples_(samples_of(mesh, count)), index_(samples_.points) {}
  const Samples& samples() const { return samples_; }

  /// Iterates closest points, both ways, and gives the mean disagreement of the nearer 90 % in the end.
  RigidStart lay(const Samples& source, Similarity map, int iterations) const {
    constexpr double counted = 0.9;
    RigidStart result;
    for (int i = 0; i <= iterations; ++i) {
      Samples moved = source;
      for (std::size_t k = 0; k < moved.points.size(); ++k) {
        moved.points[k] = map.scale * (map.rotation * source.points[k]) + map.shift;
        moved.normals[k] = map.rotation * source.normals[k];
      }
      const NearestVertexIndex back(moved.points);
      struct Pair {
        double cost;
        std::size_t from, to;
      };
      std::vector<Pair> pairs;
      for (std::size_t k = 0; k < moved.points.size(); ++k) add_best(pairs, index_, samples_, moved, k, false);
      for (std::size_t k = 0; k < samples_.points.size(); k += samples_.points.size() / source.points.size() + 1)
        add_best(pairs, back, moved, samples_, k, true);
      std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
      pairs.resize(static_cast<std::size_t>(counted * static_cast<double>(pairs.size())));
      result.map = map;
      result.residual = 0;
      for (const Pair& pair : pairs) result.residual += pair.cost / static_cast<double>(pairs.size());
      if (i == iterations) break;
      Eigen::Matrix3Xd from(3, static_cast<Eigen::Index>(pairs.size())), to(3, from.cols());
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        from.col(static_cast<Eigen::Index>(k)) = source.points[pairs[k].from];
        to.col(static_cast<Eigen::Index>(k)) = samples_.points[pairs[k].to];
      }
      map = similarity_of_pairs(from, to, {0.6, 1.6});
    }
    return result;
  }

 private:
  /// The best of the four nearest points by place and normal.
  template <class Pairs>
  static void add_best(Pairs& pairs, const NearestVertexIndex& index, const Samples& among, const Samples& of,
                       std::size_t k, bool reversed) {
    double least = std::numeric_limits<double>::max();
    std::size_t best = 0;
    for (const NearVertex& near : index.nearest(of.points[k], 4)) {
      const auto at = static_cast<std::size_t>(near.index);
      const double cost = disagreement(of.points[k], of.normals[k], among.points[at], among.normals[at]);
      if (cost < least) least = cost, best = at;
    }
    if (reversed)
      pairs.push_back({least, best, k});
    else
      pairs.push_back({least, k, best});
  }

  Samples samples_;
  NearestVertexIndex index_;
};

/// Lays a template on the tooth from all starts: the long axes on one another, either end up, turned.
RigidStart lay_template(const TriangleMesh& tooth, const Target& target, const TriangleMesh& source, std::size_t points,
                        int turns, int iterations, int refined) {
  const Samples samples = samples_of(source, points);
  const Eigen::Vector3d from = principal_axis(source.vertices), to = principal_axis(tooth.vertices);
  const Point middle_from = area_centroid(source), middle_to = area_centroid(tooth);
  const double scale = std::sqrt(surface_area(tooth) / surface_area(source));
  std::vector<RigidStart> starts(2 * static_cast<std::size_t>(turns));
  parallel_tasks(starts.size(), [&](std::size_t i) {
    const Eigen::Vector3d along = i % 2 == 0 ? to : Eigen::Vector3d(-to);
    const double angle = 2 * std::numbers::pi * static_cast<double>(i / 2) / turns;
    Similarity map;
    map.rotation = Eigen::AngleAxisd(angle, along).toRotationMatrix() *
                   Eigen::Quaterniond::FromTwoVectors(from, along).toRotationMatrix();
    map.scale = scale;
    map.shift = middle_to - scale * (map.rotation * middle_from);
    starts[i] = target.lay(samples, map, iterations);
  });
  std::stable_sort(starts.begin(), starts.end(),
                   [](const RigidStart& a, const RigidStart& b) { return a.residual < b.residual; });
  starts.resize(std::min(starts.size(), static_cast<std::size_t>(std::max(1, refined))));
  if (refined > 0) {
    constexpr int more_iterations = 40;
    parallel_tasks(starts.size(),
                   [&](std::size_t i) { starts[i] = target.lay(samples, starts[i].map, more_iterations); });
  }
  return *std::min_element(starts.begin(), starts.end(),
                           [](const RigidStart& a, const RigidStart& b) { return a.residual < b.residual; });
}

/// Incisor, canine, premolar or molar.
std::string_view kind_of(int type) {
  const int place = type % 8;
  return place < 2 ? "incisor" : place < 3 ? "canine" : place < 5 ? "premolar" : "molar";
}

void require_kind(const TriangleMesh& tooth, int fdi, const std::array<TemplateFile, tooth_type_count>& templates,
                  const RegisterToothOptions& options) {
  constexpr std::size_t points = 200;
  constexpr int iterations = 8;
  const Target target(tooth, 4 * points);
  std::array<double, tooth_type_count> residual{};
  for (int type = 0; type < tooth_type_count; ++type)
    residual[static_cast<std::size_t>(type)] =
        lay_template(tooth, target, templates[static_cast<std::size_t>(type)].mesh, points, options.start_turns,
                     iterations, 0)
            .residual;
  const int own = tooth_type_of_fdi(fdi);
  const auto best = static_cast<int>(std::min_element(residual.begin(), residual.end()) - residual.begin());
  if (kind_of(best) == kind_of(own)) return;
  if (residual[static_cast<std::size_t>(own)] <= options.largest_type_ratio * residual[static_cast<std::size_t>(best)])
    return;
  throw InputError(fmt::format("By its form this is a {} such as {}, not a {}: is the number {} right?", kind_of(best),
                               fdi_of_type(best, is_right_side(fdi)), kind_of(own), fdi));
}

/// Second differences of a function on a mesh's vertices, times their transpose: what bending costs.
Eigen::SparseMatrix<double> bending(const TriangleMesh& mesh) {
  const EdgeTable edges = edge_table(mesh);
  const auto count = static_cast<Eigen::Index>(mesh.vertices.size());
  Eigen::VectorXd degree = Eigen::VectorXd::Zero(count);
  for (const auto& edge : edges.vertices)
    for (const int v : edge) degree[v] += 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [a, b] : edges.vertices) {
    entries.emplace_back(a, b, -1 / degree[a]);
    entries.emplace_back(b, a, -1 / degree[b]);
  }
  for (Eigen::Index v = 0; v < count; ++v)
    if (degree[v] > 0) entries.emplace_back(v, v, 1);
  Eigen::SparseMatrix<double> laplacian(count, count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian.transpose() * laplacian;
}

/// 1 for a pair that is close, 0 beyond `reach`; where normals disagree the pair does not count.
double pair_weight(double distance, double reach, double cosine) {
  constexpr double least_cosine = 0.5;
  if (distance >= reach || cosine < least_cosine) return 0;
  const double t = 1 - distance * distance / (reach * reach);
  return t * t;
}

/// Bends `mesh` onto the surface. @param tooth  in the mesh's place
TriangleMesh bent_onto(const TriangleMesh& mesh, const TriangleMesh& tooth) {
  constexpr int rounds = 24;
  constexpr double stiffest = 3e4, softest = 0.1, widest_reach = 5, least_reach = 1.2;  // reach in mm
  const ClosestPointIndex surface(tooth);
  const Samples samples = samples_of(tooth, mesh.vertices.size());
  const Eigen::SparseMatrix<double> cost = bending(mesh);
  const auto count = static_cast<Eigen::Index>(mesh.vertices.size());
  TriangleMesh moved = mesh;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  for (int round = 0; round < rounds; ++round) {
    const double part = round / (rounds - 1.0);
    const double stiffness = stiffest * std::pow(softest / stiffest, part),
                 reach = widest_reach * std::pow(least_reach / widest_reach, part);
    const std::vector<Eigen::Vector3d> normals = vertex_normals(moved);
    std::vector<ClosestPoint> closest(moved.vertices.size());
    tbb::parallel_for(std::size_t{0}, closest.size(),
                      [&](std::size_t v) { closest[v] = surface.closest(moved.vertices[v]); });
    Eigen::VectorXd weight = Eigen::VectorXd::Constant(count, 1e-6);
    Eigen::MatrixX3d pull = Eigen::MatrixX3d::Zero(count, 3);
    const auto add = [&](std::size_t v, const Point& goal, double w) {
      weight[static_cast<Eigen::Index>(v)] += w;
      pull.row(static_cast<Eigen::Index>(v)) += w * (goal - mesh.vertices[v]).transpose();
    };
    for (std::size_t v = 0; v < closest.size(); ++v)
      add(v, closest[v].point,
          pair_weight(closest[v].distance, reach,
                      normals[v].dot(triangle_normal(tooth, static_cast<std::size_t>(closest[v].triangle)))));
    // From the tooth to the template as well: else nothing draws an apex to a deeper one.
    const NearestVertexIndex back(moved.vertices);
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      const NearVertex near = back.nearest(samples.points[i]);
      const auto v = static_cast<std::size_t>(near.index);
      add(v, samples.points[i],
          pair_weight(std::sqrt(near.squared_distance), reach, normals[v].dot(samples.normals[i])));
    }
    Eigen::SparseMatrix<double> system = stiffness * cost;
    for (Eigen::Index v = 0; v < count; ++v) system.coeffRef(v, v) += weight[v];
    if (round == 0) solver.analyzePattern(system);
    solver.factorize(system);
    const Eigen::MatrixX3d displacement = solver.solve(pull);
    if (solver.info() != Eigen::Success || !displacement.allFinite())
      throw InputError("The template cannot be bent onto this tooth.");
    for (std::size_t v = 0; v < moved.vertices.size(); ++v)
      moved.vertices[v] = mesh.vertices[v] + displacement.row(static_cast<Eigen::Index>(v)).transpose();
  }
  return moved;
}

/// Carries what the simplified template's vertices moved by over to the whole one, then lets that sink onto the tooth.
std::vector<Point> carried(const TriangleMesh& full, const TriangleMesh& coarse, const TriangleMesh& bent,
                           const TriangleMesh& tooth) {
  constexpr std::size_t neighbours = 6;
  constexpr int rounds = 3, smoothings = 4;
  constexpr double reach = 0.6;
  const NearestVertexIndex index(coarse.vertices);
  TriangleMesh moved = full;
  tbb::parallel_for(std::size_t{0}, full.vertices.size(), [&](std::size_t v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double total = 0;
    for (const NearVertex& near : index.nearest(full.vertices[v], neighbours)) {
      const auto at = static_cast<std::size_t>(near.index);
      const double w = 1 / (near.squared_distance + 1e-4);
      sum += w * (bent.vertices[at] - coarse.vertices[at]), total += w;
    }
    moved.vertices[v] += sum / total;
  });
  const ClosestPointIndex surface(tooth);
  const EdgeTable edges = edge_table(full);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Eigen::Vector3d> normals = vertex_normals(moved);
    std::vector<Eigen::Vector3d> step(moved.vertices.size());
    tbb::parallel_for(std::size_t{0}, step.size(), [&](std::size_t v) {
      const ClosestPoint near = surface.closest(moved.vertices[v]);
      const Eigen::Vector3d normal = triangle_normal(tooth, static_cast<std::size_t>(near.triangle));
      step[v] = pair_weight(near.distance, reach, normals[v].dot(normal)) * (near.point - moved.vertices[v]);
    });
    for (int i = 0; i < smoothings; ++i) {
      std::vector<Eigen::Vector3d> sum = step;
      std::vector<double> count(step.size(), 1);
      for (const auto& edge : edges.vertices) {
        const auto a = static_cast<std::size_t>(edge[0]), b = static_cast<std::size_t>(edge[1]);
        sum[a] += step[b], sum[b] += step[a], count[a] += 1, count[b] += 1;
      }
      for (std::size_t v = 0; v < step.size(); ++v) step[v] = sum[v] / count[v];
    }
    for (std::size_t v = 0; v < step.size(); ++v) moved.vertices[v] += step[v];
  }
  return moved.vertices;
}

/// Mean and 95th percentile of the distances between two surfaces, both ways.
std::pair<double, double> distances_between(const TriangleMesh& a, const TriangleMesh& b) {
  constexpr std::size_t samples = 4000;
  const ClosestPointIndex on_a(a), on_b(b);
  std::vector<double> all;
  for (const Point& p : sample_surface(a, samples, 2).points) all.push_back(on_b.closest(p).distance);
  for (const Point& p : sample_surface(b, samples, 2).points) all.push_back(on_a.closest(p).distance);
  std::sort(all.begin(), all.end());
  double sum = 0;
  for (const double d : all) sum += d;
  return {sum / static_cast<double>(all.size()), all[all.size() * 95 / 100]};
}

}  // namespace

TemplateFile load_template_file(const std::filesystem::path& folder, int type) {
  constexpr double usual_crown_share = 0.38;
  const MeshFile file =
      load_mesh(folder / "templates" / ("tooth_" + std::to_string(fdi_of_type(type, false)) + ".ply"));
  const auto attribute = file.vertex_attributes.find("crown");
  return {file.mesh,
          crown_labels(file.mesh,
                       attribute == file.vertex_attributes.end() ? std::vector<double>{} : attribute->second.values,
                       usual_crown_share)};
}

std::array<TemplateFile, tooth_type_count> load_template_files(const std::filesystem::path& folder) {
  std::array<TemplateFile, tooth_type_count> files;
  parallel_tasks(tooth_type_count,
                 [&](int type) { files[static_cast<std::size_t>(type)] = load_template_file(folder, type); });
  return files;
}

RegisteredTooth register_tooth(const TriangleMesh& given, int fdi,
                               const std::array<TemplateFile, tooth_type_count>& templates,
                               const RegisterToothOptions& options) {
  require_ranges("the registration", {{"start_turns", options.start_turns, OptionRange::at_least(4)},
                                      {"vertices", options.vertices, OptionRange::at_least(500)},
                                      {"largest_mean_mm", options.largest_mean_mm, OptionRange::above(0)},
                                      {"largest_95_mm", options.largest_95_mm, OptionRange::above(0)},
                                      {"largest_rigid_mm", options.largest_rigid_mm, OptionRange::above(0)},
                                      {"largest_type_ratio", options.largest_type_ratio, OptionRange::at_least(1)}});
  constexpr std::size_t points = 500;
  constexpr int iterations = 15, refined = 4;
  const TemplateFile& own = templates[static_cast<std::size_t>(tooth_type_of_fdi(fdi))];
  TriangleMesh tooth = whole_tooth(given, is_right_side(fdi));
  require_kind(tooth, fdi, templates, options);
  const Similarity map =
      lay_template(tooth, Target(tooth, 4 * points), own.mesh, points, options.start_turns, iterations, refined).map;
  // Into the template's place, as large as the template.
  for (Point& p : tooth.vertices) p = map.rotation.transpose() * (p - map.shift) / map.scale;
  RegisteredTooth result;
  result.size_ratio = map.scale;
  const TriangleMesh coarse = simplified(own.mesh, options.vertices);
  result.rigid_mean_mm = map.scale * distances_between(coarse, tooth).first;
  if (result.rigid_mean_mm > options.largest_rigid_mm)
    throw InputError(
        fmt::format("This does not look like a {}: they are {:.2f} mm apart on average where they lie best.",
                    fdi_of_type(tooth_type_of_fdi(fdi), false), result.rigid_mean_mm));
  const TriangleMesh bent = bent_onto(coarse, tooth);
  TriangleMesh registered = own.mesh;
  registered.vertices = carried(own.mesh, coarse, bent, tooth);
  const auto [mean, percentile_95] = distances_between(registered, tooth);
  result.mean_mm = map.scale * mean;
  result.percentile_95_mm = map.scale * percentile_95;
  if (result.mean_mm > options.largest_mean_mm || result.percentile_95_mm > options.largest_95_mm)
    throw InputError(fmt::format(
        "The template of {} cannot be bent onto this tooth: they stay {:.2f} mm apart on average, {:.2f} mm in places. "
        "Is it one whole tooth of that number?",
        fdi_of_type(tooth_type_of_fdi(fdi), false), result.mean_mm, result.percentile_95_mm));
  const Point centre = area_centroid(own.mesh);
  for (Point& p : registered.vertices) p = centre + map.scale * (p - centre);
  result.vertices = std::move(registered.vertices);
  return result;
}

}  // namespace rhizodont
