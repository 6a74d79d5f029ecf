// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/check.hpp"
#include "rhizodont/dropped_vertex.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/repair_step.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// Where the truth lies with 80 % probability, as found on generated teeth that the network was not trained on.
struct RootInterval {
  double length_low_mm = 0, length_high_mm = 0;  ///< of the root's length, which lies between them; else within
                                                 ///< [shortest_root_mm, longest_root_mm]
  double apex_radius_mm = 0;                     ///< of a ball around the apex
};

/// What a crown looks like, judged against generated crowns.
enum class LikenessVerdict {
  fits,         ///< like the tooth it is said to be
  other_tooth,  ///< like a tooth, but more like another one
  unlike,       ///< hardly like any tooth: little of a crown, a ground one, or none
};

/// One of the 32 teeth that a crown may be.
struct ToothLikeness {
  int fdi = 0;
  double probability = 0;  ///< 0..1, among the 32 teeth, each of which is as likely as the other beforehand
  double distance_mm = 0;  ///< mean distance, both ways, between the crown and the mean crown laid on it
};

/// How a crown agrees with the tooth it is said to be.
struct CrownLikeness {
  LikenessVerdict verdict = LikenessVerdict::fits;
  ToothLikeness said;                 ///< the tooth that it was said to be or taken for
  std::array<ToothLikeness, 2> next;  ///< the two most probable of the others
  double seen = 0;                    ///< share of that tooth's mean crown that the crown covers, 0..1
  double explained = 0;               ///< share of the crown's surface that lies near that mean crown, 0..1
  double unlike_probability = 0;      ///< 0..1: of this being no crown or little of one, if it is as frequent as crowns
};

/// Where a root comes from.
enum class RootSource {
  network,            ///< predicted for the crown as it was laid at first
  network_laid_anew,  ///< predicted for the crown laid otherwise, for the first root came out as shreds
  mean_tooth,         ///< the mean tooth of the type, laid on the crown, for all predictions came out as shreds
};

struct StageRecord {
  std::string name;
  double seconds = 0;
  double peak_memory_mb = 0;  ///< of the process so far
};

/// Where new triangles miss promise 3.
struct MissedPlace {
  std::string sentence;             ///< that says where, and by how much
  std::vector<int> crown_vertices;  ///< of the input, beside the worst triangle there; may be empty
};

/// What became of the input's crown.
struct CrownRecord {
  int triangles = 0;  ///< of the input
  int kept_triangles = 0;
  bool cap_dropped = false;
  std::vector<int> kept_vertices;  ///< of the input, ascending: vertex i of the tooth is kept_vertices[i]
  std::vector<DroppedCrownVertex> dropped_vertices;
  /// Per vertex of the input, 0..1: how sure the skirt network is that it is tooth; -1 where it was not asked. Empty if
  /// a skirt was to be kept.
  std::vector<float> tooth_confidence;
};

/// The pose in which the root was predicted.
struct FrameRecord {
  Eigen::Vector3d growth_axis{0, 0, 1};                    ///< unit, root to crown, in the input's frame
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< input directions to canonical directions
  Point centre = Point::Zero();                            ///< mm
  bool mirrored = false;
  double distance_to_mean_crown_mm = 0;  ///< mean distance between the crown and its type's mean crown
};

struct RootRecord {
  RootSource source = RootSource::network;
  double length_mm = 0;                  ///< along the growth axis, from the crown's border (lowest point) to the apex
  double tooth_length_mm = 0;            ///< extent along the growth axis
  double apex_expected_distance_mm = 0;  ///< what the network expects of its deepest points, before calibration
  /// Not there if the user set the length, turned or bent the root, or the weights were never calibrated.
  std::optional<RootInterval> interval;
};

/// How crown and root were joined.
struct JoiningRecord {
  double guiding_distance_mean_mm = 0;  ///< from the kept crown's vertices to the guiding surface
  double guiding_distance_max_mm = 0;
  int guiding_vertices = 0;
  int root_sites = 0;                   ///< root vertices that the dual was taken of
  int sites_without_cell = 0;           ///< sites (crown or root) that the guiding surface does not come near
  int steiner_points = 0;               ///< added to make the crown a Delaunay mesh, none left in the tooth
  int crown_triangles_direct = 0;       ///< given by the dual of the restricted Voronoi diagram
  int crown_triangles_restored = 0;     ///< brought back by the restore step
  int non_delaunay_edges_left = 0;      ///< of the crown in spite of the Steiner points
  int triangles_filled = 0;             ///< new triangles that closed gaps which the dual left
  int holes_filled = 0;                 ///< such gaps, and holes of the crown itself
  int remeshing_operations = 0;         ///< edges split, collapsed or turned and vertices moved to mend small angles
  double sharpest_notch_degrees = 180;  ///< at the crown's border, open to the root: no new angle there is larger
  int transition_vertices = 0;
  double transition_width_mm = 0;         ///< of the smoothed band
  double transition_largest_move_mm = 0;  ///< how far smoothing moved a vertex
  std::vector<StageRecord> steps;         ///< the parts of the stage "joining"; peak memory is not taken
};

/// How the tooth came about, grouped as the report is.
struct CompletionRecord {
  int fdi = 0;
  bool fdi_guessed = false;
  double millimetres_per_unit = 1;        ///< of the input's coordinates, which are the tooth's
  std::optional<CrownLikeness> likeness;  ///< not there if the models' folder has nothing to judge by
  FrameRecord frame;
  CrownRecord crown;
  std::vector<RepairStep> repairs;  ///< what was repaired; empty unless asked for
  RootRecord root;
  JoiningRecord joining;
  CheckReport promises;                      ///< evidence for promises 1 and 2, figures for promise 3
  std::map<std::string, std::string> model;  ///< what the network's weights say of themselves: date, samples, seed
  std::map<std::string, std::string> skirt_model;  ///< likewise of the skirt network, if it was asked
  std::vector<StageRecord> stages;
  std::vector<std::string> warnings;
  std::vector<MissedPlace> missed_places;  ///< to be warned of, too: `all_warnings`
};

}  // namespace rhizodont
