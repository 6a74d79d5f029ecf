// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "intake/closed_crown.hpp"

#include "base/parallel_tasks.hpp"
#include "completion/registration.hpp"
#include "intake/crown_input.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "skirt/made_cap.hpp"
#include "skirt/skirt.hpp"
#include "teeth/fdi.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// Six axes and eight corners of a cube: no direction is farther than about 35 degrees from one of them.
std::vector<Eigen::Vector3d> starting_directions() {
  std::vector<Eigen::Vector3d> directions;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int count = std::abs(x) + std::abs(y) + std::abs(z);
        if (count == 1 || count == 3) directions.push_back(Eigen::Vector3d(x, y, z).normalized());
      }
  return directions;
}

struct Candidate {
  Cap cap;  // without triangles where no region faces this way
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double badness = 0;  // smaller is better
};

/// How little a region looks like a cap over the base of a crown with this axis.
double unlikeness(const Cap& cap, const Eigen::Vector3d& axis) {
  const double along = std::max(-cap.direction.dot(axis), 1e-3);
  return (0.5 + cap.curvature) / std::max(cap.flatness * cap.share * along * along, 1e-3);
}

/// The residual's share in the badness. It varies far less between right and wrong axes than the cap's figures do (0.70
/// and 0.79 mm beside factors of two), hence the high power.
double misfit(double residual_mm) { return std::pow(residual_mm, 4); }

Candidate along_axis(const TriangleMesh& crown, const Eigen::Vector3d& axis) {
  Candidate candidate;
  candidate.axis = axis;
  try {
    candidate.cap = find_cap(crown, axis);
    candidate.badness = unlikeness(candidate.cap, axis);
  } catch (const InputError&) {
    // No region faces this way: not a candidate.
  }
  return candidate;
}

void sort_by_badness(std::vector<Candidate>& candidates) {
  std::erase_if(candidates, [](const Candidate& c) { return c.cap.triangles == 0; });
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.badness < y.badness; });
}

struct FittedAxis {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double residual_mm = 0;
};

/// Of axes that are next to the same the one that fits best: many fits end in one place.
std::vector<FittedAxis> distinct(std::vector<FittedAxis> axes) {
  constexpr double same = 0.9994;  // cosine of 2 degrees: a cap is found from axes known to 20
  std::stable_sort(axes.begin(), axes.end(),
                   [](const FittedAxis& x, const FittedAxis& y) { return x.residual_mm < y.residual_mm; });
  std::vector<FittedAxis> kept;
  for (const FittedAxis& a : axes)
    if (std::none_of(kept.begin(), kept.end(), [&](const FittedAxis& k) { return k.axis.dot(a.axis) > same; }))
      kept.push_back(a);
  return kept;
}

std::vector<Candidate> for_known_type(const TriangleMesh& crown, const Atlas& atlas, int fdi) {
  const SurfaceSamples samples = sample_surface(crown, 1500, 1);
  const OrientedPoints points{samples.points, samples.normals};
  const MeanCrown& mean = atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))];
  const auto directions = starting_directions();
  std::vector<FittedAxis> axes(directions.size());
  parallel_tasks(directions.size(), [&](std::size_t i) {
    const RigidFit fit = fit_mean_crown(points, mean, is_right_side(fdi), false, directions[i]);
    axes[i] = {fit.frame.direction_to_world(Eigen::Vector3d::UnitZ()), fit.residual_mm};
  });
  axes = distinct(std::move(axes));
  std::vector<Candidate> candidates(axes.size());
  parallel_tasks(axes.size(), [&](std::size_t i) {
    candidates[i] = along_axis(crown, axes[i].axis);
    candidates[i].badness *= misfit(axes[i].residual_mm);
  });
  return candidates;
}

std::vector<Candidate> for_unknown_type(const TriangleMesh& crown, const Atlas& atlas) {
  const auto directions = starting_directions();
  std::vector<Candidate> candidates(directions.size());
  parallel_tasks(directions.size(), [&](std::size_t i) {
    candidates[i] = along_axis(crown, directions[i]);
    if (candidates[i].cap.triangles > 0) candidates[i] = along_axis(crown, -candidates[i].cap.direction);
  });
  sort_by_badness(candidates);
  constexpr std::size_t most_compared = 5;  // comparing with all types takes most of the time
  candidates.resize(std::min(candidates.size(), most_compared));
  for (Candidate& candidate : candidates) {
    std::vector<bool> keep = candidate.cap.is_cap;
    keep.flip();
    const TypeGuess guess = guess_fdi_type(prepare_crown(keep_crown(crown, keep, DropReason::cap).mesh), atlas);
    candidate.badness *= misfit(guess.frame.residual_mm);
  }
  return candidates;
}

}  // namespace

Cap recognise_cap(const TriangleMesh& closed_crown, const Atlas& atlas, std::optional<int> fdi) {
  if (auto is_cap = find_made_cap(closed_crown)) {
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    for (std::size_t t = 0; t < is_cap->size(); ++t)
      if ((*is_cap)[t]) out += triangle_area_vector(closed_crown, t);
    Cap cap = describe_cap(closed_crown, std::move(*is_cap), -out.normalized());
    cap.made = true;
    return cap;
  }
  std::vector<Candidate> candidates =
      fdi ? for_known_type(closed_crown, atlas, *fdi) : for_unknown_type(closed_crown, atlas);
  sort_by_badness(candidates);
  try {
    if (candidates.empty())
      throw InputError(
          "The mesh is closed, and no cap over a crown's base was recognised: give the crown with its base open.");
    require_cap(candidates.front().cap);
  } catch (const InputError&) {
    require_no_root(closed_crown);  // a better reason
    throw;
  }
  return std::move(candidates.front().cap);
}

}  // namespace rhizodont
