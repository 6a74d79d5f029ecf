// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/labelled_arch.hpp"

#include "mesh/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace rhizodont {
namespace {

struct LabelledTooth {
  Point centre = Point::Zero();  // weighted by area
  double area = 0;
};

struct LabelledTeeth {
  std::vector<Point> centres;  // in the order of their labels
  Eigen::Vector3d facing = Eigen::Vector3d::Zero();
};

/// Teeth by the triangles whose corners all have one label; larger than a stray piece of one.
LabelledTeeth teeth_of(const TriangleMesh& mesh, const std::vector<int>& labels) {
  constexpr double least_share = 0.05;  // of the largest tooth's area
  std::map<int, LabelledTooth> teeth;
  LabelledTeeth result;
  double largest = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto at = [](std::int32_t v) { return static_cast<std::size_t>(v); };
    const int label = labels[at(a)];
    if (label == 0 || labels[at(b)] != label || labels[at(c)] != label) continue;
    const Eigen::Vector3d area = triangle_area_vector(mesh, t);
    LabelledTooth& tooth = teeth[label];
    tooth.centre += area.norm() / 3 * (mesh.vertices[at(a)] + mesh.vertices[at(b)] + mesh.vertices[at(c)]);
    tooth.area += area.norm();
    largest = std::max(largest, tooth.area);
    result.facing += area;
  }
  for (const auto& [label, tooth] : teeth)
    if (tooth.area > 0 && tooth.area >= least_share * largest) result.centres.push_back(tooth.centre / tooth.area);
  return result;
}

}  // namespace

std::optional<bool> labels_run_leftward(const TriangleMesh& mesh, const std::vector<int>& labels, Jaw jaw) {
  constexpr double least_bulge = 0.1;  // of the distance between the end teeth
  const LabelledTeeth teeth = teeth_of(mesh, labels);
  const std::size_t count = teeth.centres.size();
  if (count < 3) return std::nullopt;
  const double length = teeth.facing.norm();
  if (!(length > 0)) return std::nullopt;
  const Eigen::Vector3d up = (jaw == Jaw::upper ? -1.0 : 1.0) / length * teeth.facing;
  const Eigen::Vector3d run = teeth.centres.back() - teeth.centres.front();
  // one tooth in the middle, or two
  const Point middle = (teeth.centres[(count - 1) / 2] + teeth.centres[count / 2]) / 2;
  Eigen::Vector3d front = middle - (teeth.centres.front() + teeth.centres.back()) / 2;
  // how far the row bulges to the side as seen from above; a wave of heights (curve of Spee) is no bulge
  const Eigen::Vector3d along = (run - up * up.dot(run)).normalized();
  front -= up * up.dot(front) + along * along.dot(front);
  if (!(front.norm() > least_bulge * run.norm())) return std::nullopt;
  return up.cross(front).dot(run) > 0;
}

}  // namespace rhizodont
