// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluation/held_out_people.hpp"

#include "completion/uncertainty.hpp"
#include "evaluation/root_apices.hpp"
#include "evaluation/root_figures.hpp"
#include "families/crown_crop.hpp"
#include "families/scanner_mesh.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/models.hpp"
#include "pipeline/prediction.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/prepared_crown.hpp"
#include "training/completion_sample.hpp"
#include "training/sample_numbers.hpp"

#include <algorithm>
#include <cstddef>

namespace rhizodont {

namespace {

/// The middle of the deepest points around the lowest.
Point apex_of(const std::vector<Point>& points, const Eigen::Vector3d& axis) {
  constexpr std::size_t deepest = 12;
  constexpr double radius_mm = 2;  // no other root's tip is as near
  const auto is_lower = [&](const Point& a, const Point& b) { return a.dot(axis) < b.dot(axis); };
  const Point lowest = *std::min_element(points.begin(), points.end(), is_lower);
  std::vector<Point> near;
  for (const Point& p : points)
    if ((p - lowest).norm() < radius_mm) near.push_back(p);
  std::stable_sort(near.begin(), near.end(), is_lower);
  near.resize(std::min(near.size(), deepest));
  Point sum = Point::Zero();
  for (const Point& p : near) sum += p;
  return sum / static_cast<double>(near.size());
}

}  // namespace

PersonDraw held_out_person(HeldOutPeople people, std::uint64_t number) {
  constexpr std::uint64_t calibration = 8'000'000, figures = 9'000'000;  // far from other uses of such numbers
  return draw_person(first_validation_sample + (people == HeldOutPeople::for_figures ? figures : calibration) + number);
}

SyntheticTooth held_out_tooth(const ToothFamilies& families, const PersonDraw& person, int type) {
  return generate_tooth_of_person(families, fdi_of_type(type, person.seed % 2 == 1), person);
}

TriangleMesh held_out_crown(const SyntheticTooth& tooth, const PersonDraw& person) {
  constexpr std::uint64_t stream = 500;
  const CompletionSampleOptions samples;
  RandomStream random(person.seed, stream + static_cast<std::uint64_t>(tooth.type));
  return draw_cropped_crown(tooth, samples.paper_crop_share, samples.gap_probability, random).mesh;
}

TriangleMesh scanned_crown(const TriangleMesh& crown, const PersonDraw& person) {
  constexpr double edge_mm = 0.3, noise_mm = 0.005;
  return scanner_mesh(crown, edge_mm, noise_mm, person.seed);
}

PredictedRoot predicted_root(const TriangleMesh& crown, const TriangleMesh& truth, int fdi,
                             const CompletionModels& models) {
  const CompletionModels::Content& content = *content_of(models);
  const CrownFrame frame = lay_crown(prepare_crown(crown), fdi, {}, content);
  const RootPrediction predicted =
      predict_tooth(crown, fdi, frame, content, [](const RootPrediction&) { return true; });
  PredictedRoot root;
  root.source = predicted.source;
  const Eigen::Vector3d axis = root.growth_axis = crown_growth_axis(crown);
  const double level = extent_along(crown.vertices, axis).first;
  const Point apex = apex_of(predicted.tooth.cloud.points, axis);
  root.outcome.fdi = fdi;
  root.outcome.length_mm = level - apex.dot(axis);
  root.outcome.true_length_mm = level - extent_along(truth.vertices, axis).first;
  const std::vector<RootApex> apices = root_apices(truth, axis, level, RootFigureOptions().least_prominence_mm);
  if (apices.empty()) throw InputError("The true tooth has no root below the crown.");
  root.apex_off = apices.front().point - apex;
  for (const RootApex& other : apices)
    if ((other.point - apex).norm() < root.apex_off.norm()) root.apex_off = other.point - apex;
  root.outcome.apex_distance_mm = root.apex_off.norm();
  root.outcome.expected_distance_mm = expected_distance_at_apex(predicted.tooth, axis);
  return root;
}

PredictedRoot completed_root(const CaseOutcome& completed, int fdi, const TriangleMesh& crown) {
  const RootFigures& figures = completed.figures.value();
  const UncertaintyFigures& said = completed.uncertainty.value();
  PredictedRoot root;
  root.growth_axis = crown_growth_axis(crown);
  root.outcome = {fdi, said.length_mm, figures.true_root_length_mm, said.apex_distance_mm,
                  said.apex_expected_distance_mm};
  root.apex_off = figures.root_length_error_mm * root.growth_axis;  // for want of a pair; else:
  for (const ApexPair& pair : figures.matched_apices)
    if (pair.predicted == 0) root.apex_off = figures.true_apices[pair.truth].point - figures.predicted_apices[0].point;
  return root;
}

std::optional<double> surface_longer(const CaseOutcome& completed, const PredictedRoot& points) {
  if (!completed.figures || !completed.uncertainty) return std::nullopt;
  if (completed.uncertainty->source != RootSource::network || points.source != RootSource::network) return std::nullopt;
  return completed.uncertainty->length_mm - points.outcome.length_mm;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

std::map<int, double> surface_longer_by_type(const std::map<int, std::vector<double>>& by_type) {
  constexpr std::size_t fewest = 3;
  std::vector<double> all;
  for (const auto& [fdi, of_type] : by_type) all.insert(all.end(), of_type.begin(), of_type.end());
  std::map<int, double> result;
  if (all.empty()) return result;
  for (const auto& [fdi, of_type] : by_type) result[fdi] = median(of_type.size() < fewest ? all : of_type);
  return result;
}

RootOutcome lengthened(const PredictedRoot& root, double mm) {
  RootOutcome outcome = root.outcome;
  outcome.length_mm += mm;
  outcome.apex_distance_mm = (root.apex_off + mm * root.growth_axis).norm();
  return outcome;
}

}  // namespace rhizodont
