// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "stages/stages.hpp"

#include "completion/complete_points.hpp"
#include "fusion/fuse.hpp"
#include "guiding/crown_fit.hpp"
#include "guiding/fitted_surface.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/take_crown.hpp"
#include "isosurface/isosurface.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/models.hpp"
#include "poisson/indicator.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/io.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

namespace rhizodont {
namespace {

/// Points of a closed peg below the crown's border, as a network's points are: over crown and root, normals outward.
OrientedPoints peg_below(const PreparedCrown& crown) {
  constexpr double length = 12;  // mm
  constexpr int rings = 24;
  OrientedPoints peg;
  peg.points = crown.mesh.vertices;
  peg.normals = vertex_normals(crown.mesh);
  Point middle = Point::Zero();
  for (const auto& [v, next] : crown.border.half_edges) middle += crown.mesh.vertices[static_cast<std::size_t>(v)];
  middle /= static_cast<double>(crown.border.half_edges.size());
  for (int ring = 1; ring <= rings; ++ring) {
    // Radius and depth as on an ellipse: upright at the border, round at the apex.
    const double angle = 0.5 * std::numbers::pi * ring / rings;
    const double radius = std::cos(angle), depth = std::sin(angle);
    for (const auto& [v, next] : crown.border.half_edges) {
      const Eigen::Vector3d out = crown.mesh.vertices[static_cast<std::size_t>(v)] - middle;
      const Eigen::Vector3d sideways = out - out.dot(crown.growth_axis) * crown.growth_axis;
      peg.points.emplace_back(middle + radius * out - depth * length * crown.growth_axis);
      peg.normals.push_back(
          (radius * length * sideways.normalized() - depth * sideways.norm() * crown.growth_axis).normalized());
      if (ring == rings) break;  // the apex, once
    }
  }
  return peg;
}

/// What the stages take and give, each made once.
struct StageInputs {
  std::filesystem::path file;
  int fdi = 0;
  std::shared_ptr<const CompletionModels> models;
  CompleteOptions options;
  TriangleMesh input;
  PreparedCrown crown;
  CrownFrame frame;
  OrientedPoints predicted;
  GuidingCloud cloud;
  std::unique_ptr<IndicatorFunction> indicator;
  TriangleMesh isosurface, surface;  // not drawn onto the crown, and drawn onto it
  FuseOptions fuse;
  std::unique_ptr<SurfaceWalk> walk;  // of `surface`
  std::unique_ptr<EdgeLengths> lengths;
  std::vector<bool> is_root;
  std::vector<Point> sites;
  Joining joining;
  JoinedTooth restored, remeshed;
  TriangleMesh tooth;

  StageInputs(std::filesystem::path crown_file, int number, double e, std::shared_ptr<const CompletionModels> shared)
      : file(std::move(crown_file)),
        fdi(number),
        models(std::move(shared)),
        options(options_of(number, e)),
        input(load_mesh(file).mesh),
        crown(prepare_crown(taken().kept.mesh)) {}

  static CompleteOptions options_of(int fdi, double e) {
    CompleteOptions options;
    options.fdi = fdi;
    options.e = e;
    return options;
  }

  const CompletionModels::Content& content() const { return *content_of(*models); }
  CrownFrame laid() const { return lay_crown(crown, fdi, {}, content()); }
  TakenCrown taken() const { return take_crown(input, content().atlas, content().skirt, options); }
  OrientedPoints network_points() const { return complete_points(crown.mesh, fdi, frame, content().network).cloud; }
  TriangleMesh tiled() const {
    IsosurfaceOptions tiling;
    tiling.e = options.e;
    tiling.as_ball = true;
    const std::span<const Point> seeds(cloud.samples.points.data(), static_cast<std::size_t>(cloud.crown_samples));
    const ScalarField field = [this](const Point& p) { return indicator->evaluate(p); };
    return grad_normal(field, indicator->iso_value(), seeds, tiling).mesh;
  }
  TriangleMesh drawn_onto_crown() const {
    CrownFitOptions fit;
    fit.tolerance = 0.015 * options.e;
    TriangleMesh drawn = isosurface;
    fit_to_crown(drawn, crown, fit);
    return drawn;
  }
  std::vector<bool> separated() const {
    return separate_crown_and_root(surface, crown_distances(surface, crown), crown.growth_axis, fuse.separation);
  }
  std::vector<Point> laid_sites() const {
    return root_sites(*walk, is_root, crown.mesh, crown.border, *lengths, fuse.sites);
  }
  JoinedTooth remeshed_root() const {
    JoinedTooth joined = restored;
    remesh_root(joined, *walk, *lengths, {}, 0, fuse.remesh);
    return joined;
  }
  void smooth() const {
    JoinedTooth joined = remeshed;
    smooth_transition(joined, fuse.transition);
  }
};

std::shared_ptr<const StageInputs> made(const std::filesystem::path& file, int fdi, double e, RootOfBench root,
                                        const std::shared_ptr<const CompletionModels>& models) {
  auto t = std::make_shared<StageInputs>(file, fdi, e, models);
  t->frame = t->laid();
  t->predicted = root == RootOfBench::peg ? peg_below(t->crown) : t->network_points();
  t->cloud = assemble_guiding_cloud(t->crown, t->predicted);
  t->indicator = std::make_unique<IndicatorFunction>(solve_indicator(t->cloud.samples, t->cloud.confidence));
  t->isosurface = t->tiled();
  t->surface = t->drawn_onto_crown();
  t->walk = std::make_unique<SurfaceWalk>(t->surface);
  t->lengths = std::make_unique<EdgeLengths>(t->crown.mesh, t->crown.border, mean_edge_length(t->surface),
                                             t->fuse.edge_growth, t->fuse.edge_shrinkage);
  t->is_root = t->separated();
  t->sites = t->laid_sites();
  t->joining = join_crown_and_root(t->crown.mesh, t->sites, t->surface, t->fuse.join);
  t->restored = restore_crown(t->crown.mesh, t->joining, t->fuse.restore);
  t->remeshed = t->remeshed_root();
  t->tooth = fuse_crown_and_root(t->crown, t->surface, t->crown.growth_axis, t->fuse).tooth.mesh;
  return t;
}

}  // namespace

std::vector<BenchStage> stages_of(const std::filesystem::path& crown, int fdi, double e, RootOfBench root,
                                  const std::shared_ptr<const CompletionModels>& models) {
  const std::shared_ptr<const StageInputs> t = made(crown, fdi, e, root, models);
  std::vector<BenchStage> stages{
      {"reading", [t] { load_mesh(t->file); }},
      {"intake", [t] { prepare_crown(t->taken().kept.mesh); }},
      {"pose", [t] { t->laid(); }},
      {"completion_network", [t] { t->network_points(); }},
      {"orientation", [t] { assemble_guiding_cloud(t->crown, t->predicted); }},
      {"indicator_function", [t] { solve_indicator(t->cloud.samples, t->cloud.confidence); }},
      {"isosurface", [t] { t->tiled(); }},
      {"crown_fit", [t] { t->drawn_onto_crown(); }},
      {"separation", [t] { t->separated(); }},
      {"root_sites", [t] { t->laid_sites(); }},
      {"diagram_and_dual", [t] { join_crown_and_root(t->crown.mesh, t->sites, t->surface, t->fuse.join); }},
      {"restoring", [t] { restore_crown(t->crown.mesh, t->joining, t->fuse.restore); }},
      {"remeshing", [t] { t->remeshed_root(); }},
      {"transition", [t] { t->smooth(); }},
      {"check", [t] { check(t->input, t->tooth); }},
      {"whole_guiding_surface", [t] { fitted_guiding_surface(t->cloud, t->crown, t->options.e); }},
      {"whole_joining", [t] { fuse_crown_and_root(t->crown, t->surface, t->crown.growth_axis, t->fuse); }},
      {"whole_tooth", [t] { complete_tooth(t->input, *t->models, t->options); }},
  };
  if (root == RootOfBench::peg)
    std::erase_if(stages,
                  [](const BenchStage& s) { return s.name == "completion_network" || s.name == "whole_tooth"; });
  return stages;
}

}  // namespace rhizodont
