// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/pieces_of_jaws.hpp"

#include "mesh/adjacency.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

// The search reads one arch. Scanners write the two jaws of a person into two files as a rule; where both are in one,
// whoever reads the result is to know that half of it was passed over.

namespace rhizodont {
namespace {

struct JawPiece {
  std::size_t triangles = 0;
  Eigen::AlignedBox3d box;
  std::map<int, std::size_t> corners;  // with a tooth's number
};

std::vector<JawPiece> jaw_pieces(const TriangleMesh& scan, const std::vector<int>& fdi) {
  const ConnectedComponents components = connected_components(scan);
  std::vector<JawPiece> pieces(static_cast<std::size_t>(components.count));
  for (std::size_t t = 0; t < scan.triangles.size(); ++t) {
    JawPiece& piece = pieces[static_cast<std::size_t>(components.of_triangle[t])];
    ++piece.triangles;
    for (const std::int32_t corner : scan.triangles[t]) {
      const auto v = static_cast<std::size_t>(corner);
      piece.box.extend(scan.vertices[v]);
      if (fdi[v] != 0) ++piece.corners[fdi[v]];
    }
  }
  return pieces;
}

/// Teeth by the piece that has most of each.
std::vector<std::size_t> teeth_by_piece(const std::vector<JawPiece>& pieces) {
  std::vector<std::size_t> teeth(pieces.size(), 0);
  std::set<int> numbers;
  for (const JawPiece& piece : pieces)
    for (const auto& [fdi, corners] : piece.corners) numbers.insert(fdi);
  for (const int fdi : numbers) {
    const auto of = [&](const JawPiece& piece) {
      const auto found = piece.corners.find(fdi);
      return found == piece.corners.end() ? std::size_t{0} : found->second;
    };
    const auto most = std::max_element(pieces.begin(), pieces.end(),
                                       [&](const JawPiece& a, const JawPiece& b) { return of(a) < of(b); });
    ++teeth[static_cast<std::size_t>(most - pieces.begin())];
  }
  return teeth;
}

}  // namespace

std::optional<std::string> which_jaw_was_read(const TriangleMesh& scan, const std::vector<int>& fdi,
                                              double millimetres_per_unit) {
  constexpr double least_across_mm = 30, least_share = 0.2;  // of a jaw, of all triangles: crumbs are no jaws
  const std::vector<JawPiece> pieces = jaw_pieces(scan, fdi);
  const std::vector<std::size_t> teeth = teeth_by_piece(pieces);
  std::vector<std::size_t> jaws;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    if (pieces[p].box.diagonal().norm() > least_across_mm &&
        static_cast<double>(pieces[p].triangles) > least_share * static_cast<double>(scan.triangles.size()))
      jaws.push_back(p);
  if (jaws.size() < 2) return std::nullopt;
  std::string where;
  for (const std::size_t p : jaws) {
    const Point middle = pieces[p].box.center() / millimetres_per_unit;
    where += fmt::format("{}{} in the one around ({:.1f}, {:.1f}, {:.1f})", where.empty() ? "" : ", ", teeth[p],
                         middle.x(), middle.y(), middle.z());
  }
  return fmt::format(
      "The scan has {} pieces of a jaw's size, and the search reads one jaw. Teeth found: {}. Write each jaw "
      "into a file of its own.",
      jaws.size(), where);
}

}  // namespace rhizodont
