// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/uncertainty.hpp"
#include "families/tooth_family.hpp"
#include "rhizodont/models.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

struct PeopleCalibrationOptions {
  std::size_t people = 250;     ///< >= 20: one tooth of each type of each of them is predicted
  std::size_t completed = 12;   ///< 1..people: of how many of them the teeth are completed as well
  std::vector<int> types = {};  ///< 0..15; empty: all
  int threads = 0;              ///< >= 0; 0: all
  double largest_bias_mm =
      0.08;  ///< >= 0: what the lengths of a type are off by beyond this, in the mean, is taken back
  std::function<void(std::size_t done, std::size_t of)> progress = {};  ///< called from several threads, one at a time
};

/// What generated people who were never trained on say about weights of the completion network.
struct PeopleCalibration {
  UncertaintyScales all;                     ///< of all types together
  std::map<int, UncertaintyScales> types;    ///< by the FDI number of the type's left tooth, as all below
  std::map<int, double> bias_mm;             ///< root lengths without correction, predicted minus true, mean
  std::map<int, double> median_bias_mm;      ///< likewise, the median
  std::map<int, double> correction_mm;       ///< of the types that are off by more than they may be
  std::map<int, double> surface_longer_mm;   ///< median of a completed tooth's root less that of its points
  std::size_t predicted = 0, completed = 0;  ///< teeth
};

/// Measures on the people for calibration. Of some the teeth are completed, which tells lengths, apices and how far off
/// vertices are; of the others lengths and apices come from the network's points, which are quick to have, with what
/// the surface made of such points changes in length. Completed teeth whose root is not the network's first one count
/// by their points. A correction of lengths that the weights hold already is taken back (`length_before_correction`):
/// to a few hundredths of a millimetre the result is that of weights without one. Scales and correction come from the
/// same teeth, so coverage is to be measured on others. Teeth of which nothing can be predicted are left out; the same
/// for any number of threads. Throws UsageError for an option
/// out of range and where too few teeth are left.
PeopleCalibration calibrate_on_people(const ToothFamilies& families, const CompletionModels& models,
                                      const PeopleCalibrationOptions& options = {});

/// Puts it into a weight file's metadata, in the place of what was there.
void note_calibration(const PeopleCalibration& calibration, std::map<std::string, std::string>& metadata);

/// A table and sentences in Markdown on what was found, for the weights' card.
std::string calibration_text(const PeopleCalibration& calibration);

}  // namespace rhizodont
