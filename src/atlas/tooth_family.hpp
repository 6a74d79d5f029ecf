// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/frame.hpp"
#include "rhizodont/mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
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

/// Mean dimensions of a tooth type, millimetres (anatomy.csv: Wheeler; Ash and Nelson).
struct ToothDimensions {
  double crown_height = 0;
  double root_length = 0;  ///< of the longest root
  double crown_mesiodistal = 0;
  double crown_buccolingual = 0;
};

/// A template that stands in for another type.
struct TemplateLoan {
  int type = 0, from = 0;  ///< types 0..15: grown as, template of
  double share = 0;        ///< of that type's teeth, 0..1
  double turn = 0;         ///< rotation about z (radians) that the borrowed template has against the type's own
};

/// Everything the generator draws from; immutable after loading, may be shared between threads.
struct ToothFamilies {
  std::array<FamilyTemplate, tooth_type_count> templates;
  std::array<ToothDimensions, tooth_type_count> dimensions;
  /// Now and then a type is grown from a neighbour's template.
  std::vector<TemplateLoan> loans;
};

/// Options of load_tooth_families.
struct FamilyLoadOptions {
  std::size_t vertices = 5000;  ///< vertices per template after simplification, >= 500
  std::vector<int> types;       ///< types 0..15 to load; empty: all
};

/// Reads folder/templates/tooth_FDI.ply (21-28, 31-38; per-vertex `crown`: 1 enamel, 0 cementum, 255 unlabelled) and
/// folder/anatomy.csv, and finds axes, junction, roots, apices and furcations. Takes some seconds.
/// Throws InputError if a file is missing or damaged or a template is not a closed surface of genus 0.
ToothFamilies load_tooth_families(const std::filesystem::path& folder, const FamilyLoadOptions& options = {});

/// How generated teeth vary; standard deviations unless said otherwise. 0 switches a variation off.
struct ToothVariation {
  double size = 0.06;                  ///< common factor of all crown dimensions, relative
  double proportion = 0.05;            ///< mesiodistal, buccolingual and height each on its own, relative
  double root_length_mm = 1.45;        ///< root length beside what goes with size, millimetres
  double root_size_correlation = 0.5;  ///< exponent with which the root's length follows the crown's size, 0..1
  double trunk = 0.15;                 ///< length of the root trunk, relative
  double warp_mm = 0.27;               ///< smooth displacement of the surface of a tooth 8 mm wide, waves of 7 to 20 mm
  double root_thickness = 0.08;        ///< the root's cross-section along x and y each, relative
  double taper = 0.12;                 ///< change of the cross-section from neck to apex, relative
  double distal_bend_mm = 0.9;         ///< sideways shift of the apex towards distal and buccal, millimetres
  double divergence_mm = 0.9;          ///< shift of each apex of a multi-rooted tooth away from the others, millimetres
  double junction_curve = 0.2;         ///< depth of the curves of the cemento-enamel junction, relative
  double blunt_share = 0.4;            ///< share of root tips that are rounded off, by up to 0.7 mm, 0..1
  double wear_mm = 0.8;                ///< upper end of the uniform loss of cusp height in a worn tooth, millimetres
  double wear_share = 0.4;             ///< share of worn teeth, 0..1
};

/// A generated whole tooth, millimetres, in the frame of FamilyTemplate, and what is known about it.
struct SyntheticTooth {
  int type = 0;                          ///< 0..15, left side
  TriangleMesh mesh;                     ///< closed, genus 0, outward
  std::vector<std::uint8_t> crown;       ///< per vertex: 1 enamel, 0 cementum
  std::vector<int> root;                 ///< per vertex: root below its branching, else -1
  Eigen::Vector3d growth_axis{0, 0, 1};  ///< root to crown
  JunctionHeight junction;               ///< height of the cemento-enamel junction
  double crown_turn = 0;      ///< rotation about z (radians) that the crown has against the type's mean crown
  std::vector<Point> apices;  ///< tips of the roots
  double crown_height = 0;    ///< top above the junction's mean height
  double root_length = 0;     ///< junction's mean height to the deepest apex along z
  double furcation_z = 0;     ///< highest branching, height; 0 for a single root
};

/// Draws tooth number `seed` of a type (0..15). Depends on the arguments alone. A draw that folds, turns over or lets
/// roots run into each other is rejected and drawn again from the same seed's stream.
/// Throws UsageError for a bad type or one that was not loaded, NoResultError after 20 rejected draws.
SyntheticTooth generate_tooth(const ToothFamilies& families, int type, std::uint64_t seed,
                              const ToothVariation& variation = {});

/// The tooth of a type (0..15) without any variation: its own template at mean dimensions. Throws as generate_tooth.
SyntheticTooth mean_tooth(const ToothFamilies& families, int type);

}  // namespace rhizodont
