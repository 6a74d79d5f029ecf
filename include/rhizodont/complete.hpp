// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/check.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/mesh.hpp"
#include "rhizodont/quality.hpp"
#include "rhizodont/repair_step.hpp"
#include "rhizodont/root_steering.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// What is to happen to a cap that closes the crown's base.
enum class CapHandling { drop, keep };

struct CompleteOptions {
  std::optional<int> fdi;  ///< 11-18, 21-28, 31-38, 41-48; unset: the type is guessed from shape
  double e = 0.5;          ///< mm, [0.2, 2]: side of the lattice under the guiding surface; new edges are about e / 2
  CapHandling cap = CapHandling::drop;
  /// (0, 1): vertices of which the skirt network is less sure that they are tooth are dropped as skirt, with a smooth
  /// border; 0.5 is what it was trained for. Unset: a skirt is kept.
  std::optional<double> skirt;
  bool repair = false;              ///< mend a defective crown first, where else it would be refused; all is listed
  double millimetres_per_unit = 1;  ///< > 0: of the input's coordinates; the output has the input's unit
  /// mm, [0, 5]: width of the smoothed band beside the crown; unset: from the border's edges and from how far the root
  /// misses the border.
  std::optional<double> transition;
  RootSteering steering;  ///< what the user knows or wants of the root
  int threads = 0;        ///< >= 0: at most so many threads, for this call alone; 0: all that the caller may use
};

/// A vertex of the input that the tooth does not have, and why.
struct DroppedCrownVertex {
  int vertex = 0;      ///< index in the input
  std::string reason;  ///< "cap", "unreferenced", "pinched border", "skirt", "spike", or the action of a repair
};

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

/// How the tooth came about.
struct CompletionRecord {
  int fdi = 0;
  bool fdi_guessed = false;
  double millimetres_per_unit = 1;        ///< of the input's coordinates, which are the tooth's
  double type_residual_mm = 0;            ///< mean distance between the crown and its type's mean crown
  std::optional<CrownLikeness> likeness;  ///< not there if the models' folder has nothing to judge by
  RootSource root_source = RootSource::network;
  Eigen::Vector3d growth_axis{0, 0, 1};                          ///< unit, root to crown, in the input's frame
  Eigen::Matrix3d frame_rotation = Eigen::Matrix3d::Identity();  ///< input directions to canonical directions
  Point frame_centre = Point::Zero();                            ///< mm
  bool frame_mirrored = false;
  std::vector<int> kept_vertices;  ///< of the input, ascending: vertex i of the tooth is kept_vertices[i]
  std::vector<DroppedCrownVertex> dropped_vertices;
  std::vector<RepairStep> repairs;  ///< what was repaired; empty unless asked for
  int crown_triangles = 0;          ///< of the input
  int kept_triangles = 0;
  bool cap_dropped = false;
  /// Per vertex of the input, 0..1: how sure the skirt network is that it is tooth; -1 where it was not asked. Empty if
  /// a skirt was to be kept.
  std::vector<float> tooth_confidence;
  std::map<std::string, std::string>
      skirt_model;             ///< what the skirt network's weights say of themselves, if it was asked
  double root_length_mm = 0;   ///< along the growth axis, from the crown's border (lowest point) to the apex
  double tooth_length_mm = 0;  ///< extent along the growth axis
  /// Not there if the user set the length, turned or bent the root, or the weights were never calibrated.
  std::optional<RootInterval> root_interval;
  double apex_expected_distance_mm = 0;  ///< what the network expects of its deepest points, before calibration
  double guiding_distance_mean = 0;      ///< mm, from the kept crown's vertices to the guiding surface
  double guiding_distance_max = 0;
  int guiding_vertices = 0;
  int root_sites = 0;                ///< root vertices that the dual was taken of
  int sites_without_cell = 0;        ///< sites (crown or root) that the guiding surface does not come near
  int steiner_points = 0;            ///< added to make the crown a Delaunay mesh, none left in the tooth
  int crown_triangles_direct = 0;    ///< given by the dual of the restricted Voronoi diagram
  int crown_triangles_restored = 0;  ///< brought back by the restore step
  int non_delaunay_edges_left = 0;   ///< of the crown in spite of the Steiner points
  int triangles_filled = 0;          ///< new triangles that closed gaps which the dual left
  int holes_filled = 0;              ///< such gaps, and holes of the crown itself
  int remeshing_operations = 0;      ///< edges split, collapsed or turned and vertices moved to mend small angles
  double sharpest_notch = 180;       ///< degrees, at the crown's border, open to the root: no new angle there is larger
  int transition_vertices = 0;
  double transition_width_mm = 0;            ///< of the smoothed band
  double transition_largest_move_mm = 0;     ///< how far smoothing moved a vertex
  CheckReport promises;                      ///< evidence for promises 1 and 2, figures for promise 3
  std::map<std::string, std::string> model;  ///< what the network's weights say of themselves: date, samples, seed
  std::vector<StageRecord> stages;
  std::vector<StageRecord> joining_steps;  ///< the parts of the stage "joining"; peak memory is not taken
  std::vector<std::string> warnings;
  std::vector<MissedPlace> missed_places;  ///< to be warned of, too: `all_warnings`
};

/// A whole tooth. Its first vertices and triangles are the kept crown's, in the input's order, bit for bit.
struct CompletedTooth {
  TriangleMesh mesh;                 ///< in the input's unit and frame
  std::vector<VertexSource> source;  ///< per vertex
  std::vector<double> uncertainty;   ///< mm, per vertex: expected distance from the true surface; 0 on the crown
  CompleteOptions options;           ///< that it was made with: those given, of a further candidate with its own length
  CompletionRecord record;
};

/// Weights and mean crowns, loaded once and used for many teeth, from several threads if wished.
class CompletionModels {
 public:
  /// Reads completion.safetensors and atlas.safetensors from a folder, and skirt.safetensors and
  /// likeness.safetensors if they are there. Throws InputError if one is missing or damaged.
  static CompletionModels load(const std::filesystem::path& folder);
  CompletionModels(CompletionModels&&) noexcept;
  CompletionModels& operator=(CompletionModels&&) noexcept;
  ~CompletionModels();

  struct Content;
  const Content& content() const { return *content_; }

 private:
  explicit CompletionModels(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// The files that `CompletionModels::load` reads from a folder. Throws InputError if one that it needs is not there.
std::vector<std::filesystem::path> model_files(const std::filesystem::path& folder);

/// The folder with the shipped models: $RHIZODONT_MODELS, else where they were installed, else the source tree's.
std::filesystem::path default_models_folder();

/// A unit in words ("millimetres"), or its millimetres ("3 mm") where it has no name here.
std::string unit_in_words(double millimetres_per_unit);

/// The millimetres of a unit by its name, in any usual spelling: "mm", "Inches", "um". Throws UsageError for others.
double millimetres_per_unit(const std::string& name);

/// Called with the name of each stage before it begins.
using ProgressCallback = std::function<void(std::string_view stage)>;

/// Completes a scanned crown to a whole tooth, with the crown kept bit for bit (paper, figure 1). The result has been
/// checked: the crown's triangles are found in it and it is a solid, or nothing is returned. With `options.repair`
/// defects are taken out first; the tooth then keeps the repaired crown, which has no coordinate that the input lacks.
///
/// `crown`: open at its base, or closed by a cap that is recognised and dropped; triangles counterclockwise from
/// outside. Throws InputError where the crown cannot be used (empty, not finite, several pieces, inside out,
/// non-manifold edges, wrong size, cutting itself, closed without a cap), UsageError for options out of range,
/// NoResultError where no result keeps the promises.
CompletedTooth complete_tooth(const TriangleMesh& crown, const CompletionModels& models,
                              const CompleteOptions& options = {}, const ProgressCallback& progress = {});

/// Several teeth for one crown that differ in what a crown tells least, the root's length: the expected one first, then
/// `count` - 1 whose lengths are spread evenly over the interval that holds the truth with 80 % probability, shortest
/// first. Each is as checked and as exact as that of `complete_tooth`. `count`: 1 to 9; one only where the length is
/// set by the user. Throws as `complete_tooth`; UsageError for another count or weights without calibration.
std::vector<CompletedTooth> complete_candidates(const TriangleMesh& crown, const CompletionModels& models, int count,
                                                const CompleteOptions& options = {},
                                                const ProgressCallback& progress = {});

}  // namespace rhizodont
