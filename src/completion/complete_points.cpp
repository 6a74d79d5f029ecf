// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Crown to whole-tooth points: "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", section
// 3.3, with the network in millimetres of the crown's own frame.
#include "completion/complete_points.hpp"

#include "completion/root_length_correction.hpp"
#include "mesh/geometry.hpp"
#include "mesh/sampling.hpp"
#include "networks/completion_shape.hpp"
#include "teeth/fdi.hpp"

namespace rhizodont {

PredictedTooth complete_points(const TriangleMesh& crown, int fdi, const CrownFrame& crown_frame,
                               const CompletionNetwork& network) {
  constexpr std::uint64_t seed = 1;
  const CanonicalFrame& frame = crown_frame.frame;
  const int type = fdi == 0 ? unknown_type : tooth_type_of_fdi(fdi);
  // As many points as in training and as uniform by area: a denser sample thinned to the same number would be more even
  // than anything the network has learned from.
  const SurfaceSamples samples = sample_surface(crown, static_cast<std::size_t>(network.input_points()), seed);
  std::vector<Eigen::Vector3f> points;
  points.reserve(samples.points.size());
  for (const Point& p : samples.points) points.push_back(frame.to_canonical(p).cast<float>());

  const CompletedPoints completed = network.complete(points, type, crown_frame.form_axis.cast<float>());
  PredictedTooth tooth;
  for (std::size_t i = 0; i < completed.points.size(); ++i) {
    tooth.cloud.points.push_back(frame.to_world(completed.points[i].cast<double>()));
    tooth.cloud.normals.push_back(frame.direction_to_world(completed.normals[i].cast<double>()).normalized());
    tooth.expected_distance.push_back(frame.scale * static_cast<double>(completed.spread[i]));
  }
  const Eigen::Vector3d axis = frame.direction_to_world(Eigen::Vector3d::UnitZ());
  lengthen_root(tooth.cloud, axis, extent_along(crown.vertices, axis).first,
                root_length_correction(network.metadata(), fdi));
  return tooth;
}

}  // namespace rhizodont
