// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/clean_labels.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace rhizodont {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// Vertices of one label that hang together over edges.
struct LabelPiece {
  int number = 0;
  std::vector<int> vertices;  // ascending
  double area = 0;            // a third of the triangles around each vertex
};

Point middle_of(const TriangleMesh& mesh, const LabelPiece& piece) {
  Point sum = Point::Zero();
  for (const int v : piece.vertices) sum += mesh.vertices[at(v)];
  return sum / static_cast<double>(piece.vertices.size());
}

std::vector<double> vertex_areas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double third = triangle_area(mesh, t) / 3;
    for (const std::int32_t v : mesh.triangles[t]) areas[at(v)] += third;
  }
  return areas;
}

double gap_between(const TriangleMesh& mesh, const LabelPiece& a, const LabelPiece& b) {
  std::vector<Point> points;
  for (const int v : a.vertices) points.push_back(mesh.vertices[at(v)]);
  const NearestVertexIndex index(std::move(points));
  double least = std::numeric_limits<double>::infinity();
  for (const int v : b.vertices) least = std::min(least, index.nearest(mesh.vertices[at(v)]).squared_distance);
  return std::sqrt(least);
}

class LabelCleaner {
 public:
  LabelCleaner(const TriangleMesh& mesh, const std::vector<int>& fdi, const CleanLabelOptions& options)
      : mesh_(mesh), options_(options), edges_(edge_table(mesh)), labels_(fdi), areas_(vertex_areas(mesh)) {
    neighbours_.resize(mesh.vertices.size());
    is_border_.assign(mesh.vertices.size(), false);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const auto [a, b] = edges_.vertices[e];
      neighbours_[at(a)].push_back(b);
      neighbours_[at(b)].push_back(a);
      if (edges_.triangle_count(e) == 1) is_border_[at(a)] = is_border_[at(b)] = true;
    }
  }

  /// Goes on until nothing is left to take out: what an island became may be an island again.
  CleanedLabels clean() {
    do take_out_islands();
    while (!islands_.empty());
    std::sort(changes_.begin(), changes_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    CleanedLabels result;
    result.fdi = std::move(labels_);
    for (auto& [order, change] : changes_) result.changes.push_back(change);
    return result;
  }

 private:
  void take_out_islands() {
    find_pieces();
    islands_.clear();
    std::erase_if(changes_, [](const auto& change) { return !change.second.became; });
    for (const auto& [number, pieces] : by_number_) number == 0 ? judge_gum(pieces) : judge_tooth(pieces);
    if (!far_apart_.empty()) throw InputError(far_apart_, far_vertices_, ElementKind::vertices);
    // small ones first: what they lie in may itself be an island
    std::sort(islands_.begin(), islands_.end(), [&](std::size_t a, std::size_t b) {
      return std::tuple(pieces_[a].area, pieces_[a].vertices.front()) <
             std::tuple(pieces_[b].area, pieces_[b].vertices.front());
    });
    for (const std::size_t p : islands_) take_out(pieces_[p]);
  }

  void find_pieces() {
    pieces_.clear();
    by_number_.clear();
    DisjointSets sets(mesh_.vertices.size());
    for (const auto& [a, b] : edges_.vertices)
      if (labels_[at(a)] == labels_[at(b)]) sets.join(a, b);
    std::map<int, std::size_t> piece_of_set;
    for (std::size_t v = 0; v < labels_.size(); ++v) {
      if (neighbours_[v].empty()) continue;  // no surface
      const auto [place, is_new] = piece_of_set.try_emplace(sets.find(static_cast<int>(v)), pieces_.size());
      if (is_new) {
        by_number_[labels_[v]].push_back(pieces_.size());
        pieces_.push_back({labels_[v], {}, 0});
      }
      pieces_[place->second].vertices.push_back(static_cast<int>(v));
      pieces_[place->second].area += areas_[v];
    }
  }

  void judge_tooth(const std::vector<std::size_t>& pieces) {
    const std::size_t largest = *std::max_element(
        pieces.begin(), pieces.end(), [&](std::size_t a, std::size_t b) { return pieces_[a].area < pieces_[b].area; });
    const double area = pieces_[largest].area;
    if (area < options_.least_tooth_area) {
      islands_.insert(islands_.end(), pieces.begin(), pieces.end());
      return;
    }
    for (const std::size_t p : pieces) {
      if (p == largest) continue;
      const LabelPiece& piece = pieces_[p];
      if (piece.area < std::max(options_.island_area, options_.island_share * area)) {
        islands_.push_back(p);
        continue;
      }
      const double gap = gap_between(mesh_, pieces_[largest], piece);
      const bool is_big = piece.area >= std::max(options_.big_share * area, options_.least_tooth_area);
      if (gap <= (is_big ? options_.tooth_gap : options_.near_gap))
        list(piece, std::nullopt);
      else if (is_big)
        refuse(pieces_[largest], piece, gap);
      else
        islands_.push_back(p);
    }
  }

  // Gum within one tooth; between two teeth, or at the scan's border, it is gum indeed.
  void judge_gum(const std::vector<std::size_t>& pieces) {
    for (const std::size_t p : pieces) {
      const LabelPiece& piece = pieces_[p];
      const bool at_border =
          std::any_of(piece.vertices.begin(), piece.vertices.end(), [&](int v) { return is_border_[at(v)]; });
      const std::map<int, int> beside = around(piece);
      if (at_border || beside.size() != 1) continue;
      double area_of_tooth = 0;
      for (const std::size_t tooth : by_number_.at(beside.begin()->first)) area_of_tooth += pieces_[tooth].area;
      if (piece.area < std::max(options_.island_area, options_.island_share * area_of_tooth)) islands_.push_back(p);
    }
  }

  /// Labels beside a piece with the number of edges to them.
  std::map<int, int> around(const LabelPiece& piece) const {
    std::map<int, int> counts;
    for (const int v : piece.vertices)
      for (const int n : neighbours_[at(v)])
        if (!std::binary_search(piece.vertices.begin(), piece.vertices.end(), n)) ++counts[labels_[at(n)]];
    return counts;
  }

  void take_out(const LabelPiece& piece) {
    const std::map<int, int> counts = around(piece);
    // of equal counts the first, lowest: gum, if it is among them
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    const int became = most == counts.end() ? 0 : most->first;
    for (const int v : piece.vertices) labels_[at(v)] = became;
    list(piece, became);
  }

  void list(const LabelPiece& piece, std::optional<int> became) {
    changes_.push_back({{piece.number, piece.vertices.front()},
                        {piece.number, piece.vertices.size(), middle_of(mesh_, piece), piece.area, became}});
  }

  void refuse(const LabelPiece& first, const LabelPiece& second, double gap) {
    const Point a = middle_of(mesh_, first), b = middle_of(mesh_, second);
    far_apart_ += fmt::format(
        "{}number {} is on two teeth {:.1f} mm apart, at ({:.1f}, {:.1f}, {:.1f}) and ({:.1f}, {:.1f}, {:.1f})",
        far_apart_.empty() ? "" : "; ", first.number, gap, a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    far_vertices_.insert(far_vertices_.end(), second.vertices.begin(), second.vertices.end());
  }

  const TriangleMesh& mesh_;
  const CleanLabelOptions& options_;
  EdgeTable edges_;
  std::vector<int> labels_;
  std::vector<double> areas_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<bool> is_border_;
  std::vector<LabelPiece> pieces_;
  std::map<int, std::vector<std::size_t>> by_number_;
  std::vector<std::size_t> islands_;
  std::vector<std::pair<std::pair<int, int>, LabelChange>> changes_;  // with number and first vertex
  std::string far_apart_;
  std::vector<std::int64_t> far_vertices_;
};

}  // namespace

CleanedLabels clean_labels(const TriangleMesh& mesh, const std::vector<int>& fdi, const CleanLabelOptions& options) {
  if (fdi.size() != mesh.vertices.size())
    throw UsageError(fmt::format("{} labels are given for {} vertices", fdi.size(), mesh.vertices.size()));
  return LabelCleaner(mesh, fdi, options).clean();
}

std::string describe(const LabelChange& change) {
  const std::string what = change.number == 0 ? "A hole of gum" : fmt::format("A piece of {}", change.number);
  const std::string where = fmt::format("({} {}, {:.2f} mm2) at ({:.1f}, {:.1f}, {:.1f})", change.vertices,
                                        change.vertices == 1 ? "vertex" : "vertices", change.area, change.at.x(),
                                        change.at.y(), change.at.z());
  if (!change.became) return fmt::format("{} {} stays a second piece of the tooth.", what, where);
  if (*change.became == 0) return fmt::format("{} {} became gum.", what, where);
  return fmt::format("{} {} became {} like what is around it.", what, where, *change.became);
}

}  // namespace rhizodont
