// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Intervals by group: split conformal prediction within each tooth type ("Mondrian" categories), after V. Vovk,
// D. Lindsay, I. Nouretdinov, A. Gammerman, "Mondrian confidence machine", 2003. Not in the strict sense: the
// correction of lengths, and by how much surfaces are longer than points, come from the same teeth as the quantiles, so
// their bound on the coverage of further teeth is not proven here. bench_held_out measures that coverage on other
// people.
#include "evaluation/people_calibration.hpp"

#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "base/with_threads.hpp"
#include "completion/root_length_correction.hpp"
#include "evaluation/held_out_people.hpp"
#include "evaluation/predictors.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <vector>

namespace rhizodont {
namespace {

/// One tooth: as points, and of some people completed, unless that is another root than the network's first one.
struct Measured {
  std::optional<PredictedRoot> points, whole;
  CaseOutcome completed;
  std::optional<double> surface_longer;  ///< mm, of the whole than the points
};

Measured measure(const ToothFamilies& families, const CompletionModels& models, std::uint64_t number, int type,
                 bool as_whole) {
  Measured measured;
  try {
    const PersonDraw person = held_out_person(HeldOutPeople::for_calibration, number);
    const SyntheticTooth tooth = held_out_tooth(families, person, type);
    TriangleMesh crown = held_out_crown(tooth, person);
    if (as_whole) crown = scanned_crown(crown, person);
    const int fdi = fdi_of_type(type, false);
    measured.points = predicted_root(crown, tooth.mesh, fdi, models);
    if (as_whole) {
      CompleteOptions options;
      options.threads = 1;  // the teeth go side by side
      measured.completed = evaluate_case(completing_predictor(models, options).predict, fdi, crown, tooth.mesh);
      measured.surface_longer = surface_longer(measured.completed, *measured.points);
      if (measured.surface_longer) measured.whole = completed_root(measured.completed, fdi, crown);
    }
  } catch (const UsageError&) {
    throw;
  } catch (const Error&) {
    // No crown, or none of which a root can be predicted: nothing to learn of intervals.
  }
  return measured;
}

/// What the completed teeth say: scale of the surface, and how much longer it is than points, by type.
void compare_with_whole(const std::vector<Measured>& all, double used_surface, PeopleCalibration& result) {
  Evaluation evaluation;
  evaluation.predictors = {"rhizodont"};
  std::map<int, std::vector<double>> longer;
  for (const Measured& measured : all) {
    if (!measured.points) continue;
    std::vector<double>& of_type = longer[measured.points->outcome.fdi];
    if (!measured.whole) continue;
    evaluation.cases.push_back({{measured.whole->outcome.fdi, "", "", ""}, {measured.completed}});
    of_type.push_back(measured.surface_longer.value());
  }
  result.completed = evaluation.cases.size();
  if (result.completed == 0) throw UsageError("None of the teeth for calibration could be completed.");
  result.surface_longer_mm = surface_longer_by_type(longer);
  result.all.surface = surface_scale(evaluation, 0, used_surface);
}

/// By how much a root is to be longer to be as long as without the weights' own correction, which the mean tooth never
/// has.
double taken_back(const PredictedRoot& root, const std::map<std::string, std::string>& metadata) {
  if (root.source == RootSource::mean_tooth) return 0;
  const double length = root.outcome.length_mm;
  return length_before_correction(length, root_length_correction(metadata, root.outcome.fdi)) - length;
}

/// All roots as completed teeth have them, the weights' own correction taken away.
std::vector<PredictedRoot> uncorrected_roots(const std::vector<Measured>& all, const PeopleCalibration& found,
                                             const std::map<std::string, std::string>& metadata) {
  std::vector<PredictedRoot> roots;
  for (const Measured& measured : all) {
    if (!measured.points) continue;
    const int fdi = measured.points->outcome.fdi;
    PredictedRoot root = measured.whole ? *measured.whole : *measured.points;
    // The points are what was stretched; a surface is longer than they are by the same either way.
    const double by = (measured.whole ? 0 : found.surface_longer_mm.at(fdi)) + taken_back(*measured.points, metadata);
    root.outcome = lengthened(root, by);
    root.apex_off += by * root.growth_axis;
    roots.push_back(root);
  }
  return roots;
}

void require_in_range(const PeopleCalibrationOptions& options) {
  require_ranges("the calibration", {{"people", options.people, OptionRange::at_least(20)},
                                     {"completed", options.completed,
                                      OptionRange::at_least(1).at_most(static_cast<double>(options.people))},
                                     {"threads", options.threads, OptionRange::at_least(0)},
                                     {"largest_bias_mm", options.largest_bias_mm, OptionRange::at_least(0)}});
  for (const int type : options.types)
    require_ranges("the calibration", {{"types", type, OptionRange::at_least(0).below(tooth_type_count)}});
}

std::vector<Measured> measure_all(const ToothFamilies& families, const CompletionModels& models,
                                  const PeopleCalibrationOptions& options) {
  std::vector<int> types = options.types;
  if (types.empty()) {
    types.resize(tooth_type_count);
    std::iota(types.begin(), types.end(), 0);
  }
  std::vector<Measured> all(options.people * types.size());
  std::mutex reporting;
  std::size_t done = 0;
  with_threads(options.threads, [&] {
    parallel_tasks(all.size(), [&](std::size_t i) {
      const std::size_t person = i / types.size();
      all[i] = measure(families, models, person, types[i % types.size()], person < options.completed);
      const std::lock_guard guard(reporting);
      ++done;
      if (options.progress) options.progress(done, all.size());
    });
  });
  return all;
}

}  // namespace

PeopleCalibration calibrate_on_people(const ToothFamilies& families, const CompletionModels& models,
                                      const PeopleCalibrationOptions& options) {
  require_in_range(options);
  const std::vector<Measured> all = measure_all(families, models, options);
  const std::map<std::string, std::string>& metadata = content_of(models)->network.metadata();
  PeopleCalibration result;
  compare_with_whole(all, uncertainty_scales(metadata).value_or(UncertaintyScales{0, 0, 0, 1}).surface, result);
  const std::vector<PredictedRoot> uncorrected = uncorrected_roots(all, result, metadata);
  result.predicted = uncorrected.size();
  std::map<int, std::vector<double>> errors;
  for (const PredictedRoot& root : uncorrected)
    errors[root.outcome.fdi].push_back(root.outcome.length_mm - root.outcome.true_length_mm);
  for (const auto& [fdi, of_type] : errors) {
    result.bias_mm[fdi] = std::accumulate(of_type.begin(), of_type.end(), 0.0) / static_cast<double>(of_type.size());
    result.median_bias_mm[fdi] = median(of_type);
    const double tolerated = std::clamp(result.bias_mm.at(fdi), -options.largest_bias_mm, options.largest_bias_mm);
    if (tolerated != result.bias_mm.at(fdi)) result.correction_mm[fdi] = tolerated - result.bias_mm.at(fdi);
  }
  std::vector<RootOutcome> roots;
  for (const PredictedRoot& root : uncorrected) {
    const auto corrected = result.correction_mm.find(root.outcome.fdi);
    roots.push_back(lengthened(root, corrected == result.correction_mm.end() ? 0 : corrected->second));
  }
  constexpr std::size_t fewest_of_type = 20;
  result.all = interval_scales(roots, result.all.surface);
  result.types = interval_scales_by_type(roots, result.all.surface, fewest_of_type);
  return result;
}

void note_calibration(const PeopleCalibration& calibration, std::map<std::string, std::string>& metadata) {
  note_uncertainty_scales(calibration.all, metadata, calibration.types);
  note_root_length_corrections(calibration.correction_mm, metadata);
  metadata["uncertainty.teeth"] = std::to_string(calibration.predicted);
}

std::string calibration_text(const PeopleCalibration& calibration) {
  std::string text = fmt::format(
      "Scales of the intervals (`uncertainty.*` and `root_length.correction_mm` in the file's metadata) come from {} "
      "teeth of generated people that were never trained on, {} of them completed: `rhizodont-train calibrate`. "
      "Bounds are in units of what the network expects of its deepest points.\n\n"
      "| tooth | surface longer than points, mm | lengths off before, mean, mm | median, mm | corrected by, mm | "
      "length, "
      "lower and upper bound | apex |\n|---|---|---|---|---|---|---|\n",
      calibration.predicted, calibration.completed);
  const auto row = [&](const std::string& name, double longer, double bias, double middle, double corrected,
                       const UncertaintyScales& scales) {
    text += fmt::format("| {} | {:+.2f} | {:+.2f} | {:+.2f} | {:+.2f} | {:+.2f} to {:+.2f} | {:.2f} |\n", name, longer,
                        bias, middle, corrected, scales.length_low, scales.length_high, scales.apex);
  };
  for (const auto& [fdi, bias] : calibration.bias_mm) {
    const auto corrected = calibration.correction_mm.find(fdi);
    const auto scales = calibration.types.find(fdi);
    row(std::to_string(fdi), calibration.surface_longer_mm.at(fdi), bias, calibration.median_bias_mm.at(fdi),
        corrected == calibration.correction_mm.end() ? 0 : corrected->second,
        scales == calibration.types.end() ? calibration.all : scales->second);
  }
  text += fmt::format("\nAll types together: {:+.2f} to {:+.2f}, apex {:.2f}; vertices {:.2f}.\n",
                      calibration.all.length_low, calibration.all.length_high, calibration.all.apex,
                      calibration.all.surface);
  return text;
}

}  // namespace rhizodont
