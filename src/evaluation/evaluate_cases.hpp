// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evaluation/root_figures.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/mesh.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

/// A crown whose whole tooth is known.
struct EvaluationCase {
  int fdi = 0;                         ///< 11-18, 21-28, 31-38, 41-48
  std::string name;                    ///< what tells it from others with that number; may be empty
  std::filesystem::path crown, truth;  ///< mesh files, mm
};

/// All pairs crown_FDI and tooth_FDI, or crown_FDI_NAME and tooth_FDI_NAME (.ply, .stl, .obj, .off, .vtp) of a folder,
/// by FDI number and name. Throws InputError if the folder cannot be read or has no crown, if a crown has no tooth or
/// no permanent tooth's number, or if two files stand for the same.
std::vector<EvaluationCase> find_evaluation_cases(const std::filesystem::path& folder);

/// A whole tooth and, from predictors that know, how sure they are of it.
struct ToothPrediction {
  TriangleMesh mesh;                        ///< mm
  std::optional<RootInterval> interval;     ///< 80 %
  double apex_expected_distance_mm = 0;     ///< before calibration; 0: the predictor does not say
  std::vector<double> uncertainty;          ///< mm per vertex, 0 on the crown; empty: the predictor does not say
  RootSource source = RootSource::network;  ///< where the root comes from; of no account where uncertainty is empty
};

/// A completed tooth as a prediction.
ToothPrediction prediction_of(const CompletedTooth& tooth);

/// Crown (mm) and FDI number to a whole tooth in the same place. May throw any error.
using ToothPredictor = std::function<ToothPrediction(const TriangleMesh& crown, int fdi)>;

struct NamedPredictor {
  std::string name;
  ToothPredictor predict;
};

/// What a predictor said about its own error, and what the error was.
struct UncertaintyFigures {
  std::optional<RootInterval> interval;
  double apex_expected_distance_mm = 0;
  double length_mm = 0;            ///< of the predicted root
  double apex_distance_mm = 0;     ///< of the deepest predicted apex from the true one that is matched to it
  double uncertainty_mm = 0;       ///< mean over the new vertices
  double surface_distance_mm = 0;  ///< mean distance of the new vertices from the true surface
  RootSource source = RootSource::network;
};

/// What became of one crown in the hands of one predictor.
struct CaseOutcome {
  std::optional<RootFigures> figures;
  std::optional<UncertaintyFigures> uncertainty;  ///< of predictors that say how sure they are
  std::string failure;                            ///< a sentence why there are no figures; empty where there are
  double seconds = 0;                             ///< of the prediction alone
};

/// Has one crown (mm, open) completed and compares the tooth with the true one. The axis is that of the crown's border.
/// Whatever goes wrong becomes the outcome's failure, but for UsageError, which is passed on.
CaseOutcome evaluate_case(const ToothPredictor& predict, int fdi, const TriangleMesh& crown, const TriangleMesh& truth,
                          const RootFigureOptions& options = {});

struct EvaluatedCase {
  EvaluationCase files;
  std::vector<CaseOutcome> outcomes;  ///< one per predictor
};

struct Evaluation {
  std::vector<std::string> predictors;  ///< their names
  std::vector<EvaluatedCase> cases;

  /// True if a predictor gave no tooth, or none that could be compared, for one of the crowns.
  bool has_failures() const;
};

/// Called before each prediction with the case, its place among all and the predictor's name.
using EvaluationProgress =
    std::function<void(const EvaluationCase& files, std::size_t place, const std::string& predictor)>;

/// `evaluate_case` of every predictor and every crown, one after the other. Whatever a predictor or a file does wrong
/// becomes the outcome's failure, but for UsageError, which is passed on. Throws UsageError for an option out of range.
Evaluation evaluate_cases(const std::vector<EvaluationCase>& cases, const std::vector<NamedPredictor>& predictors,
                          const RootFigureOptions& options = {}, const EvaluationProgress& progress = {});

/// Means over a set of teeth; 0 where there are none. Lengths in mm, angles in degrees.
struct MeanFigures {
  int teeth = 0;                        ///< over which the means are taken
  double root_length_abs_error_mm = 0;  ///< mean of absolute values
  double root_length_bias_mm = 0;       ///< mean of signed values
  double apex_distance_mm = 0, matched_apex_distance_mm = 0;
  double root_chamfer_mm = 0, root_f_score = 0, root_hausdorff95_mm = 0, root_axis_angle_deg = 0;
  double chamfer_l2_e3 = 0, f_score = 0;
  int right_root_counts = 0;             ///< teeth with as many roots as the true tooth
  int furcations = 0;                    ///< teeth with several roots, true and predicted
  double furcation_height_error_mm = 0;  ///< mean of absolute values over these
};

/// Which teeth means are taken over: those that this predictor completed, or those that every predictor did, so that
/// one that leaves out what is difficult does not seem better.
enum class MeanOver { completed, completed_by_all };
MeanFigures mean_figures(const Evaluation& evaluation, std::size_t predictor, MeanOver over = MeanOver::completed);

/// The same teeth by type, "upper 1" to "lower 8", left and right together; in that order, types without teeth left
/// out.
std::vector<std::pair<std::string, Evaluation>> split_by_type(const Evaluation& evaluation);

/// What cone-beam computed tomography itself can tell about a root, beside which every error must be seen.
struct CbctNoise {
  double root_length_low_mm = -1.23, root_length_high_mm = 1.18;  ///< 95 % limits against extracted premolars
  const char* root_length_source = "https://synapse.koreamed.org/articles/1081059";
  double surface_rms_low_mm = 0.116, surface_rms_high_mm = 0.194;  ///< of the surface, by voxel size
  const char* surface_source = "https://pmc.ncbi.nlm.nih.gov/articles/PMC4910372";
};
/// The same in one line of text.
std::string describe(const CbctNoise& noise);

/// For `nlohmann::ordered_json(value)`. Files appear by name, without folders.
void to_json(nlohmann::ordered_json& json, const RootFigures& figures);
void to_json(nlohmann::ordered_json& json, const MeanFigures& means);
void to_json(nlohmann::ordered_json& json, const Evaluation& evaluation);

/// One line per crown and predictor, a header line first; fields that do not exist are empty.
std::string evaluation_csv(const Evaluation& evaluation);

}  // namespace rhizodont
