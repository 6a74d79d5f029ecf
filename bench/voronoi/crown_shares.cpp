// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "completion/complete_points.hpp"
#include "completion/frame.hpp"
#include "fusion/join.hpp"
#include "fusion/separate.hpp"
#include "isosurface/guiding_surface.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/closed_crown.hpp"
#include "pipeline/guiding_cloud.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "skirt/skirt.hpp"
#include "tables.hpp"
#include "voronoi/delaunay_mesh.hpp"
#include "voronoi/voronoi_edge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rhizodont {
namespace {

/// A crown with what the pipeline joins it to.
struct CrownCase {
  TriangleMesh crown;
  TriangleMesh surface;
  std::vector<Point> root;
};

CrownCase prepare(const TriangleMesh& input, int fdi, const CompletionModels::Content& models) {
  CrownCase result;
  std::vector<bool> keep(input.triangles.size(), true);
  if (diagnose(input).border_edges.empty()) {
    const Cap cap = recognise_cap(input, models.atlas, fdi);
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = !cap.is_cap[t];
  }
  result.crown = keep_crown(input, keep, "cap").mesh;
  const CrownFrame frame =
      canonical_frame(result.crown, fdi, models.atlas.types[static_cast<std::size_t>(tooth_type_of_fdi(fdi))]);
  const OrientedPoints predicted = complete_points(result.crown, fdi, frame.frame, models.network);
  const GuidingCloud cloud = assemble_guiding_cloud(result.crown, predicted);
  const std::span<const Point> seeds(cloud.samples.points.data(), static_cast<std::size_t>(cloud.crown_samples));
  result.surface = guiding_surface(cloud.samples, cloud.confidence, seeds).surface.mesh;
  const Eigen::Vector3d axis = frame.frame.direction_to_world(Eigen::Vector3d::UnitZ());
  const Separation separation = separate_crown_and_root(result.surface, result.crown, axis);
  for (std::size_t v = 0; v < result.surface.vertices.size(); ++v)
    if (separation.is_root[v]) result.root.push_back(result.surface.vertices[v]);
  return result;
}

/// Why triangles of the crown, cut by Steiner points, are not in the dual.
struct Reasons {
  int crown_site = 0;        // no Voronoi edge: vertices of the crown are nearer to its axis everywhere
  int root_site = 0;         // likewise with a vertex of the root on one side at least
  int off_edge = 0;          // the guiding surface crosses the axis beyond the Voronoi edge
  int no_crossing = 0;       // or not at all
  std::vector<double> gaps;  // mm, from the edge's end to the crossing
};

struct Share {
  int triangles = 0;
  int direct = 0;
  int steiner = 0;
  int edges_left = 0;
  int strong = 0;  // triangles all of whose pieces the crown's own surface gives
  int both = 0;
  Reasons reasons;
};

Share measure(const CrownCase& c) {
  Share share;
  const Joining joining = join_crown_and_root(c.crown, c.root, c.surface);
  const DelaunayMesh delaunay = make_delaunay_mesh(c.crown);
  share.triangles = static_cast<int>(c.crown.triangles.size());
  share.direct = joining.crown_triangles_direct;
  share.steiner = joining.steiner_points;
  share.edges_left = delaunay.edges_left;

  const StrongDelaunay own = test_strong_delaunay(delaunay.mesh);
  std::vector<bool> strong(c.crown.triangles.size(), true);
  for (std::size_t t = 0; t < delaunay.mesh.triangles.size(); ++t)
    if (!own.triangle_in_dual[t]) strong[static_cast<std::size_t>(delaunay.parent_triangle[t])] = false;
  for (std::size_t t = 0; t < strong.size(); ++t) {
    share.strong += strong[t] ? 1 : 0;
    share.both += strong[t] && joining.crown_in_dual[t] ? 1 : 0;
  }

  const int first_root = joining.crown_vertices + joining.steiner_points;
  for (const Triangle& t : delaunay.mesh.triangles) {
    if (std::binary_search(joining.triangles.begin(), joining.triangles.end(), lowest_first(t))) continue;
    const VoronoiEdge edge = voronoi_edge(joining.sites, t);
    if (edge.is_empty()) {
      ++(edge.low_site >= first_root || edge.high_site >= first_root ? share.reasons.root_site
                                                                     : share.reasons.crown_site);
      continue;
    }
    double gap = 1e9;
    for (const double at : outward_crossings(c.surface, edge))
      gap = std::min(gap, std::max({0.0, edge.low - at, at - edge.high}));
    if (gap > 1e8) {
      ++share.reasons.no_crossing;
    } else {
      ++share.reasons.off_edge;
      share.reasons.gaps.push_back(gap);
    }
  }
  return share;
}

double percent(int part, int whole) { return 100.0 * part / whole; }

}  // namespace

void print_crown_shares(const std::filesystem::path& data_folder) {
  const CompletionModels models = CompletionModels::load(default_models_folder());
  fmt::print("## Crown triangles given by the dual\n\n");
  fmt::print(
      "| Crown | triangles | Steiner points | edges left | strong-Delaunay % | direct % | direct of strong % | "
      "missing pieces: crown's sites | root's sites | surface off the edge (median mm) | surface absent |\n");
  fmt::print("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const char* group : {"validation", "crowns/patient0", "crowns/patient1"}) {
    Share total;
    for (int fdi = 11; fdi <= 48; ++fdi) {
      const auto path = data_folder / group / fmt::format("crown_{}.ply", fdi);
      if (!std::filesystem::exists(path)) continue;
      try {
        Share s = measure(prepare(load_mesh(path).mesh, fdi, models.content()));
        std::sort(s.reasons.gaps.begin(), s.reasons.gaps.end());
        const double median = s.reasons.gaps.empty() ? 0 : s.reasons.gaps[s.reasons.gaps.size() / 2];
        fmt::print("| {} {} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} | {} | {} ({:.3f}) | {} |\n", group, fdi,
                   s.triangles, s.steiner, s.edges_left, percent(s.strong, s.triangles), percent(s.direct, s.triangles),
                   percent(s.both, s.strong), s.reasons.crown_site, s.reasons.root_site, s.reasons.off_edge, median,
                   s.reasons.no_crossing);
        total.triangles += s.triangles;
        total.direct += s.direct;
        total.strong += s.strong;
        total.both += s.both;
      } catch (const Error& error) {
        fmt::print("| {} {} | {} |\n", group, fdi, error.what());
      }
      std::fflush(stdout);
    }
    fmt::print("| {} together | {} | | | {:.2f} | {:.2f} | {:.2f} | | | | |\n", group, total.triangles,
               percent(total.strong, total.triangles), percent(total.direct, total.triangles),
               percent(total.both, total.strong));
  }
  fmt::print("\n");
}

}  // namespace rhizodont
