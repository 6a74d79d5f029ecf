// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/workplace.hpp"

#include "base/float_bits.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/io.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

namespace rhizodont {
namespace {

/// A triangle that names no vertices is refused later, by its number.
bool has_its_vertices(const TriangleMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::int64_t v) { return v >= 0 && v < count; });
  });
}

MeshOrder same_order(const TriangleMesh& mesh) {
  MeshOrder order{std::vector<int>(mesh.vertices.size()), std::vector<int>(mesh.triangles.size())};
  std::iota(order.vertices.begin(), order.vertices.end(), 0);
  std::iota(order.triangles.begin(), order.triangles.end(), 0);
  return order;
}

/// Finite coordinates of one axis.
std::vector<double> coordinates_along(const TriangleMesh& mesh, Eigen::Index axis) {
  std::vector<double> along;
  along.reserve(mesh.vertices.size());
  for (const Point& p : mesh.vertices)
    if (std::isfinite(p[axis])) along.push_back(p[axis]);
  return along;
}

/// Summed from the smallest coordinate to the largest: the vertices' order has no say in how it is rounded.
Point mean_vertex(const TriangleMesh& mesh) {
  Point mean;
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<double> along = coordinates_along(mesh, k);
    std::sort(along.begin(), along.end());
    mean[k] = std::accumulate(along.begin(), along.end(), 0.0) / static_cast<double>(along.size());
  }
  return mean;
}

Eigen::Matrix3d to_directions(const ToothDirections& directions) {
  const Eigen::Vector3d up = directions.occlusal.normalized();
  const Eigen::Vector3d buccal = (directions.buccal - up.dot(directions.buccal) * up).normalized();
  Eigen::Matrix3d rotation;
  rotation << buccal.transpose(), up.cross(buccal).transpose(), up.transpose();
  return rotation;
}

TriangleMesh moved(TriangleMesh mesh, const Workplace& place) {
  const bool turned = !place.rotation.isIdentity(0);
  for (Point& p : mesh.vertices) {
    p -= place.origin;
    if (turned) p = place.rotation * p;
  }
  return mesh;
}

void number_as_input(RepairStep& step, const MeshOrder& order) {
  // Of a seam, what was merged and what it was merged into stay side by side.
  std::vector<std::pair<int, int>> merged;
  for (std::size_t i = 0; i < step.vertices.size(); ++i)
    merged.emplace_back(order.vertices[static_cast<std::size_t>(step.vertices[i])],
                        step.merged_into.empty() ? 0 : order.vertices[static_cast<std::size_t>(step.merged_into[i])]);
  std::sort(merged.begin(), merged.end());
  for (std::size_t i = 0; i < merged.size(); ++i) {
    step.vertices[i] = merged[i].first;
    if (!step.merged_into.empty()) step.merged_into[i] = merged[i].second;
  }
  for (int& t : step.triangles) t = order.triangles[static_cast<std::size_t>(t)];
  std::sort(step.triangles.begin(), step.triangles.end());
}

}  // namespace

Workplace workplace(const TriangleMesh& input, double millimetres_per_unit,
                    const std::optional<ToothDirections>& directions) {
  constexpr double far_mm = 500, step_mm = 64;
  Workplace place;
  place.millimetres_per_unit = millimetres_per_unit;
  place.as_float = coordinates_fit_float(input);
  place.order = same_order(input);
  Point median;  // a stray vertex somewhere has no say
  for (Eigen::Index k = 0; k < 3; ++k) {
    std::vector<double> along = coordinates_along(input, k);
    if (along.empty()) return place;
    const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
    std::nth_element(along.begin(), half, along.end());
    median[k] = *half;
  }
  place.is_far = median.norm() * millimetres_per_unit > far_mm;
  if (directions && has_its_vertices(input)) {
    place.rotation = to_directions(*directions);
    place.origin = mean_vertex(input);
    place.reordered = true;
    place.order = space_order(moved(input, place), space_order_step_mm / millimetres_per_unit);
  } else if (place.is_far) {
    const double step = std::exp2(std::round(std::log2(step_mm / millimetres_per_unit)));
    place.origin = (median / step).array().round().matrix() * step;
  }
  return place;
}

TriangleMesh at_workplace(const TriangleMesh& input, const Workplace& place) {
  if (place.reordered) return reordered(moved(input, place), place.order);
  return place.origin.isZero(0) ? input : moved(input, place);
}

std::optional<ToothDirections> at_workplace(const std::optional<ToothDirections>& directions, const Workplace& place) {
  if (!directions) return std::nullopt;
  return ToothDirections{place.rotation * directions->occlusal, place.rotation * directions->buccal};
}

void number_as_input(TakenCrown& taken, const Workplace& place) {
  const auto renumber = [](std::vector<int>& ids, const std::vector<int>& in_input) {
    for (int& id : ids) id = in_input[static_cast<std::size_t>(id)];
  };
  renumber(taken.kept.old_vertices, place.order.vertices);
  renumber(taken.kept.old_triangles, place.order.triangles);
  for (DroppedCrownVertex& dropped : taken.kept.dropped)
    dropped.vertex = place.order.vertices[static_cast<std::size_t>(dropped.vertex)];
  std::sort(taken.kept.dropped.begin(), taken.kept.dropped.end(),
            [](const DroppedCrownVertex& a, const DroppedCrownVertex& b) { return a.vertex < b.vertex; });
  std::vector<float> confidence(taken.record.tooth_confidence.size());
  for (std::size_t v = 0; v < confidence.size(); ++v)
    confidence[static_cast<std::size_t>(place.order.vertices[v])] = taken.record.tooth_confidence[v];
  taken.record.tooth_confidence = std::move(confidence);
  for (RepairStep& step : taken.record.repairs) number_as_input(step, place.order);
}

FrameRecord in_input_coordinates(const CrownFrame& found, const Workplace& place) {
  const CanonicalFrame& pose = found.frame;
  const Eigen::Matrix3d back = place.rotation.transpose();
  return {back * pose.direction_to_world(Eigen::Vector3d::UnitZ()), pose.rotation * place.rotation,
          back * pose.centre + place.millimetres_per_unit * place.origin, pose.mirrored, found.residual_mm};
}

TriangleMesh in_input_coordinates(const TriangleMesh& tooth, const TriangleMesh& input, const std::vector<int>& kept,
                                  const Workplace& place) {
  TriangleMesh result = tooth;
  const Eigen::Matrix3d back = place.rotation.transpose();
  for (std::size_t v = 0; v < result.vertices.size(); ++v) {
    Point& p = result.vertices[v];
    if (v < kept.size()) {
      p = input.vertices[static_cast<std::size_t>(kept[v])];
      continue;
    }
    p = back * p / place.millimetres_per_unit + place.origin;
    if (place.as_float) p = nearest_float(p);
  }
  return result;
}

}  // namespace rhizodont
