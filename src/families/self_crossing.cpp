// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Triangle against triangle by their edges (T. Moeller, B. Trumbore, "Fast, minimum storage ray/triangle
// intersection", 1997), candidates from a uniform grid.
#include "families/self_crossing.hpp"

#include "mesh/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace rhizodont {
namespace {

using Cell = Eigen::Array3i;

struct Box {
  Eigen::Array3d low, high;
};

class Crossings {
 public:
  explicit Crossings(const TriangleMesh& mesh) : mesh_(mesh) {
    const std::size_t count = mesh.triangles.size();
    boxes_.reserve(count);
    normals_.reserve(count);
    double extent = 0;
    for (std::size_t t = 0; t < count; ++t) {
      const Eigen::Array3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
      boxes_.push_back({a.min(b).min(c), a.max(b).max(c)});
      extent += (boxes_[t].high - boxes_[t].low).maxCoeff() / static_cast<double>(count);
      normals_.push_back((b - a).matrix().cross((c - a).matrix()));
    }
    const Eigen::AlignedBox3d all = bounding_box(mesh.vertices);
    origin_ = all.min().array();
    // As many cells as triangles cover thinly, and never more than fit into memory for a stray vertex.
    cell_ = std::max(1.2 * extent, all.sizes().maxCoeff() / 200 + 1e-9);
    size_ = ((all.sizes().array() / cell_).floor()).cast<int>() + 1;
    for (const Box& box : boxes_) {
      low_cells_.push_back(cell_of(box.low));
      high_cells_.push_back(cell_of(box.high));
    }
    fill();
  }

  bool any() const {
    for (std::size_t c = 0; c + 1 < start_.size(); ++c)
      for (int i = start_[c]; i < start_[c + 1]; ++i)
        for (int j = i + 1; j < start_[c + 1]; ++j)
          if (meet(c, members_[static_cast<std::size_t>(i)], members_[static_cast<std::size_t>(j)])) return true;
    return false;
  }

 private:
  Eigen::Array3d corner(std::size_t t, std::size_t i) const {
    return mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[t][i])].array();
  }

  Cell cell_of(const Eigen::Array3d& p) const {
    return ((p - origin_) / cell_).floor().cast<int>().max(0).min(size_ - 1);
  }

  std::size_t number(const Cell& c) const {
    return static_cast<std::size_t>((c.z() * size_.y() + c.y()) * size_.x() + c.x());
  }

  template <typename Visit>
  void visit_cells(std::size_t t, const Visit& visit) const {
    const Cell &low = low_cells_[t], &high = high_cells_[t];
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) visit(number(Cell(x, y, z)));
  }

  void fill() {
    start_.assign(static_cast<std::size_t>(size_.prod()) + 1, 0);
    for (std::size_t t = 0; t < boxes_.size(); ++t) visit_cells(t, [&](std::size_t c) { ++start_[c + 1]; });
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    members_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < boxes_.size(); ++t)
      visit_cells(t, [&](std::size_t c) { members_[static_cast<std::size_t>(next[c]++)] = static_cast<int>(t); });
  }

  bool meet(std::size_t cell, int first, int second) const {
    const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(second);
    for (int k = 0; k < 3; ++k)
      if (boxes_[a].low[k] > boxes_[b].high[k] || boxes_[b].low[k] > boxes_[a].high[k]) return false;
    // Each pair is looked at in one of the cells that both lie in.
    if (number(low_cells_[a].max(low_cells_[b])) != cell) return false;
    const Triangle &ta = mesh_.triangles[a], &tb = mesh_.triangles[b];
    int shared = 0;
    std::size_t at_a = 0, at_b = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (ta[i] == tb[j]) ++shared, at_a = i, at_b = j;
    if (shared >= 2) return false;
    if (shared == 1) {
      if (normals_[a].dot(normals_[b]) > 0) return false;
      return pierces(a, (at_a + 1) % 3, (at_a + 2) % 3, b) || pierces(b, (at_b + 1) % 3, (at_b + 2) % 3, a);
    }
    for (std::size_t i = 0; i < 3; ++i)
      if (pierces(a, i, (i + 1) % 3, b) || pierces(b, i, (i + 1) % 3, a)) return true;
    return false;
  }

  // Does the edge from corner i to corner j of one triangle go through the other?
  bool pierces(std::size_t edge, std::size_t i, std::size_t j, std::size_t t) const {
    const Eigen::Vector3d p = corner(edge, i), d = corner(edge, j).matrix() - p;
    const Eigen::Vector3d& n = normals_[t];
    const Eigen::Vector3d from = p - corner(t, 0).matrix();
    const double here = n.dot(from), there = here + n.dot(d);
    if ((here > 0) == (there > 0)) return false;
    const Eigen::Vector3d e1 = (corner(t, 1) - corner(t, 0)).matrix(), e2 = (corner(t, 2) - corner(t, 0)).matrix();
    const Eigen::Vector3d q = from + here / (here - there) * d;
    const double square = n.squaredNorm();
    const double u = q.cross(e2).dot(n) / square, v = e1.cross(q).dot(n) / square;
    return u >= 0 && v >= 0 && u + v <= 1;
  }

  const TriangleMesh& mesh_;
  std::vector<Box> boxes_;
  std::vector<Cell> low_cells_, high_cells_;
  std::vector<Eigen::Vector3d> normals_;
  Eigen::Array3d origin_;
  double cell_ = 1;
  Cell size_;
  std::vector<int> start_, members_;
};

}  // namespace

bool crosses_itself(const TriangleMesh& mesh) { return !mesh.triangles.empty() && Crossings(mesh).any(); }

}  // namespace rhizodont
