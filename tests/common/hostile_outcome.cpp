// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/hostile_outcome.hpp"

#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>

namespace rhizodont::test {
namespace {

using Kind = HostileOutcome::Kind;

HostileOutcome refusal(const Error& error) {
  const std::string sentence = error.what();
  if (sentence.size() <= 10) return {Kind::other_error, "refused without a reason: " + sentence};
  if (error.code() == ErrorCode::unusable_input) return {Kind::unusable, sentence};
  if (error.code() == ErrorCode::no_result) return {Kind::no_result, sentence};
  return {Kind::other_error, sentence};
}

}  // namespace

std::vector<std::string> broken_promises(const TriangleMesh& crown, const CompletedTooth& tooth) {
  const CompletionRecord& record = tooth.record;
  std::vector<std::string> broken;
  const auto demand = [&broken](bool holds, const std::string& what) {
    if (!holds) broken.push_back(what);
  };
  CheckOptions exact = allowing_for(record.repairs);
  exact.compare_as_float = false;
  exact.least_kept_share = 1e-9;
  const CheckReport report = check(crown, tooth.mesh, exact);
  for (const std::string& failure : report.failures) broken.push_back("exactly: " + failure);
  for (const std::string& failure : check(crown, tooth.mesh, allowing_for(record.repairs)).failures)
    broken.push_back("as a user checks it: " + failure);
  std::set<int> told(record.crown.kept_vertices.begin(), record.crown.kept_vertices.end());
  for (const DroppedCrownVertex& d : record.crown.dropped_vertices)
    demand(told.insert(d.vertex).second, "a vertex is dropped twice, or kept and dropped");
  demand(told.size() == crown.vertices.size(), "not all of the crown's vertices are told of");
  const std::vector<double> numbers{record.root.length_mm,
                                    record.root.tooth_length_mm,
                                    record.joining.guiding_distance_mean_mm,
                                    record.joining.guiding_distance_max_mm,
                                    record.frame.distance_to_mean_crown_mm,
                                    record.frame.growth_axis.sum(),
                                    report.solid.volume};
  demand(std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); }),
         "a number of the report is none");
  demand(
      std::all_of(tooth.mesh.vertices.begin(), tooth.mesh.vertices.end(), [](const Point& p) { return p.allFinite(); }),
      "a coordinate is no number");
  return broken;
}

HostileOutcome outcome_of(const TriangleMesh& crown, const CompletionModels& models, const CompleteOptions& options) {
  try {
    const CompletedTooth tooth = complete_tooth(crown, models, options);
    if (const auto broken = broken_promises(crown, tooth); !broken.empty()) return {Kind::broken, broken.front()};
    const std::vector<std::string> warnings = all_warnings(tooth.record);
    return warnings.empty() ? HostileOutcome{} : HostileOutcome{Kind::warned, warnings.front()};
  } catch (const Error& error) {
    return refusal(error);
  } catch (const std::exception& error) {
    return {Kind::other_error, std::string("not told as an error of ours: ") + error.what()};
  }
}

const char* name_of(Kind kind) {
  switch (kind) {
    case Kind::made:
      return "made";
    case Kind::warned:
      return "warned";
    case Kind::unusable:
      return "unusable";
    case Kind::no_result:
      return "no_result";
    case Kind::broken:
      return "broken";
    case Kind::other_error:
      break;
  }
  return "error";
}

}  // namespace rhizodont::test
