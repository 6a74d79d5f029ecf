// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "families/arch_family.hpp"
#include "families/arch_source.hpp"
#include "families/crown_rim.hpp"
#include "families/plan_curve.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Crowns of one person in one jaw. All in the work frame: y from root to crown in both jaws, z to the front; x is to
// the patient's left in the lower jaw and to the right in the upper one.
namespace rhizodont {

/// Places of a jaw, from the patient's right to the left.
inline constexpr std::size_t arch_places = 16;
/// 1..8, of one of the sixteen.
inline int arch_place(std::size_t j) { return j < 8 ? 8 - static_cast<int>(j) : static_cast<int>(j) - 7; }
/// Whether it is on the patient's right.
inline bool arch_right(std::size_t j) { return j < 8; }

/// A crown in its arch, or the ridge where one is missing.
struct ArchCrown {
  int fdi = 0;         ///< 0 for the ridge behind the last tooth
  bool ghost = false;  ///< no tooth: the ridge alone
  TriangleMesh mesh;   ///< in its own frame: z from root to crown, y to the cheek, the rim's middle at the origin
  CrownRim rim;
  Eigen::Isometry3d to_work = Eigen::Isometry3d::Identity();
  double along = 0;         ///< mm along the arch's curve
  double width = 0;         ///< mm along the arch
  double height = 0;        ///< mm: top of the crown above the origin
  double margin_shift = 0;  ///< mm: by how much the gum stands higher (towards the cusps) than the rim
  double hood_mm = 0;       ///< of gum that stands higher behind a tooth that has not come through all the way
  double wear_mm = 0;       ///< taken off the top
  bool stump = false, bracket = false, attachment = false;
};

/// A person's jaw.
struct ArchCrowns {
  Jaw jaw = Jaw::upper;
  PlanCurve curve;                ///< of the middles, (x, z), from the patient's right to the left
  double outward = 1;             ///< cheek side of the curve: outward * (-tangent.z, tangent.x)
  std::vector<ArchCrown> crowns;  ///< from the patient's right to the left, ghosts among them
  std::vector<int> missing;
  double size = 1;
  std::vector<std::string> drawn;

  /// Towards the cheek at a length along the curve, unit, in the plan.
  Eigen::Vector2d outward_at(double s) const {
    const Eigen::Vector2d t = curve.tangent(s);
    return outward * Eigen::Vector2d(-t.y(), t.x());
  }
};

/// What both jaws of a person have in common.
struct ArchPerson {
  std::array<double, 2 * arch_rows> size{};  ///< relative to the mean, rows as in ArchSource::size_root
  double wear_mm = 0;
  double margin_shift = 0;  ///< mm, of all teeth
  bool crowded = false, spaced = false, child = false, brackets = false;
  double room_mm = 0;    ///< how wide gaps are, or how far crowded teeth stand out of line
  int real_person = -1;  ///< whose crowns, or -1: drawn
  bool mirrored = false;
  double disorder = 1;  ///< factor on how places and turns deviate from the mean arch
  double detail = 0;    ///< share of drawn crowns with a real crown's finer forms on them
};

/// Draws what both jaws share. Depends on its arguments alone.
ArchPerson draw_arch_person(const ArchSource& source, std::uint64_t seed, const ArchDrawOptions& options);

/// A crown before it has its place: turned as in the mean arch, in the work frame, about its middle.
struct LooseCrown {
  ArchCrown crown;          ///< `to_work` turns it as in the mean arch and puts its middle at the origin
  Point place;              ///< of its middle in the mean arch
  Eigen::Vector2d tangent;  ///< of the mean arch there, from the patient's right to the left
};

/// The crowns of a person's jaw at places 8 (right) to 8 (left), all sixteen, form and size drawn.
std::vector<LooseCrown> draw_loose_crowns(const ArchSource& source, const ArchPerson& person, Jaw jaw,
                                          RandomStream& random, const ArchDrawOptions& options);

/// Draws a jaw of a person: crowns, which are there, places, contacts.
ArchCrowns draw_crowns(const ArchSource& source, const ArchPerson& person, Jaw jaw, std::uint64_t seed,
                       const ArchDrawOptions& options);

}  // namespace rhizodont
