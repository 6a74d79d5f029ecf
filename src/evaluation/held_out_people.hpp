// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evaluation/calibration.hpp"
#include "families/person.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/mesh.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace rhizodont {

/// Generated people who were never trained on, for one purpose each: figures are not taken on whom weights were
/// calibrated on.
enum class HeldOutPeople { for_calibration, for_figures };

/// Person number `number` of them.
PersonDraw held_out_person(HeldOutPeople people, std::uint64_t number);

/// One tooth of a type (0..15) of a person, of the left side for every other person, else of the right, in the frame of
/// FamilyTemplate. Throws as generate_tooth_of_person.
SyntheticTooth held_out_tooth(const ToothFamilies& families, const PersonDraw& person, int type);

/// The crown of a person's tooth, cut where the crowns of training samples are (CompletionSampleOptions). Throws
/// NoResultError where none comes off in one piece.
TriangleMesh held_out_crown(const SyntheticTooth& tooth, const PersonDraw& person);

/// The crown as an intraoral scanner has it: edges of about 0.3 mm, 0.005 mm of noise, by the person's own draw.
TriangleMesh scanned_crown(const TriangleMesh& crown, const PersonDraw& person);

/// A root as it was predicted, and how far its deepest apex is off.
struct PredictedRoot {
  RootOutcome outcome;
  Eigen::Vector3d apex_off = Eigen::Vector3d::Zero();      ///< true apex minus predicted, mm
  Eigen::Vector3d growth_axis = Eigen::Vector3d::UnitZ();  ///< unit, from root to crown
  RootSource source = RootSource::network;                 ///< another one: the first prediction fell to pieces
};

/// The root that is predicted for a crown (open, mm) of a left tooth whose whole is known, as the network's points tell
/// it, before any surface is made of them. Its apex is the middle of its deepest points, for the lowest one lies beyond
/// the surface; it is compared with the nearest true one. Throws as predict_tooth, and InputError for a true tooth that
/// does not reach below the crown.
PredictedRoot predicted_root(const TriangleMesh& crown, const TriangleMesh& truth, int fdi,
                             const CompletionModels& models);

/// The root of a completed tooth. Precondition: the outcome has figures and says how sure the prediction is.
PredictedRoot completed_root(const CaseOutcome& completed, int fdi, const TriangleMesh& crown);

/// By how many mm a completed tooth's root is longer than its points. None where the tooth was refused, where the
/// predictor does not say how sure it is, and where either root is not the network's first one.
std::optional<double> surface_longer(const CaseOutcome& completed, const PredictedRoot& points);

/// The medians by type of what `surface_longer` gives; of a type with fewer than 3, that of all types, and none where
/// there is nothing at all. The keys are kept.
std::map<int, double> surface_longer_by_type(const std::map<int, std::vector<double>>& by_type);

/// The middle value, of an even number the mean of both middle ones. Precondition: not empty.
double median(std::vector<double> values);

/// What became of it had it been predicted longer by `mm`.
RootOutcome lengthened(const PredictedRoot& root, double mm);

}  // namespace rhizodont
