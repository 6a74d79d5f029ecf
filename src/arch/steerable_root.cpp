// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "arch/steerable_root.hpp"

#include "completion/steering.hpp"
#include "rhizodont/error.hpp"
#include "teeth/frame.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace rhizodont {

SteerableRoot steerable_root(const CompletedTooth& unsteered, const RootSteering& start) {
  if (unsteered.options.steering.any())
    throw UsageError("Trials of a root start from a tooth whose root was not steered.");
  require_steering_in_range(start);
  const CompletionRecord& record = unsteered.record;
  SteerableRoot root;
  root.fdi = record.fdi;
  root.triangles = unsteered.mesh.triangles;
  root.source = unsteered.source;
  root.start = start;
  root.length_mm = start.length_mm.value_or(record.root.length_mm);
  root.shortest_mm = root.length_mm;
  if (!start.length_mm && record.root.interval)
    root.shortest_mm =
        std::clamp(record.root.interval->length_low_mm, shortest_root_mm, std::max(root.length_mm, shortest_root_mm));
  root.shortest_mm = std::min(root.shortest_mm, root.length_mm);

  struct Tooth {
    TriangleMesh crown;
    std::vector<Point> vertices;
    CanonicalFrame frame;
    int fdi;
  };
  auto tooth = std::make_shared<Tooth>();
  tooth->vertices = unsteered.mesh.vertices;
  for (Point& p : tooth->vertices) p *= record.millimetres_per_unit;
  const auto kept = static_cast<std::ptrdiff_t>(record.crown.kept_vertices.size());
  tooth->crown.vertices.assign(tooth->vertices.begin(), tooth->vertices.begin() + kept);
  tooth->crown.triangles.assign(unsteered.mesh.triangles.begin(),
                                unsteered.mesh.triangles.begin() + record.crown.kept_triangles);
  tooth->frame.rotation = record.frame.rotation;
  tooth->frame.centre = record.frame.centre;
  tooth->frame.mirrored = record.frame.mirrored;
  tooth->fdi = record.fdi;
  const Eigen::Vector3d down = -tooth->frame.direction_to_world(Eigen::Vector3d::UnitZ());
  const auto steered = [tooth = std::shared_ptr<const Tooth>(std::move(tooth)), kept](const RootSteering& steering) {
    std::vector<Point> points(tooth->vertices.begin() + kept, tooth->vertices.end());
    steer_root(points, tooth->crown, tooth->frame, tooth->fdi, steering);
    std::vector<Point> vertices = tooth->vertices;
    std::copy(points.begin(), points.end(), vertices.begin() + kept);
    return vertices;
  };
  root.vertices = steered;
  root.length = [steered, down, kept](const RootSteering& steering) {
    const std::vector<Point> vertices = steered(steering);
    double crown = std::numeric_limits<double>::lowest(), apex = crown;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      double& deepest = static_cast<std::ptrdiff_t>(v) < kept ? crown : apex;
      deepest = std::max(deepest, vertices[v].dot(down));
    }
    return apex - crown;
  };
  return root;
}

}  // namespace rhizodont
