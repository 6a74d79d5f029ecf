// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/crown_model.hpp"
#include "families/population.hpp"
#include "rhizodont/mesh.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace rhizodont {

/// Height of the cemento-enamel junction (millimetres) as a smooth function of the position (x, y) around the tooth's
/// axis: a quadratic, evaluated at the nearest point of the neck's outline where (x, y) lies outside of it.
struct JunctionHeight {
  std::array<double, 6> coefficients{};  ///< of 1, x, y, x^2, xy, y^2
  Eigen::Vector2d half_width{4, 4};      ///< of the neck along x and y, millimetres

  double operator()(double x, double y) const;
};

/// One root of a template: what lies below its branching off.
struct TemplateRoot {
  std::size_t apex = 0;                     ///< vertex of the tip
  double branch_z = 0;                      ///< height at which the root becomes separate, template millimetres
  std::vector<Eigen::Vector2d> centreline;  ///< (x, y) every `centreline_step` from branch_z (or the junction) down
  static constexpr double centreline_step = 0.5;  ///< millimetres
};

/// A template tooth in its own frame: origin amid the cemento-enamel junction, +z from root to crown, +y to the cheek;
/// so that x, y, z is right-handed, +x is distal for upper and mesial for lower left teeth.
struct FamilyTemplate {
  TriangleMesh mesh;                  ///< closed, genus 0, outward, simplified; millimetres as in the file
  std::vector<std::uint8_t> crown;    ///< per vertex: 1 enamel, 0 cementum
  std::vector<int> root;              ///< per vertex: index into roots below that root's branching, else -1
  std::vector<TemplateRoot> roots;    ///< one for single-rooted teeth (branching at the junction), else two or three
  JunctionHeight junction;            ///< height of the cemento-enamel junction
  double furcation_z = 0;             ///< highest branching; 0 for a single root
  double crown_height = 0;            ///< top above the junction's mean height, millimetres
  double root_length = 0;             ///< junction's mean height to the deepest apex along z, millimetres
  Eigen::Vector2d crown_width{1, 1};  ///< extent of the crown along x (mesiodistal) and y (buccolingual), millimetres
};

/// Mean dimensions of a tooth type, millimetres: of the crown from anatomy.csv (Wheeler; Ash and Nelson), of the root
/// from the population.
struct ToothDimensions {
  double crown_height = 0;
  double root_length = 0;  ///< of the longest root
  double crown_mesiodistal = 0;
  double crown_buccolingual = 0;
};

/// A template that stands in for another type, or beside a type's own.
struct TemplateLoan {
  int type = 0;      ///< 0..15: grown as
  int from = 0;      ///< template of that type, 0..15; from 16 on the further templates (ToothFamilies::further)
  double share = 0;  ///< of that type's teeth, 0..1
  double turn = 0;   ///< rotation about z (radians) that `crown` has against the type's own
  /// The borrowed template's vertices with its crown in the form of the type's mean, as far as there are models of it.
  std::vector<Point> crown = {};
  /// Growth axis of the type's mean crown where it lies on `crown`, unit.
  Eigen::Vector3d crown_axis{0, 0, 1};
};

/// A statistical crown model on the template that a type is grown from.
struct FamilyCrownModel {
  int type = 0, from = 0;     ///< grown as, template of: see TemplateLoan
  double usual_share = 1;     ///< part of modes.mean_shift that a tooth of the type has on average
  double template_share = 0;  ///< part that the template has already
  CrownModes modes;
};

/// Everything the generator draws from; immutable after loading, may be shared between threads.
struct ToothFamilies {
  /// Brought towards the mean crown of their type's statistical model, where there is one.
  std::array<FamilyTemplate, tooth_type_count> templates;
  /// Registered teeth of people (register_tooth.hpp): triangles and places of their type's own template, each as likely
  /// as that.
  std::vector<FamilyTemplate> further;
  std::array<ToothDimensions, tooth_type_count> dimensions;
  /// Now and then a type is grown from a neighbour's template.
  std::vector<TemplateLoan> loans;
  /// Of left and right crowns; none where the models' folder is missing. Third molars borrow those of second molars.
  std::vector<FamilyCrownModel> crown_models;
  /// Growth axis of each loaded type's mean crown (mean_crown), unit, in the frame of its template, not turned.
  std::array<Eigen::Vector3d, tooth_type_count> crown_axes;
  Population population;  ///< whose teeth these are
};

/// Number `from` of the families' templates: see TemplateLoan.
const FamilyTemplate& template_of(const ToothFamilies& families, int from);

/// Options of load_tooth_families.
struct FamilyLoadOptions {
  std::size_t vertices = 5000;            ///< vertices per template after simplification, >= 500
  std::vector<int> types;                 ///< types 0..15 to load; empty: all
  std::size_t crown_modes = 24;           ///< modes of the statistical crown models, 0..40; 0: do without these models
  std::filesystem::path population = {};  ///< another table (population.hpp); empty: the middle of published ones
  std::filesystem::path registered = {};  ///< folder of registered teeth (registered_templates.hpp); empty: none
};

/// Reads folder/templates/tooth_FDI.ply (21-28, 31-38; per-vertex `crown`: 1 enamel, 0 cementum, 255 unlabelled) and
/// folder/anatomy.csv, and finds axes, junction, roots, apices and furcations. Takes some seconds.
/// If there is a folder/crowns/ssm with crown_ssm_FDI.safetensors (x1-x7 of all quadrants; see CrownShapeModel), these
/// are registered to the templates.
/// Throws InputError if a file is missing or damaged or a template is not a closed surface of genus 0, NoResultError if
/// a type's mean crown cannot be cut from its template; as load_population for another table and
/// load_registered_teeth for registered ones.
ToothFamilies load_tooth_families(const std::filesystem::path& folder, const FamilyLoadOptions& options = {});

/// How generated teeth vary: factors on what the population says of a type (population.hpp), and standard deviations of
/// what no table has. 0 switches a variation off.
struct ToothVariation {
  double crown_modes = 1.1;    ///< factor on the crown models' own deviations
  double crown_mean = 0.35;    ///< of the way from the template's own crown (-1) to the model's mean (0)
  double size = 1;             ///< factor on the deviation of the crown's size
  double proportion = 1;       ///< factor on the deviation of either width
  double crown_height = 0.07;  ///< height of the crown on its own, relative
  double root_length = 1;      ///< factor on the deviation of root lengths beside what goes with size
  double trunk = 1;            ///< factor on the deviation of the root trunk
  double warp_mm = 0.27;       ///< smooth displacement of the surface of a tooth 8 mm wide, waves of 7 to 20 mm
  double root_thickness = 1;   ///< factor on the deviation of the root's widths
  double taper = 0.15;         ///< change of the cross-section from neck to apex, relative
  double lean = 1;             ///< factor on the angle between the root's line and the crown's axis
  double template_lean = 0.4;  ///< share of the lean of the template's own root that its type has on average, 0..1. One
                               ///< tooth cannot tell what is its own and what its type's: templates of neighbouring
                               ///< types lean by 1 to 16 degrees, in either direction
  double distal_bend_mm = 0.6;      ///< sweep of the whole root towards distal and buccal, millimetres at the apex
  double curvature = 1;             ///< factor on the angles of curved roots
  double dilaceration = 1;          ///< factor on the share of teeth with a sharp turn near the tip, 0..3
  double divergence_mm = 1.0;       ///< shift of each apex of a multi-rooted tooth away from the others, millimetres
  double fusion = 1;                ///< factor on the share of teeth whose roots part late, 0..2
  double junction_curve = 0.2;      ///< depth of the curves of the cemento-enamel junction, relative
  double blunt_share = 0.4;         ///< share of root tips that are rounded off, by up to 0.7 mm, 0..1
  double short_roots = 1;           ///< factor on the share of teeth with short, blunt roots from birth, 0..10
  double open_apex_share = 0.03;    ///< share of immature teeth: short and wide open at the tip, 0..1
  double resorption_share = 0.022;  ///< share of teeth with shortened, blunt roots, 0..1
  double bulbous_share = 0.02;      ///< share of roots that swell towards the tip, 0..1
  double deciduous_share = 0.02;    ///< share of small squat crowns on slender, flaring roots, 0..1
  double wear_mm = 3.0;             ///< loss of cusp height of much worn teeth; most lose little, millimetres
  double wear_share = 0.5;          ///< share of worn teeth, 0..1; one in twelve of them is worn down by up to half
  double decay_share = 0.05;        ///< share of crowns with a cavity or chip, 0..1
  double bracket_share = 0.05;      ///< share of crowns with a bracket or attachment, 0..1
};

/// Every tooth of a type is the mean one.
ToothVariation no_variation();

/// A generated whole tooth, millimetres, in the frame of FamilyTemplate, and what is known about it.
struct SyntheticTooth {
  int type = 0;                          ///< 0..15, left side
  TriangleMesh mesh;                     ///< closed, genus 0, outward
  std::vector<std::uint8_t> crown;       ///< per vertex: 1 enamel, 0 cementum
  std::vector<int> root;                 ///< per vertex: root below its branching, else -1
  Eigen::Vector3d growth_axis{0, 0, 1};  ///< root to crown
  JunctionHeight junction;               ///< height of the cemento-enamel junction
  double crown_turn = 0;                ///< rotation about z (radians) that the crown has against the type's mean crown
  Eigen::Vector3d crown_axis{0, 0, 1};  ///< unit: growth axis of the type's mean crown where it lies on this one
  bool own_template = true;             ///< grown from the type's own template or a tooth registered to it: same
                                        ///< triangles and places as its others
  std::vector<Point> apices;            ///< tips of the roots
  std::vector<Eigen::Vector3d> root_axes;  ///< unit, from each root's tip to its middle where it branches off
  double crown_height = 0;                 ///< top above the junction's mean height
  double root_length = 0;                  ///< junction's mean height to the deepest apex along z
  double furcation_z = 0;                  ///< highest branching, height; 0 for a single root
};

/// Standard normal numbers that a tooth takes instead of drawing its own, for what it shares with others (person.hpp).
struct SharedDraws {
  std::optional<double> size;            ///< of the crown, beside the type's mean
  std::optional<double> root_length;     ///< beside what goes with size
  std::optional<double> root_thickness;  ///< half of the variance of the root's widths along x and y
  std::optional<double> wear;            ///< rank among teeth by wear: the most worn are those above some number
};

/// Draws tooth number `seed` of a type (0..15). Depends on the arguments alone. A draw that folds, turns over or lets
/// triangles run into each other is rejected and drawn again.
/// Throws UsageError for a bad type or one that was not loaded, NoResultError after
/// `most_tooth_draws` rejected draws.
SyntheticTooth generate_tooth(const ToothFamilies& families, int type, std::uint64_t seed,
                              const ToothVariation& variation = {}, const SharedDraws& shared = {});

/// Draw number `draw` (0..most_tooth_draws - 1) of that tooth; nothing where it is rejected. Throws UsageError as
/// `generate_tooth`.
std::optional<SyntheticTooth> draw_tooth(const ToothFamilies& families, int type, std::uint64_t seed, int draw,
                                         const ToothVariation& variation, const SharedDraws& shared);
inline constexpr int most_tooth_draws = 20;

/// The tooth of a type (0..15) without any variation: its own template at mean dimensions. Throws as generate_tooth.
SyntheticTooth mean_tooth(const ToothFamilies& families, int type);

}  // namespace rhizodont
