// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "families/mean_teeth.hpp"

#include "base/parallel_tasks.hpp"
#include "families/crown_crop.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <utility>

namespace rhizodont {
namespace {

// Even points: the farthest of many random ones.
SurfaceSamples even_samples(const TriangleMesh& mesh, std::size_t count) {
  const SurfaceSamples many = sample_surface(mesh, 12 * count, 7);
  SurfaceSamples even;
  for (int i : farthest_point_sampling(many.points, count)) {
    even.points.push_back(many.points[static_cast<std::size_t>(i)]);
    even.normals.push_back(many.normals[static_cast<std::size_t>(i)]);
  }
  return even;
}

}  // namespace

TriangleMesh mean_crown(const SyntheticTooth& mean) {
  GumLine junction;
  junction.offset_mm = 0.2;
  auto crown = crop_crown(mean, junction);
  if (!crown)
    throw NoResultError("The mean crown of tooth type " + std::to_string(mean.type) + " is not in one piece.");
  return std::move(*crown);
}

Atlas make_atlas(const ToothFamilies& families, std::size_t points) {
  if (points < 64) throw UsageError("A mean crown needs at least 64 points.");
  Atlas atlas;
  parallel_tasks(tooth_type_count, [&](int type) {
    const SyntheticTooth tooth = mean_tooth(families, type);
    const TriangleMesh crown = mean_crown(tooth);
    const CanonicalFrame frame = frame_of_crop(crown, -tooth.crown_turn);
    MeanCrown& mean = atlas.types[static_cast<std::size_t>(type)];
    const SurfaceSamples on_crown = even_samples(crown, points);
    for (const Point& p : on_crown.points) mean.crown.points.push_back(frame.to_canonical(p));
    for (const Eigen::Vector3d& n : on_crown.normals) mean.crown.normals.push_back(frame.direction_to_canonical(n));
    for (const Point& p : even_samples(tooth.mesh, points).points) mean.anchors.push_back(frame.to_canonical(p));
  });
  return atlas;
}

}  // namespace rhizodont
