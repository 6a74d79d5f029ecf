// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Every option that a caller can set, once out of its range on either side where it has two: refused by name before
// anything else is looked at.

#include "common/option_faults.hpp"
#include "completion/registration.hpp"
#include "evaluation/root_figures.hpp"
#include "evaluation/template_predictor.hpp"
#include "families/tooth_family.hpp"
#include "fusion/fuse.hpp"
#include "guiding/crown_fit.hpp"
#include "guiding/guiding_cloud.hpp"
#include "guiding/guiding_surface.hpp"
#include "isosurface/isosurface.hpp"
#include "mesh/pieces.hpp"
#include "mesh/repair.hpp"
#include "mesh/test_meshes.hpp"
#include "pictures/render.hpp"
#include "pipeline/models.hpp"
#include "pipeline/product_models.hpp"
#include "poisson/orientation.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "skirt/cap.hpp"
#include "skirt/made_cap.hpp"
#include "skirt/ragged_part.hpp"
#include "skirt/skirt_border.hpp"
#include "skirt/skirt_network.hpp"
#include "skirt/spikes.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/completion_sample.hpp"
#include "training/skirt_sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

using test::expect_each_refused_by_name;
using test::Fault;
using test::Faults;

constexpr double infinite = std::numeric_limits<double>::infinity();
const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

PreparedCrown dome() { return prepare_crown(test::dome(2, 5)); }

TEST(OptionRanges, OfMeshes) {
  std::vector<Fault> faults;
  using R = RepairOptions;
  Faults<R>(faults, [](const R& o) { repair({}, o); })
      .of("spike_height", &R::spike_height, {0.0, infinite})
      .of("spike_least_mm", &R::spike_least_mm, {-0.1})
      .of("most_cut_share", &R::most_cut_share, {-0.1, 1.1})
      .of("rounds", &R::rounds, {0})
      .set("most_mm", [](R& o) { o.seam.most_mm = -1; });
  Faults<SeamOptions>(faults, [](const SeamOptions& o) { find_seams({}, o); })
      .of("most_mm", &SeamOptions::most_mm, {-0.1, infinite})
      .of("edge_share", &SeamOptions::edge_share, {-0.1, 0.5});
  using P = PieceOptions;
  for (const auto& use :
       {Faults<P>::Use([](const P& o) { sort_pieces({}, o); }), Faults<P>::Use([](const P& o) { drop_specks({}, o); })})
    Faults<P>(faults, use)
        .of("speck_area", &P::speck_area, {-0.1, 1.0})
        .of("speck_triangles", &P::speck_triangles, {-0.1, 1.0})
        .of("all_specks", &P::all_specks, {-0.1, 1.0})
        .of("like_share", &P::like_share, {0.0, 1.1});
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfCapsAndSkirts) {
  std::vector<Fault> faults;
  using M = MadeCapOptions;
  Faults<M>(faults, [](const M& o) { find_made_cap({}, o); })
      .of("least_fan", &M::least_fan, {8})
      .of("long_edge", &M::long_edge, {1.0})
      .of("flat_mm", &M::flat_mm, {0.0})
      .of("least_rim", &M::least_rim, {2})
      .of("least_share", &M::least_share, {0.0, 1.1})
      .of("least_flatness", &M::least_flatness, {-0.1, 1.1})
      .of("least_roundness", &M::least_roundness, {-0.1, 1.0})
      .of("least_crown", &M::least_crown, {-0.1, 1.0});
  using C = CapOptions;
  for (const auto& use : {Faults<C>::Use([](const C& o) { find_cap({}, up, o); }),
                          Faults<C>::Use([](const C& o) { require_cap({}, o); })})
    Faults<C>(faults, use)
        .of("facing", &C::facing, {-1.0, 1.0})
        .of("ridge_angle", &C::ridge_angle, {0.0})
        .of("least_flatness", &C::least_flatness, {-0.1, 1.1})
        .of("least_rim", &C::least_rim, {-0.1})
        .of("least_share", &C::least_share, {-0.1, 1.1});
  using S = SpikeOptions;
  Faults<S>(faults, [](const S& o) { triangles_without_spikes({}, o); })
      .of("tip", &S::tip, {-0.1, 360.1})
      .of("flap", &S::flap, {-0.1, 180.1})
      .of("fin", &S::fin, {0.0, 180.1})
      .of("rounds", &S::rounds, {0});
  using R = RaggedPartOptions;
  for (const auto& use : {Faults<R>::Use([](const R& o) { triangles_without_slits({}, o); }),
                          Faults<R>::Use([](const R& o) { triangles_without_ragged_defects({}, o); })})
    Faults<R>(faults, use)
        .of("depth", &R::depth, {-0.1})
        .of("rounds", &R::rounds, {0})
        .of("slit", &R::slit, {-0.1, 1.1});
  using B = SkirtBorderOptions;
  Faults<B>(faults, [](const B& o) { tooth_triangles({}, {}, o); })
      .of("threshold", &B::threshold, {0.0, 1.0})
      .of("smoothness", &B::smoothness, {-0.1})
      .of("crease", &B::crease, {0.0})
      .of("least_kept", &B::least_kept, {-0.1, 1.1});
  using N = SkirtNetworkOptions;
  Faults<N>(faults, [](const N& o) {
    skirt_confidence({}, content_of(test::models())->skirt.value(), o);
  }).of("most_vertices", &N::most_vertices, {199});
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfTheGuidingSurface) {
  std::vector<Fault> faults;
  using O = OrientationOptions;
  Faults<O>(faults, [](const O& o) { orient_normals({}, {}, o); })
      .of("neighbours", &O::neighbours, {3, 101})
      .of("hint_trust", &O::hint_trust, {-0.1, 1.1})
      .of("blend", &O::blend, {-0.1, 1.1});
  using I = IndicatorOptions;
  Faults<I>(faults, [](const I& o) { solve_indicator({}, {}, o); })
      .of("spacing", &I::spacing, {0.01, 10.1})
      .of("degree", &I::degree, {0, 3})
      .of("screening", &I::screening, {-0.1, infinite})
      .of("margin", &I::margin, {0.0, 1000.0})
      .of("samples_per_cell", &I::samples_per_cell, {0.0})
      .of("neighbours", &I::neighbours, {2, 101})
      .of("tolerance", &I::tolerance, {0.0, 1.0})
      .of("max_cycles", &I::max_cycles, {0});
  using S = IsosurfaceOptions;
  const ScalarField none;
  for (const auto& use : {Faults<S>::Use([&](const S& o) { mid_normal(none, 0, {}, o); }),
                          Faults<S>::Use([&](const S& o) { grad_normal(none, 0, {}, o); }),
                          Faults<S>::Use([&](const S& o) { marching_tetrahedra(none, 0, {}, o); })})
    Faults<S>(faults, use)
        .of("e", &S::e, {0.0, infinite})
        .of("tolerance", &S::tolerance, {0.0})
        .of("max_displacement", &S::max_displacement, {0.0, 1.1})
        .of("max_change", &S::max_change, {-0.1})
        .of("max_cells", &S::max_cells, {std::size_t{0}});
  using G = GuidingSurfaceOptions;
  Faults<G>(faults, [](const G& o) { guiding_surface({}, {}, {}, o); })
      .of("smearings", &G::smearings, {0})
      .set("degree", [](G& o) { o.indicator.degree = 3; })
      .set("max_change", [](G& o) { o.isosurface.max_change = -1; });
  using C = GuidingCloudOptions;
  Faults<C>(faults, [](const C& o) { assemble_guiding_cloud(dome(), {}, o); })
      .of("crown_spacing", &C::crown_spacing, {0.0})
      .of("orientation_spacing", &C::orientation_spacing, {0.0})
      .of("crown_confidence", &C::crown_confidence, {0.0})
      .of("gap", &C::gap, {-0.1})
      .of("correction_reach", &C::correction_reach, {0.0})
      .of("smoothing_neighbours", &C::smoothing_neighbours, {11})
      .of("smoothing_rounds", &C::smoothing_rounds, {-1});
  using F = CrownFitOptions;
  Faults<F>(faults,
            [](const F& o) {
              TriangleMesh empty;
              fit_to_crown(empty, dome(), o);
            })
      .of("tolerance", &F::tolerance, {0.0})
      .of("reach", &F::reach, {0.0})
      .of("fading_rings", &F::fading_rings, {-1})
      .of("most_rounds", &F::most_rounds, {-1});
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfVoronoiDiagramsAndJoining) {
  std::vector<Fault> faults;
  using D = DelaunayMeshOptions;
  Faults<D>(faults, [](const D& o) { make_delaunay_mesh({}, o); })
      .of("angle_slack", &D::angle_slack, {-0.1})
      .of("shortest_piece", &D::shortest_piece, {-0.1})
      .of("steiner_limit", &D::steiner_limit, {-0.1});
  using V = RestrictedVoronoiOptions;
  Faults<V>(faults, [](const V& o) { restricted_voronoi({}, {}, o); })
      .of("neighbours", &V::neighbours, {0})
      .set("density", [](V& o) {
        o.density = {1, -1};
      });
  using S = SeparationOptions;
  Faults<S>(faults, [](const S& o) { separate_crown_and_root({}, {}, up, o); })
      .of("epsilon", &S::epsilon, {0.0})
      .of("clearance", &S::clearance, {-0.1});
  using J = JoinOptions;
  Faults<J>(faults, [](const J& o) { join_crown_and_root({}, {}, {}, o); })
      .of("least_distance", &J::least_distance, {-0.1})
      .set("steiner_limit", [](J& o) { o.delaunay.steiner_limit = -1; })
      .set("neighbours", [](J& o) { o.voronoi.neighbours = 0; });
  using R = RestoreOptions;
  Faults<R>(faults, [](const R& o) { restore_crown({}, {}, o); }).of("rounds", &R::rounds, {-1});
  using T = TransitionOptions;
  Faults<T>(faults,
            [](const T& o) {
              JoinedTooth tooth;
              smooth_transition(tooth, o);
            })
      .set("width", [](T& o) { o.width = -0.1; })
      .of("gap", &T::gap, {-0.1})
      .of("slope", &T::slope, {0.0})
      .of("rows", &T::rows, {0.0})
      .of("least_width", &T::least_width, {-0.1})
      .of("largest_width", &T::largest_width, {0.7})
      .of("inner_angle", &T::inner_angle, {-0.1, 30.1})
      .of("border_angle", &T::border_angle, {-0.1, 30.1})
      .of("cut_rounds", &T::cut_rounds, {0});
  using F = FuseOptions;
  Faults<F>(faults, [](const F& o) { fuse_crown_and_root(dome(), {}, up, o); })
      .of("edge_growth", &F::edge_growth, {0.0})
      .of("edge_shrinkage", &F::edge_shrinkage, {0.0})
      .of("attempts", &F::attempts, {0})
      .of("remesh_attempts", &F::remesh_attempts, {0})
      .set("other_growths",
           [](F& o) {
             o.other_growths = {0.5, 0};
           })
      .set("epsilon", [](F& o) { o.separation.epsilon = 0; })
      .set("spacing", [](F& o) { o.sites.spacing = 0.5; })
      .set("least_distance", [](F& o) { o.join.least_distance = -1; })
      .set("rounds", [](F& o) { o.restore.rounds = -1; })
      .set("iterations", [](F& o) { o.remesh.iterations = -1; })
      .set("cut_rounds", [](F& o) { o.transition.cut_rounds = 0; });
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfTheRoot) {
  const TriangleMesh crown = test::dome(2, 5), surface = test::sphere(2, 5);
  const CrownBorder border = find_crown_border(crown);
  const EdgeLengths lengths(crown, border, 0.3, 1.2, 0.15);
  const SurfaceWalk walk(surface);
  std::vector<Fault> faults;
  using S = RootSitesOptions;
  Faults<S>(faults, [&](const S& o) { root_sites(walk, {}, crown, border, lengths, o); })
      .of("spacing", &S::spacing, {0.5, 1.0})
      .of("reach", &S::reach, {1.0})
      .of("spring_reach", &S::spring_reach, {1.0})
      .of("stiffness", &S::stiffness, {0.0, 2.0})
      .of("spring_steps", &S::spring_steps, {-1});
  using R = RemeshRootOptions;
  Faults<R>(faults,
            [&](const R& o) {
              JoinedTooth tooth;
              remesh_root(tooth, walk, lengths, {}, 0, o);
            })
      .of("iterations", &R::iterations, {-1})
      .of("longest", &R::longest, {1.0})
      .of("shortest", &R::shortest, {0.0, 1.0})
      .of("fading", &R::fading, {0.0})
      .of("least_angle", &R::least_angle, {-0.1, 30.1})
      .of("mending_rounds", &R::mending_rounds, {-1})
      .of("inner_angle", &R::inner_angle, {-0.1, 30.1})
      .of("border_angle", &R::border_angle, {-0.1, 30.1})
      .of("mending_passes", &R::mending_passes, {-1})
      .of("mending_splits", &R::mending_splits, {-0.1})
      .of("mending_places", &R::mending_places, {-0.1});
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfFramesAndFigures) {
  std::vector<Fault> faults;
  using R = RegistrationOptions;
  for (const auto& use : {Faults<R>::Use([](const R& o) { canonical_frame(dome(), 36, {}, o); }),
                          Faults<R>::Use([](const R& o) { guess_fdi_type(dome(), {}, o); }),
                          Faults<R>::Use([](const R& o) { fit_mean_crown({}, {}, true, true, up, o); })})
    Faults<R>(faults, use)
        .of("start_angles", &R::start_angles, {3})
        .of("refined_starts", &R::refined_starts, {0, 37})
        .of("iterations", &R::iterations, {0})
        .of("trim", &R::trim, {0.29, 1.1})
        .of("normal_weight_mm", &R::normal_weight_mm, {-0.1});
  using P = RenderOptions;
  Faults<P>(faults, [](const P& o) { render({}, o); })
      .of("width", &P::width, {15, 8193})
      .of("height", &P::height, {15, 8193})
      .of("supersampling", &P::supersampling, {0, 9});
  using F = RootFigureOptions;
  Faults<F>(faults, [](const F& o) { root_figures({}, {}, {}, up, o); })
      .of("samples", &F::samples, {std::size_t{99}})
      .of("root_threshold_mm", &F::root_threshold_mm, {0.0})
      .of("surface_threshold", &F::surface_threshold, {0.0})
      .of("least_prominence_mm", &F::least_prominence_mm, {0.0});
  using T = TemplateFitOptions;
  Faults<T>(faults, [](const T& o) { fit_template({}, {}, o); })
      .of("start_rotations", &T::start_rotations, {0})
      .of("iterations", &T::iterations, {0})
      .of("samples", &T::samples, {std::size_t{99}})
      .of("trim", &T::trim, {0.0, 1.1})
      .of("border_margin_mm", &T::border_margin_mm, {-0.1})
      .of("largest_scale_step", &T::largest_scale_step, {1.0});
  using C = CheckOptions;
  Faults<C>(faults, [](const C& o) { check({}, {}, o); }).of("least_kept_share", &C::least_kept_share, {-0.1, 1.1});
  expect_each_refused_by_name(faults);
}

TEST(OptionRanges, OfGeneratedTeeth) {
  std::vector<Fault> faults;
  using L = FamilyLoadOptions;
  Faults<L>(faults, [](const L& o) { load_tooth_families("nowhere", o); })
      .of("vertices", &L::vertices, {std::size_t{499}})
      .of("crown_modes", &L::crown_modes, {std::size_t{41}})
      .set("types", [](L& o) {
        o.types = {0, 16};
      });
  using C = CompletionSampleOptions;
  Faults<C>(faults, [](const C& o) { make_completion_sample({}, 1, o); })
      .of("input_points", &C::input_points, {std::size_t{0}})
      .of("target_points", &C::target_points, {std::size_t{0}})
      .of("type", &C::type, {-2, 16})
      .of("paper_crop_share", &C::paper_crop_share, {-0.1, 1.1})
      .of("scanner_noise_mm", &C::scanner_noise_mm, {-0.1})
      .of("gap_probability", &C::gap_probability, {-0.1, 1.1})
      .of("skirt_probability", &C::skirt_probability, {-0.1, 1.1})
      .of("skirt_mm", &C::skirt_mm, {-0.1})
      .of("lost_turn_share", &C::lost_turn_share, {-0.1, 1.1})
      .of("rotation_jitter_radians", &C::rotation_jitter_radians, {-0.1})
      .of("form_axis_error_degrees", &C::form_axis_error_degrees, {-0.1});
  using S = SkirtSampleOptions;
  Faults<S>(faults, [](const S& o) { make_skirt_sample({}, 1, o); })
      .of("type", &S::type, {-2, 16})
      .of("finest_edge_mm", &S::finest_edge_mm, {0.09, 1.1})
      .of("coarsest_edge_mm", &S::coarsest_edge_mm, {0.27, 1.1})
      .of("clean_share", &S::clean_share, {-0.1, 1.1})
      .of("hole_share", &S::hole_share, {-0.1, 1.1})
      .of("largest_noise", &S::largest_noise, {-0.1, 0.31});
  expect_each_refused_by_name(faults);
}

}  // namespace
}  // namespace rhizodont
