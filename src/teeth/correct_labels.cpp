// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/correct_labels.hpp"

#include "base/disjoint_sets.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

namespace rhizodont {
namespace {

constexpr double farthest_pointed_mm = 2;  // of a place from the tooth that is meant
constexpr double least_part = 0.1;         // of a tooth's vertices, in each part

void require_tooth(int fdi) {
  if (!is_permanent_tooth(fdi) && !is_milk_tooth(fdi)) throw UsageError(fmt::format("There is no tooth {}.", fdi));
}

void require_there(const std::vector<int>& labels, int fdi) {
  require_tooth(fdi);
  if (std::find(labels.begin(), labels.end(), fdi) == labels.end())
    throw UsageError(fmt::format("The scan has no tooth {} to correct.", fdi));
}

int tooth_at(const TriangleMesh& mesh, const std::vector<int>& labels, const Point& at, double millimetres_per_unit) {
  double least = std::numeric_limits<double>::infinity();
  int tooth = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (labels[v] == 0) continue;
    const double distance = (mesh.vertices[v] - at).squaredNorm();
    if (distance < least) {
      least = distance;
      tooth = labels[v];
    }
  }
  if (!(std::sqrt(least) * millimetres_per_unit <= farthest_pointed_mm))
    throw UsageError("There is no tooth at the place that was pointed at: point at its crown.");
  return tooth;
}

/// Number of a tooth along its arch, counted from the patient's right.
int along_arch(int fdi) {
  const int quadrant = (fdi / 10 - 1) % 4, place = fdi % 10;
  return quadrant == 0 || quadrant == 3 ? 8 - place : 7 + place;
}

/// Where the tooth's surface faces: the sum of its area vectors depends on its border alone.
Eigen::Vector3d facing(const TriangleMesh& mesh, const std::vector<int>& labels, int fdi) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    std::array<Point, 3> corners;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(t[k]);
      corners[k] = mesh.vertices[v];
      inside = inside && labels[v] == fdi;
    }
    if (inside) sum += (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }
  const double length = sum.norm();
  return length > 0 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d::UnitZ();
}

/// The tooth's longest direction among those across `up`.
Eigen::Vector3d length_across(const std::vector<Point>& points, const Eigen::Vector3d& up) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Point& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Point& p : points) {
    const Eigen::Vector3d d = p - mean;
    const Eigen::Vector3d across = d - d.dot(up) * up;
    spread += across * across.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

/// > 0 where the teeth that stand nearer to `fdi` than to `old` are nearer to `second` than to `first`.
double vote(const TriangleMesh& mesh, const std::vector<int>& labels, int old, int fdi, const Point& first,
            const Point& second) {
  std::map<int, std::pair<Eigen::Vector3d, double>> others;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    const int other = labels[v];
    if (other == 0 || other == old || jaw_of_fdi(other) != jaw_of_fdi(fdi)) continue;
    auto& [sum, count] = others.try_emplace(other, Eigen::Vector3d::Zero(), 0.0).first->second;
    sum += mesh.vertices[v];
    ++count;
  }
  double votes = 0;
  for (const auto& [other, place] : others) {
    const Point middle = place.first / place.second;
    const double to_first = (middle - first).norm(), to_second = (middle - second).norm();
    const int nearer = std::abs(along_arch(other) - along_arch(old)) - std::abs(along_arch(other) - along_arch(fdi));
    if (nearer != 0 && to_first + to_second > 0)
      votes += (nearer > 0 ? 1 : -1) * (to_first - to_second) / (to_first + to_second);
  }
  return votes;
}

/// Where the plane cuts off more than one piece of a part, all but the largest go to the other one.
void join_islands(const TriangleMesh& mesh, std::vector<int>& part) {
  const auto part_of = [&part](int v) { return part[static_cast<std::size_t>(v)]; };
  DisjointSets pieces(part.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (part_of(a) >= 0 && part_of(a) == part_of(b)) pieces.join(a, b);
    }
  const auto count = static_cast<int>(part.size());
  std::map<int, std::size_t> sizes;
  for (int v = 0; v < count; ++v)
    if (part_of(v) >= 0) ++sizes[pieces.find(v)];
  std::array<int, 2> largest{-1, -1};
  for (const auto& [piece, size] : sizes) {
    int& most = largest[static_cast<std::size_t>(part_of(piece))];
    if (most < 0 || size > sizes[most]) most = piece;
  }
  const std::vector<int> cut = part;
  for (int v = 0; v < count; ++v) {
    const int side = cut[static_cast<std::size_t>(v)];
    if (side >= 0 && pieces.find(v) != largest[static_cast<std::size_t>(side)])
      part[static_cast<std::size_t>(v)] = 1 - side;
  }
}

void split(const TriangleMesh& mesh, std::vector<int>& labels, int old, const LabelCorrection& correction) {
  const int fdi = correction.fdi;
  if (std::find(labels.begin(), labels.end(), fdi) != labels.end())
    throw UsageError(fmt::format("A part of tooth {} cannot be tooth {}: there is one already.", old, fdi));
  std::vector<std::size_t> vertices;
  std::vector<Point> points;
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (labels[v] == old) {
      vertices.push_back(v);
      points.push_back(mesh.vertices[v]);
    }
  const Eigen::Vector3d across = length_across(points, facing(mesh, labels, old));
  std::vector<int> part(labels.size(), -1);
  for (const std::size_t v : vertices) part[v] = across.dot(mesh.vertices[v] - correction.at) > 0 ? 1 : 0;
  join_islands(mesh, part);
  std::array<Eigen::Vector3d, 2> sums{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<std::size_t, 2> counts{};
  for (const std::size_t v : vertices) {
    const auto side = static_cast<std::size_t>(part[v]);
    sums[side] += mesh.vertices[v];
    ++counts[side];
  }
  if (static_cast<double>(std::min(counts[0], counts[1])) < least_part * static_cast<double>(points.size()))
    throw UsageError(
        fmt::format("Tooth {} cannot be divided there, for hardly anything would be left on one side: point at where "
                    "the two teeth meet.",
                    old));
  const double votes =
      vote(mesh, labels, old, fdi, sums[0] / static_cast<double>(counts[0]), sums[1] / static_cast<double>(counts[1]));
  const bool second_is_new = votes != 0 ? votes > 0 : counts[1] < counts[0];
  for (const std::size_t v : vertices)
    if ((part[v] == 1) == second_is_new) labels[v] = fdi;
}

void replace(std::vector<int>& labels, int old, int fdi) { std::replace(labels.begin(), labels.end(), old, fdi); }

std::string correct(const TriangleMesh& mesh, std::vector<int>& labels, const LabelCorrection& correction,
                    double millimetres_per_unit) {
  const int fdi = correction.fdi;
  switch (correction.kind) {
    case LabelCorrection::Kind::number: {
      require_tooth(fdi);
      const int old = tooth_at(mesh, labels, correction.at, millimetres_per_unit);
      if (old == fdi) return fmt::format("Tooth {} is {}, as a person confirmed.", old, fdi);
      const bool is_there = std::find(labels.begin(), labels.end(), fdi) != labels.end();
      for (int& label : labels) label = label == old ? fdi : label == fdi ? old : label;
      return is_there ? fmt::format("The numbers {} and {} were exchanged by a person.", old, fdi)
                      : fmt::format("The number {} was made {} by a person.", old, fdi);
    }
    case LabelCorrection::Kind::merge:
      require_there(labels, fdi);
      require_there(labels, correction.other);
      if (fdi == correction.other) throw UsageError(fmt::format("Tooth {} cannot be merged with itself.", fdi));
      replace(labels, correction.other, fdi);
      return fmt::format("What was tooth {} is a part of tooth {}, said a person.", correction.other, fdi);
    case LabelCorrection::Kind::split: {
      require_tooth(fdi);
      const int old = tooth_at(mesh, labels, correction.at, millimetres_per_unit);
      split(mesh, labels, old, correction);
      return fmt::format("Tooth {} was divided by a person: a part of it is tooth {}.", old, fdi);
    }
    case LabelCorrection::Kind::remove:
      require_there(labels, fdi);
      replace(labels, fdi, 0);
      return fmt::format("There is no tooth {}, said a person: what bore its number is gum.", fdi);
  }
  return {};
}

}  // namespace

CorrectedLabels correct_labels(const TriangleMesh& mesh, std::vector<int> fdi,
                               const std::vector<LabelCorrection>& corrections, double millimetres_per_unit) {
  CorrectedLabels corrected{std::move(fdi), {}};
  for (const LabelCorrection& correction : corrections)
    corrected.notes.push_back(correct(mesh, corrected.fdi, correction, millimetres_per_unit));
  return corrected;
}

}  // namespace rhizodont
