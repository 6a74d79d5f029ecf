// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/pose_samples.hpp"

#include "base/parallel_tasks.hpp"
#include "base/random_stream.hpp"
#include "families/crown_crop.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/frame.hpp"
#include "training/completion_sample.hpp"
#include "training/likeness_samples.hpp"
#include "training/panorama_view.hpp"
#include "training/sample_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rhizodont {
namespace {

TriangleMesh draw_crown(const SyntheticTooth& tooth, RandomStream& random) {
  const CompletionSampleOptions samples;
  TriangleMesh crown = draw_cropped_crown(tooth, samples.paper_crop_share, samples.gap_probability, random).mesh;
  if (random.chance(samples.skirt_probability)) add_skirt_remains(crown, samples.skirt_mm, random);
  return crown;
}

/// Towards the cheek, in the generator's own frame.
Eigen::Vector3d buccal_direction(const SyntheticTooth& tooth, const TriangleMesh& crown) {
  return frame_of_crop(crown, -tooth.crown_turn).direction_to_world(Eigen::Vector3d::UnitY());
}

/// The form's axis as a first look finds it.
Eigen::Vector3d beside(const Eigen::Vector3d& axis, RandomStream& random) {
  constexpr double error = 0.06;  // radians, along x and y
  const double x = random.normal(0.0, error), y = random.normal(0.0, error);
  return (axis + Eigen::Vector3d(x, y, 0)).normalized();
}

PanoramaPose pose_in(const SyntheticTooth& tooth, const TriangleMesh& crown, const PanoramaView& view) {
  const Eigen::Matrix3d turn = panorama_view(view.axis);
  const Eigen::Vector3d cheek = turn * buccal_direction(tooth, crown);
  return {std::atan2(cheek.y(), cheek.x()), (turn * tooth.crown_axis).head<2>()};
}

}  // namespace

std::vector<PoseSample> make_pose_samples(const ToothFamilies& families, int type, std::uint64_t seed) {
  constexpr std::uint64_t stream = 800;
  RandomStream random(seed, stream + static_cast<std::uint64_t>(type));
  const SyntheticTooth tooth = generate_tooth(families, type, seed);
  std::vector<PoseSample> samples;
  const auto add = [&](const auto& draw) {
    try {
      const TriangleMesh crown = draw(tooth, random);
      for (const Eigen::Vector3d& axis : {growth_axis(crown), beside(tooth.crown_axis, random)}) {
        const PanoramaView view = view_from_beside(crown, axis, random);
        samples.push_back({crown_panorama(crown, view.axis, view.centre), pose_in(tooth, crown, view)});
      }
    } catch (const Error&) {  // a gum line that leaves nothing
    }
  };
  for (int i = 0; i < 3; ++i) add(draw_crown);
  add(draw_scanned_crown);
  add(draw_low_crown);
  return samples;
}

PosedPanoramas make_posed_panoramas(const ToothFamilies& families, int per_type) {
  std::vector<std::vector<PoseSample>> of_tooth(static_cast<std::size_t>(per_type) * tooth_type_count);
  parallel_tasks(of_tooth.size(), [&](std::size_t i) {
    try {
      of_tooth[i] = make_pose_samples(families, static_cast<int>(i % tooth_type_count), i / tooth_type_count);
    } catch (const NoResultError&) {  // no draw of this seed made a tooth
    }
  });
  PosedPanoramas all;
  all.panoramas = {CrownPanorama::channels, CrownPanorama::rows, CrownPanorama::columns, {}, {}};
  std::size_t count = 0;
  for (const std::vector<PoseSample>& samples : of_tooth) count += samples.size();
  all.panoramas.values.reserve(count * CrownPanorama::channels * CrownPanorama::rows * CrownPanorama::columns);
  for (std::size_t i = 0; i < of_tooth.size(); ++i) {
    for (const PoseSample& sample : of_tooth[i]) {
      std::vector<float>& values = all.panoramas.values;
      values.insert(values.end(), sample.panorama.values.begin(), sample.panorama.values.end());
      all.panoramas.labels.push_back(static_cast<std::int32_t>(i % tooth_type_count));
      all.azimuths.push_back(static_cast<float>(sample.pose.azimuth));
      for (const double lean : sample.pose.form_axis) all.leans.push_back(static_cast<float>(lean));
    }
    of_tooth[i] = {};
  }
  return all;
}

PoseErrors pose_errors(const ToothFamilies& families, const PoseNetwork& network, int per_type) {
  constexpr double degrees = 180 / std::numbers::pi, lost = 30;
  std::vector<PoseErrors> of_crown(static_cast<std::size_t>(per_type) * tooth_type_count);
  parallel_tasks(of_crown.size(), [&](std::size_t i) {
    const int type = static_cast<int>(i % tooth_type_count);
    const std::uint64_t seed = first_validation_sample + i / tooth_type_count;
    RandomStream random(seed, 900 + static_cast<std::uint64_t>(type));
    try {
      const SyntheticTooth tooth = generate_tooth(families, type, seed);
      const TriangleMesh crown = draw_crown(tooth, random);
      const CrownPose said = network.pose_of(crown, fdi_of_type(type, false));
      const double off = degrees * std::acos(std::clamp(said.buccal.dot(buccal_direction(tooth, crown)), -1.0, 1.0));
      const double leans = degrees * std::acos(std::clamp(said.form_axis.dot(tooth.crown_axis), -1.0, 1.0));
      of_crown[i] = {1, off > lost ? 1.0 : 0.0, off > lost ? 0 : off, leans};
    } catch (const Error&) {  // a gum line that leaves nothing
    }
  });
  PoseErrors sum;
  for (const PoseErrors& one : of_crown) {
    sum.crowns += one.crowns;
    sum.lost += one.lost, sum.turn += one.turn, sum.lean += one.lean;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, sum.crowns));
  sum.turn /= std::max(1.0, count - sum.lost);
  sum.lost /= count, sum.lean /= count;
  return sum;
}

}  // namespace rhizodont
