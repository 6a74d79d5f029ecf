// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/tooth_directions.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Generated scans of one jaw: crowns of one person in an arch, gum around them, and what scanners make of it.
namespace rhizodont {

/// What arches are drawn from; immutable once loaded, may be shared between threads.
struct ArchSource;
struct ArchFamily {
  std::shared_ptr<const ArchSource> source;
};

/// Reads folder/crowns/ssm/crown_ssm_FDI.safetensors (28 teeth), folder/crowns/arch_covariances.safetensors and, where
/// they are, folder/crowns/patient0 and patient1 (28 crown_FDI.ply each). Takes about a second. Throws InputError where
/// a model or the covariances are missing or damaged.
ArchFamily load_arch_family(const std::filesystem::path& folder);

/// How generated arches vary. Shares are probabilities, 0..1; factors are 0..2, 1 being as people are, 0 none of it.
struct ArchDrawOptions {
  std::optional<Jaw> jaw;  ///< nothing: drawn
  bool any_pose = true;    ///< turned and moved at random; else y is up, z to the front, teeth as the arch's frame
  /// Least and most triangles, 2,000..400,000; their number is drawn between, evenly in its logarithm. A scan whose
  /// grid gives fewer than the number drawn keeps what it has.
  std::pair<std::size_t, std::size_t> triangles{8000, 60000};
  double grid_mm =
      0.42;          ///< cell of the grid that the surface is drawn from, 0.2..0.6; time grows with its -2.5th power
  double shape = 1;  ///< factor on how crowns differ in form and size
  double arrangement = 1;         ///< factor on how places and turns differ
  double crowding_share = 0.35;   ///< arches with too little room: overlaps, turned teeth
  double spacing_share = 0.15;    ///< arches with gaps between teeth
  double missing_share = 0.4;     ///< arches that lack one tooth or several (other than wisdom teeth)
  double wisdom_share = 0.2;      ///< arches with one wisdom tooth or both
  double partial_share = 0.1;     ///< scans of a part of the arch
  double milk_share = 0.12;       ///< arches with milk teeth among the others: orthodontists see many children
  double wear_share = 0.4;        ///< people with worn crowns
  double stump_share = 0.05;      ///< arches with a tooth or some ground down for restorations
  double bracket_share = 0.08;    ///< arches with brackets or attachments
  double real_crown_share = 0.2;  ///< arches of the crowns of one of the two real people instead of drawn ones
  double model_share = 0.1;       ///< arches on a closed model base
  double defects = 1;             ///< factor on noise, holes, flaps, bubbles, islands
};

/// A tooth as it is in a generated scan, in the scan's frame and millimetres.
struct GeneratedTooth {
  int fdi = 0;
  Point middle = Point::Zero();  ///< of the visible crown: mean of its vertices in the scan
  ToothDirections directions;    ///< long axis and cheek side
  std::size_t vertices = 0;      ///< that bear its number
  bool worn = false, stump = false, bracket = false, attachment = false, half_erupted = false;
};

/// A generated scan of one jaw.
struct GeneratedArch {
  TriangleMesh scan;     ///< oriented manifold with borders, perhaps of several pieces; coordinates are floats
  std::vector<int> fdi;  ///< per vertex: the tooth's number, 0 for gum and everything else
  Jaw jaw = Jaw::upper;
  std::vector<GeneratedTooth> teeth;  ///< those that have vertices, along the arch from the patient's right to the left
  std::vector<int> missing;           ///< teeth 1 to 7 of both sides that the person lacks
  /// scan = rotation * arch + shift, where in the arch y is up, z to the front and x to the patient's left.
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double size = 1;                 ///< the person's: mean of the crowns' relative sizes
  std::vector<std::string> drawn;  ///< what is unusual about it, a word or two each: "crowding", "model base"
};

/// Draws scan number `seed`. The upper and the lower jaw of one seed belong to one person. Depends on the arguments
/// alone, not on threads. Throws UsageError for an option out of range; NoResultError where a draw gives no surface
/// even after three attempts.
GeneratedArch sample_arch(const ArchFamily& family, std::uint64_t seed, const ArchDrawOptions& options = {});

}  // namespace rhizodont
