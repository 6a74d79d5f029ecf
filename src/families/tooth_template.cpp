// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// From template files to families: own frame, junction, roots.
// Roots are found from the merge tree of the height function (H. Carr, J. Snoeyink, U. Axen, "Computing contour trees
// in all dimensions", 2003): swept from below, every lasting minimum is an apex, the level where two meet is a
// furcation. Simplification: P. Lindstrom, G. Turk, "Fast and memory efficient polygonal simplification", 1998 (CGAL).
#include "families/tooth_template.hpp"

#include "base/disjoint_sets.hpp"
#include "mesh/geometry.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/principal_axis.hpp"
#include "mesh/self_intersection.hpp"
#include "rhizodont/error.hpp"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace rhizodont {
namespace {

constexpr double apex_persistence_mm = 1.2;  // shorter bumps on a root's tip are not roots

// An unlabelled template: its long axis, the wider end up, and the crown's usual share of the length.
std::vector<std::uint8_t> estimated_crown(const TriangleMesh& mesh, double crown_share) {
  Eigen::Vector3d axis = principal_axis(mesh.vertices);
  double low = std::numeric_limits<double>::max(), high = -low;
  for (const Point& p : mesh.vertices) low = std::min(low, p.dot(axis)), high = std::max(high, p.dot(axis));
  std::array<std::vector<Point>, 2> ends;
  for (const Point& p : mesh.vertices) {
    const double t = (p.dot(axis) - low) / (high - low);
    if (t < 0.3) ends[0].push_back(p);
    if (t > 0.7) ends[1].push_back(p);
  }
  const auto width = [&axis](const std::vector<Point>& points) {
    Point mean = Point::Zero();
    for (const Point& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double sum = 0;
    for (const Point& p : points) sum += (p - mean).squaredNorm() - std::pow((p - mean).dot(axis), 2);
    return sum / static_cast<double>(points.size());
  };
  const bool up = width(ends[1]) > width(ends[0]);
  std::vector<std::uint8_t> crown;
  for (const Point& p : mesh.vertices) {
    const double from_top = up ? high - p.dot(axis) : p.dot(axis) - low;
    crown.push_back(from_top < crown_share * (high - low) ? 1 : 0);
  }
  return crown;
}

Eigen::Vector3d crown_area_vector(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    if (std::all_of(corners.begin(), corners.end(), [&](int v) { return crown[static_cast<std::size_t>(v)] == 1; }))
      sum += triangle_area_vector(mesh, t);
  }
  return sum;
}

std::vector<Point> junction_points(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown) {
  std::vector<Point> points;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto a = static_cast<std::size_t>(t[static_cast<std::size_t>(i)]);
      const auto b = static_cast<std::size_t>(t[static_cast<std::size_t>((i + 1) % 3)]);
      if (crown[a] != crown[b] && a < b) points.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    }
  }
  return points;
}

// A plane and the two saddle-shaped quadratics: the first two harmonics around the neck, without a bulge amid it that
// the border could not determine.
JunctionHeight fit_junction(const std::vector<Point>& points) {
  JunctionHeight junction;
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  for (const Point& p : points) half = half.cwiseMax(p.head<2>().cwiseAbs());
  Eigen::MatrixXd design(static_cast<Eigen::Index>(points.size()), 5);
  Eigen::VectorXd height(static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points[i].x() / half.x(), y = points[i].y() / half.y();
    design.row(static_cast<Eigen::Index>(i)) << 1, x, y, x * x - y * y, x * y;
    height[static_cast<Eigen::Index>(i)] = points[i].z();
  }
  const Eigen::VectorXd c = design.colPivHouseholderQr().solve(height);
  junction.coefficients = {c[0],
                           c[1] / half.x(),
                           c[2] / half.y(),
                           c[3] / (half.x() * half.x()),
                           c[4] / (half.x() * half.y()),
                           -c[3] / (half.y() * half.y())};
  junction.half_width = half;
  return junction;
}

std::vector<std::vector<int>> vertex_neighbours(const TriangleMesh& mesh) {
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) neighbours[static_cast<std::size_t>(t[i])].push_back(t[(i + 1) % 3]);
  return neighbours;
}

// Simplification may fold deep fissures: vertices of crossing triangles move towards their neighbours' mean.
void relax_crossings(TriangleMesh& mesh) {
  std::vector<std::vector<int>> neighbours;
  for (int round = 0; round < 30; ++round) {
    const auto pairs = self_intersecting_triangles(mesh);
    if (pairs.empty()) return;
    if (neighbours.empty()) neighbours = vertex_neighbours(mesh);
    std::set<int> moved;
    for (const auto& [a, b] : pairs)
      for (int t : {a, b})
        for (int v : mesh.triangles[static_cast<std::size_t>(t)]) moved.insert(v);
    const std::vector<Point> before = mesh.vertices;
    for (int v : moved) {
      const auto& around = neighbours[static_cast<std::size_t>(v)];
      Point mean = Point::Zero();
      for (int w : around) mean += before[static_cast<std::size_t>(w)] / static_cast<double>(around.size());
      Point& p = mesh.vertices[static_cast<std::size_t>(v)];
      p = 0.5 * (p + mean);
    }
  }
}

// Sweeps from the apices up; a vertex gets the label of the part it belonged to before that met another lasting one.
void find_roots(FamilyTemplate& tooth) {
  const std::vector<Point>& vertices = tooth.mesh.vertices;
  const auto neighbours = vertex_neighbours(tooth.mesh);
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto z = [&vertices](int v) { return vertices[static_cast<std::size_t>(v)].z(); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return z(a) != z(b) ? z(a) < z(b) : a < b; });

  DisjointSets parts(vertices.size());
  std::vector<int> lowest(vertices.size(), -1);  // of a part, at the vertex that stands for it; -1: not reached yet
  std::vector<std::vector<int>> members(vertices.size());
  std::vector<bool> closed(vertices.size(), false);  // set has met another lasting one: no longer a single root
  tooth.root.assign(vertices.size(), -1);
  const auto close = [&](int set) {
    if (closed[static_cast<std::size_t>(set)]) return;
    TemplateRoot root;
    root.apex = static_cast<std::size_t>(lowest[static_cast<std::size_t>(set)]);
    root.branch_z = -std::numeric_limits<double>::max();
    for (int v : members[static_cast<std::size_t>(set)]) {
      tooth.root[static_cast<std::size_t>(v)] = static_cast<int>(tooth.roots.size());
      root.branch_z = std::max(root.branch_z, z(v));
    }
    tooth.roots.push_back(root);
    closed[static_cast<std::size_t>(set)] = true;
  };
  for (int v : order) {
    if (z(v) > 0) break;
    lowest[static_cast<std::size_t>(v)] = v;
    members[static_cast<std::size_t>(v)] = {v};
    for (int w : neighbours[static_cast<std::size_t>(v)]) {
      if (lowest[static_cast<std::size_t>(w)] < 0) continue;
      int a = parts.find(v), b = parts.find(w);
      if (a == b) continue;
      const double depth_a = z(v) - z(lowest[static_cast<std::size_t>(a)]);
      const double depth_b = z(v) - z(lowest[static_cast<std::size_t>(b)]);
      if (depth_a > apex_persistence_mm && depth_b > apex_persistence_mm) {
        tooth.furcation_z = z(v);
        close(a);
        close(b);
      }
      if (z(lowest[static_cast<std::size_t>(b)]) < z(lowest[static_cast<std::size_t>(a)])) std::swap(a, b);
      parts.join(b, a);
      auto& into = members[static_cast<std::size_t>(a)];
      auto& from = members[static_cast<std::size_t>(b)];
      into.insert(into.end(), from.begin(), from.end());
      from.clear();
      if (closed[static_cast<std::size_t>(b)]) closed[static_cast<std::size_t>(a)] = true;
    }
  }
  if (!tooth.roots.empty()) return;
  TemplateRoot single;  // nothing ever met: one root from the junction down
  single.apex = static_cast<std::size_t>(order.front());
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (vertices[v].z() < 0) tooth.root[v] = 0;
  tooth.roots.push_back(single);
}

void find_centrelines(FamilyTemplate& tooth) {
  for (std::size_t r = 0; r < tooth.roots.size(); ++r) {
    TemplateRoot& root = tooth.roots[r];
    const double bottom = tooth.mesh.vertices[root.apex].z();
    const auto steps =
        static_cast<std::size_t>(std::ceil((root.branch_z - bottom) / TemplateRoot::centreline_step)) + 1;
    std::vector<Eigen::Vector2d> sum(steps, Eigen::Vector2d::Zero());
    std::vector<double> weight(steps, 0.0);
    for (std::size_t t = 0; t < tooth.mesh.triangles.size(); ++t) {
      const Triangle& c = tooth.mesh.triangles[t];
      if (tooth.root[static_cast<std::size_t>(c[0])] != static_cast<int>(r)) continue;
      Point centre = Point::Zero();
      for (int v : c) centre += tooth.mesh.vertices[static_cast<std::size_t>(v)] / 3;
      const double area = triangle_area(tooth.mesh, t);
      // A window of three steps smooths the line and leaves no step empty.
      const double at = (root.branch_z - centre.z()) / TemplateRoot::centreline_step;
      for (int k = -1; k <= 1; ++k) {
        const auto s = static_cast<std::ptrdiff_t>(std::lround(at)) + k;
        if (s < 0 || s >= static_cast<std::ptrdiff_t>(steps)) continue;
        sum[static_cast<std::size_t>(s)] += area * centre.head<2>();
        weight[static_cast<std::size_t>(s)] += area;
      }
    }
    for (std::size_t s = 0; s < steps; ++s) {
      if (weight[s] > 0)
        root.centreline.push_back(sum[s] / weight[s]);
      else if (!root.centreline.empty())
        root.centreline.push_back(Eigen::Vector2d(root.centreline.back()));
      else
        root.centreline.push_back(tooth.mesh.vertices[root.apex].head<2>());
    }
  }
}

}  // namespace

double JunctionHeight::operator()(double x, double y) const {
  const double radius = std::hypot(x / half_width.x(), y / half_width.y());
  if (radius > 1) x /= radius, y /= radius;
  const auto& c = coefficients;
  return c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
}

TriangleMesh simplified(const TriangleMesh& mesh, std::size_t vertices) {
  if (mesh.vertices.size() <= vertices) return mesh;
  using Kernel = CGAL::Simple_cartesian<double>;
  using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
  namespace SMS = CGAL::Surface_mesh_simplification;
  Surface surface;
  for (const Point& p : mesh.vertices) surface.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
  for (const Triangle& t : mesh.triangles)
    surface.add_face(Surface::Vertex_index(static_cast<std::uint32_t>(t[0])),
                     Surface::Vertex_index(static_cast<std::uint32_t>(t[1])),
                     Surface::Vertex_index(static_cast<std::uint32_t>(t[2])));
  SMS::edge_collapse(surface, SMS::Count_stop_predicate<Surface>(3 * vertices));
  surface.collect_garbage();
  TriangleMesh result;
  for (const auto v : surface.vertices())
    result.vertices.emplace_back(surface.point(v).x(), surface.point(v).y(), surface.point(v).z());
  for (const auto f : surface.faces()) {
    Triangle t{};
    std::size_t i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      t[i++] = static_cast<std::int32_t>(static_cast<std::uint32_t>(v));
    result.triangles.push_back(t);
  }
  return result;
}

std::vector<std::uint8_t> crown_labels(const TriangleMesh& mesh, const std::vector<double>& label, double crown_share) {
  if (label.size() != mesh.vertices.size() || std::count(label.begin(), label.end(), 1.0) == 0)
    return estimated_crown(mesh, crown_share);
  std::vector<std::uint8_t> crown;
  for (double value : label) crown.push_back(value == 1.0 ? 1 : 0);
  return crown;
}

Eigen::Vector3d template_axis(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown) {
  return crown_area_vector(mesh, crown).normalized();
}

FamilyTemplate analyse_template(const TriangleMesh& mesh, const std::vector<std::uint8_t>& crown,
                                const Eigen::Vector3d& buccal, std::size_t vertices) {
  FamilyTemplate tooth;
  const Eigen::Vector3d z = template_axis(mesh, crown);
  const Eigen::Vector3d y = (buccal - buccal.dot(z) * z).normalized();
  Eigen::Matrix3d rotation;
  rotation.row(0) = y.cross(z);
  rotation.row(1) = y;
  rotation.row(2) = z;
  const std::vector<Point> border = junction_points(mesh, crown);
  if (border.size() < 20 || volume(mesh) <= 0)
    throw InputError("A template tooth is not an outward closed surface with an enamel border.");
  Point origin = Point::Zero();
  for (const Point& p : border) origin += p / static_cast<double>(border.size());

  tooth.mesh = simplified(mesh, vertices);
  relax_crossings(tooth.mesh);
  const NearestVertexIndex full(mesh.vertices);
  for (Point& p : tooth.mesh.vertices) {
    tooth.crown.push_back(crown[static_cast<std::size_t>(full.nearest(p).index)]);
    p = rotation * (p - origin);
  }
  std::vector<Point> local;
  for (const Point& p : border) local.push_back(rotation * (p - origin));
  tooth.junction = fit_junction(local);

  find_roots(tooth);
  find_centrelines(tooth);
  Eigen::AlignedBox3d whole = bounding_box(tooth.mesh.vertices), enamel;
  for (std::size_t v = 0; v < tooth.crown.size(); ++v)
    if (tooth.crown[v] == 1) enamel.extend(tooth.mesh.vertices[v]);
  tooth.crown_height = whole.max().z();
  tooth.root_length = -whole.min().z();
  tooth.crown_width = enamel.sizes().head<2>();
  return tooth;
}

}  // namespace rhizodont
