// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "completion/complete_points.hpp"
#include "fusion/edge_lengths.hpp"
#include "fusion/fuse.hpp"
#include "fusion/join.hpp"
#include "fusion/root_sites.hpp"
#include "fusion/separate.hpp"
#include "fusion/surface_walk.hpp"
#include "guiding/fitted_surface.hpp"
#include "guiding/guiding_cloud.hpp"
#include "intake/take_crown.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/identify_tooth.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "tables.hpp"
#include "teeth/crown_border.hpp"
#include "teeth/prepared_crown.hpp"
#include "voronoi/delaunay_mesh.hpp"
#include "voronoi/restricted_voronoi.hpp"
#include "voronoi/voronoi_edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace rhizodont {
namespace {

/// A crown with what the pipeline joins it to.
struct CrownCase {
  PreparedCrown crown;
  TriangleMesh surface;
  std::vector<Point> root;
};

CrownCase prepare(const TriangleMesh& input, int fdi, const CompletionModels::Content& models) {
  CompleteOptions options;
  options.fdi = fdi;
  CrownCase result{prepare_crown(take_crown(input, models.atlas, std::nullopt, options).kept.mesh), {}, {}};
  const CrownFrame frame = lay_crown(result.crown, fdi, {}, models);
  const PredictedTooth predicted = complete_points(result.crown.mesh, fdi, frame, models.network);
  result.surface =
      fitted_guiding_surface(assemble_guiding_cloud(result.crown, predicted.cloud), result.crown, options.e).mesh;
  const Eigen::Vector3d axis = frame.frame.direction_to_world(Eigen::Vector3d::UnitZ());
  const auto is_root = separate_crown_and_root(result.surface, crown_distances(result.surface, result.crown), axis);
  const SurfaceWalk walk(result.surface);
  const FuseOptions fuse;
  const EdgeLengths lengths(result.crown.mesh, result.crown.border, mean_edge_length(result.surface), fuse.edge_growth,
                            fuse.edge_shrinkage);
  result.root = root_sites(walk, is_root, result.crown.mesh, result.crown.border, lengths);
  return result;
}

/// Why triangles of the crown, cut by Steiner points, are not in the dual.
struct Reasons {
  int crown_site = 0;        // no Voronoi edge: vertices of the crown are nearer to its axis everywhere
  int root_site = 0;         // likewise with a vertex of the root on one side at least
  int crowded = 0;           // a vertex so near to another that it got no cell
  int no_crossing = 0;       // the guiding surface does not cross the axis
  std::vector<double> gaps;  // mm, ascending: it does, so far from the Voronoi edge
};

struct Share {
  int triangles = 0;
  int direct = 0;  // given by the dual on the guiding surface
  int strong = 0;  // given by the dual on the crown itself
  int both = 0;
  int steiner = 0;
  int edges_left = 0;
  int tested = 0;       // pieces held against the interval test
  int disagreeing = 0;  // that the test judges otherwise than the dual
  Reasons reasons;
};

/// How far from a piece's Voronoi edge the surface crosses its axis (mm): at most 0 if within, infinite if nowhere.
double gap_to_edge(const TriangleMesh& surface, const VoronoiEdge& edge) {
  double gap = std::numeric_limits<double>::infinity();
  if (edge.is_empty()) return gap;
  for (const double at : outward_crossings(surface, edge)) gap = std::min(gap, std::max(edge.low - at, at - edge.high));
  return gap;
}

/// A site of the diagram by its number among all sites, -1 for one that got no cell.
struct Diagram {
  std::vector<Point> sites;
  std::vector<std::int32_t> number;

  explicit Diagram(const Joining& joining) : number(joining.sites.size(), -1) {
    for (std::size_t i = 0; i < joining.sites.size(); ++i) {
      if (!joining.in_diagram[i]) continue;
      number[i] = static_cast<std::int32_t>(sites.size());
      sites.push_back(joining.sites[i]);
    }
  }
};

void examine_pieces(const CrownCase& c, const DelaunayMesh& delaunay, const Joining& joining, Share& share) {
  const Diagram diagram(joining);
  const auto first_root = std::count(
      joining.in_diagram.begin(), joining.in_diagram.begin() + joining.crown_vertices + joining.steiner_points, true);
  constexpr std::size_t every = 5;  // of the pieces that are in the dual is tested
  for (std::size_t i = 0; i < delaunay.mesh.triangles.size(); ++i) {
    const Triangle t = lowest_first(delaunay.mesh.triangles[i]);
    const bool in_dual = std::binary_search(joining.triangles.begin(), joining.triangles.end(), t);
    if (in_dual && i % every != 0) continue;
    const Triangle piece{diagram.number[static_cast<std::size_t>(t[0])], diagram.number[static_cast<std::size_t>(t[1])],
                         diagram.number[static_cast<std::size_t>(t[2])]};
    if (std::min({piece[0], piece[1], piece[2]}) < 0) {
      ++share.reasons.crowded;
      continue;
    }
    const VoronoiEdge edge = voronoi_edge(diagram.sites, piece);
    const double gap = gap_to_edge(c.surface, edge);
    ++share.tested;
    constexpr double rounding = 1e-9;  // mm: the interval test is not exact
    if (in_dual ? gap > rounding : gap < -rounding) ++share.disagreeing;
    if (in_dual) continue;
    if (edge.is_empty()) {
      const bool by_root = edge.low_site >= first_root || edge.high_site >= first_root;
      ++(by_root ? share.reasons.root_site : share.reasons.crown_site);
    } else if (std::isinf(gap)) {
      ++share.reasons.no_crossing;
    } else {
      share.reasons.gaps.push_back(gap);
    }
  }
  std::sort(share.reasons.gaps.begin(), share.reasons.gaps.end());
}

Share measure(const CrownCase& c) {
  const Joining joining = join_crown_and_root(c.crown.mesh, c.root, c.surface);
  const DelaunayMesh delaunay = make_delaunay_mesh(c.crown.mesh);
  const std::vector<bool> strong = triangles_given_by_dual(
      c.crown.mesh, delaunay, restricted_voronoi(delaunay.mesh.vertices, delaunay.mesh).triangles);
  Share share;
  share.triangles = static_cast<int>(c.crown.mesh.triangles.size());
  share.direct = joining.crown_triangles_direct;
  share.steiner = joining.steiner_points;
  share.edges_left = delaunay.edges_left;
  for (std::size_t t = 0; t < strong.size(); ++t) {
    share.strong += strong[t] ? 1 : 0;
    share.both += strong[t] && joining.crown_in_dual[t] ? 1 : 0;
  }
  examine_pieces(c, delaunay, joining, share);
  return share;
}

double percent(int part, int whole) { return 100.0 * part / whole; }

void add(const Share& s, Share& total) {
  total.triangles += s.triangles;
  total.direct += s.direct;
  total.strong += s.strong;
  total.both += s.both;
  total.steiner += s.steiner;
  total.edges_left += s.edges_left;
  total.tested += s.tested;
  total.disagreeing += s.disagreeing;
  total.reasons.crown_site += s.reasons.crown_site;
  total.reasons.root_site += s.reasons.root_site;
  total.reasons.crowded += s.reasons.crowded;
  total.reasons.no_crossing += s.reasons.no_crossing;
  total.reasons.gaps.insert(total.reasons.gaps.end(), s.reasons.gaps.begin(), s.reasons.gaps.end());
  std::sort(total.reasons.gaps.begin(), total.reasons.gaps.end());
}

void print_row(const std::string& name, const Share& s) {
  const auto& gaps = s.reasons.gaps;
  const std::string beside = gaps.empty() ? "0" : fmt::format("{} ({:.3f})", gaps.size(), gaps[gaps.size() / 2]);
  fmt::print("| {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} | {} | {} | {} | {} | {} | {} |\n", name, s.triangles,
             s.steiner, s.edges_left, percent(s.strong, s.triangles), percent(s.direct, s.triangles),
             percent(s.both, s.strong), s.reasons.crown_site, s.reasons.root_site, s.reasons.crowded, beside,
             s.reasons.no_crossing, s.tested, s.disagreeing);
  std::fflush(stdout);
}

}  // namespace

void print_crown_shares(const std::filesystem::path& data_folder) {
  const CompletionModels models = CompletionModels::load(default_models_folder());
  fmt::print(
      "## Crown triangles given by the dual\n\n"
      "Strong: given by the dual on the crown's own surface, after Steiner points. Direct: given on the guiding "
      "surface. Missing pieces (triangles cut by Steiner points) by reason: no Voronoi edge because of other "
      "sites of the crown, or of the root; a vertex without a cell because another crowds it; guiding surface beside "
      "the edge (median distance), or absent.\n\n"
      "| Crown | triangles | Steiner points | edges left | strong % | direct % | direct of strong % | crown's "
      "sites | root's sites | crowded | beside (mm) | absent | interval test: pieces | against the dual |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const char* group : {"validation", "crowns/patient0", "crowns/patient1"}) {
    Share total;
    for (int fdi = 11; fdi <= 48; ++fdi) {
      const auto path = data_folder / group / fmt::format("crown_{}.ply", fdi);
      if (!std::filesystem::exists(path)) continue;
      try {
        const Share s = measure(prepare(load_mesh(path).mesh, fdi, *content_of(models)));
        print_row(fmt::format("{} {}", group, fdi), s);
        add(s, total);
      } catch (const Error& error) {
        fmt::print("| {} {} | {} |\n", group, fdi, error.what());
      }
    }
    print_row(fmt::format("**{}**", group), total);
  }
  fmt::print("\n");
}

}  // namespace rhizodont
