// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/hostile_crowns.hpp"

#include "base/float_bits.hpp"
#include "base/random_stream.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace rhizodont::test {
namespace {

const Point& corner(const TriangleMesh& mesh, std::size_t t, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i % 3])];
}

std::size_t any_vertex(const TriangleMesh& mesh, RandomStream& random) { return random.index(mesh.vertices.size()); }
std::size_t any_triangle(const TriangleMesh& mesh, RandomStream& random) { return random.index(mesh.triangles.size()); }

int add_vertex(TriangleMesh& mesh, const Point& p) {
  mesh.vertices.push_back(p);
  return static_cast<int>(mesh.vertices.size()) - 1;
}

/// Some elements out of the whole, at least one.
std::size_t some(std::size_t whole, double share, RandomStream& random) {
  return 1 + random.index(std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(whole))));
}

/// Triangles all of whose corners lie within a ball.
std::vector<bool> triangles_near(const TriangleMesh& mesh, const Point& centre, double radius) {
  std::vector<bool> near;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    near.push_back((corner(mesh, t, 0) - centre).norm() < radius && (corner(mesh, t, 1) - centre).norm() < radius &&
                   (corner(mesh, t, 2) - centre).norm() < radius);
  return near;
}

void remove(TriangleMesh& mesh, std::vector<bool> which) {
  which.flip();
  if (std::find(which.begin(), which.end(), true) != which.end()) mesh = submesh(mesh, which).mesh;
}

std::set<int> border_vertices(const TriangleMesh& mesh) {
  std::set<int> ids;
  for (const auto& [a, b] : border_half_edges(mesh)) ids.insert({a, b});
  return ids;
}

void add_noise(TriangleMesh& mesh, RandomStream& random) {
  const double deviation = 0.003 * std::pow(30.0, random.uniform());
  for (Point& p : mesh.vertices) p += deviation * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

void add_spikes(TriangleMesh& mesh, RandomStream& random) {
  const auto normals = vertex_normals(mesh);
  for (std::size_t k = some(mesh.vertices.size(), 0.01, random); k-- > 0;) {
    const std::size_t v = any_vertex(mesh, random);
    mesh.vertices[v] += random.uniform(0.3, 4) * (normals[v] + 0.3 * any_direction(random));
  }
}

/// New vertices hardly off an edge or a corner of their triangle, down to 1e-6 of its size.
void add_slivers(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.1, random); k-- > 0;) {
    const std::size_t t = any_triangle(mesh, random), i = random.index(3);
    const double off = std::pow(10.0, random.uniform(-6, -2)), along = random.chance(0.5) ? 0.5 : random.uniform();
    const Point p =
        (1 - off) * ((1 - along) * corner(mesh, t, i) + along * corner(mesh, t, i + 1)) + off * corner(mesh, t, i + 2);
    const int v = add_vertex(mesh, p);
    const auto [a, b, c] = mesh.triangles[t];
    mesh.triangles[t] = {a, b, v};
    mesh.triangles.push_back({b, c, v});
    mesh.triangles.push_back({c, a, v});
  }
}

/// Some triangles get corners of their own at the same places; now and then all do.
void duplicate_vertices(TriangleMesh& mesh, RandomStream& random) {
  const double share = random.chance(0.2) ? 1 : 0.05 * random.uniform();
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t)
      if (random.chance(share)) v = add_vertex(mesh, Point(mesh.vertices[static_cast<std::size_t>(v)]));
}

void add_unreferenced_vertices(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.vertices.size(), 0.1, random); k-- > 0;)
    add_vertex(mesh, mesh.vertices[any_vertex(mesh, random)] + (random.chance(0.5) ? 5 : 0) * any_direction(random));
}

void duplicate_triangles(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.01, random); k-- > 0;) {
    Triangle t = mesh.triangles[any_triangle(mesh, random)];
    if (random.chance(0.3)) std::swap(t[0], t[1]);
    mesh.triangles.push_back(t);
  }
}

void add_degenerate_triangles(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.01, random); k-- > 0;) {
    const Triangle t = mesh.triangles[any_triangle(mesh, random)];
    const int copy = add_vertex(mesh, Point(mesh.vertices[static_cast<std::size_t>(t[0])]));
    if (random.chance(0.3))
      mesh.triangles.push_back({t[0], t[1], t[0]});
    else if (random.chance(0.5))
      mesh.triangles.push_back({t[1], t[0], copy});
    else
      mesh.triangles.push_back({t[0], static_cast<std::int32_t>(any_vertex(mesh, random)), copy});
  }
}

/// An edge gets a vertex on one of its sides only: a gap without width.
void add_t_junctions(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.01, random); k-- > 0;) {
    const std::size_t t = any_triangle(mesh, random), i = random.index(3);
    const int v = add_vertex(mesh, 0.5 * (corner(mesh, t, i) + corner(mesh, t, i + 1)));
    const Triangle old = mesh.triangles[t];
    mesh.triangles[t] = {old[i], v, old[(i + 2) % 3]};
    mesh.triangles.push_back({v, old[(i + 1) % 3], old[(i + 2) % 3]});
  }
}

/// Fins: third triangles on edges, outside, inside or between vertices of the crown.
void add_non_manifold_edges(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.003, random); k-- > 0;) {
    const Triangle t = mesh.triangles[any_triangle(mesh, random)];
    const int tip = random.chance(0.3) ? static_cast<int>(any_vertex(mesh, random))
                                       : add_vertex(mesh, mesh.vertices[static_cast<std::size_t>(t[0])] +
                                                              random.uniform(0.1, 1.5) * any_direction(random));
    if (tip == t[0] || tip == t[1]) continue;
    mesh.triangles.push_back(random.chance(0.5) ? Triangle{t[0], t[1], tip} : Triangle{t[1], t[0], tip});
  }
}

/// Triangles that hang on the crown by one vertex, vertices that lose part of their fan, and places that become one.
void add_non_manifold_vertices(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.vertices.size(), 0.004, random); k-- > 0;) {
    const auto v = static_cast<std::int32_t>(any_vertex(mesh, random));
    const Point at = mesh.vertices[static_cast<std::size_t>(v)];
    if (random.chance(0.4)) {
      const int a = add_vertex(mesh, at + 0.4 * any_direction(random));
      const int b = add_vertex(mesh, at + 0.4 * any_direction(random));
      mesh.triangles.push_back({v, a, b});
    } else if (random.chance(0.6)) {
      std::size_t seen = 0;  // every other triangle of the fan goes
      std::erase_if(mesh.triangles,
                    [&](const Triangle& t) { return std::find(t.begin(), t.end(), v) != t.end() && seen++ % 2 == 1; });
    } else {
      const auto other = static_cast<std::int32_t>(any_vertex(mesh, random));
      for (Triangle& t : mesh.triangles)
        if (std::find(t.begin(), t.end(), v) == t.end()) std::replace(t.begin(), t.end(), other, v);
    }
  }
}

void cut_holes(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = 1 + random.index(8); k-- > 0 && mesh.triangles.size() > 20;)
    remove(mesh, triangles_near(mesh, mesh.vertices[any_vertex(mesh, random)], random.uniform(0.1, 2.5)));
}

/// Bites and stray triangles along the border.
void tear_border(TriangleMesh& mesh, RandomStream& random) {
  for (int round = 0; round < 3; ++round) {
    const std::set<int> border = border_vertices(mesh);
    const double share = random.uniform(0.1, 0.7);
    std::vector<bool> gone;
    for (const Triangle& t : mesh.triangles)
      gone.push_back(std::any_of(t.begin(), t.end(), [&](int v) { return border.contains(v); }) &&
                     random.chance(share));
    remove(mesh, gone);
  }
}

/// Strips of two triangles between border edges.
void add_bridges(TriangleMesh& mesh, RandomStream& random) {
  const auto border = border_half_edges(mesh);
  if (border.size() < 6) return;
  for (std::size_t k = 1 + random.index(3); k-- > 0;) {
    const std::size_t first = random.index(border.size());
    const auto [a, b] = border[first];
    const Point& at = mesh.vertices[static_cast<std::size_t>(a)];
    const double reach = random.uniform(0.5, 6);
    std::pair<int, int> far{-1, -1};
    for (const auto& [c, d] : border)
      if (c != a && c != b && d != a && d != b &&
          (far.first < 0 || std::abs((mesh.vertices[static_cast<std::size_t>(c)] - at).norm() - reach) <
                                std::abs((mesh.vertices[static_cast<std::size_t>(far.first)] - at).norm() - reach)))
        far = {c, d};
    if (far.first < 0) continue;
    mesh.triangles.push_back({b, a, far.second});
    mesh.triangles.push_back({b, far.second, far.first});
  }
}

/// Handles, mostly beside the border.
void add_handles(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = 1 + random.index(3); k-- > 0;) {
    const std::set<int> border = border_vertices(mesh);
    std::size_t s = any_triangle(mesh, random);
    for (int tries = 0; tries < 200 && random.chance(0.97); ++tries) {
      const Triangle& candidate = mesh.triangles[s];
      if (std::any_of(candidate.begin(), candidate.end(), [&](int v) { return border.contains(v); })) break;
      s = any_triangle(mesh, random);
    }
    std::size_t best = s;
    const double reach = random.uniform(0.5, 2);
    for (int tries = 0; tries < 300; ++tries) {
      const std::size_t t = any_triangle(mesh, random);
      const double d = (corner(mesh, s, 0) - corner(mesh, t, 0)).norm();
      if (t != s &&
          (best == s || std::abs(d - reach) < std::abs((corner(mesh, s, 0) - corner(mesh, best, 0)).norm() - reach)))
        best = t;
    }
    if (best != s) add_tube(mesh, s, best, random.uniform(0, 0.8));
  }
}

/// Pieces beside the crown: copies of patches and single triangles; now and then a second crown.
void add_islands(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = 1 + random.index(5); k-- > 0;) {
    const double radius = random.chance(0.1) ? 100 : random.uniform(0.3, 2);
    const auto near = triangles_near(mesh, mesh.vertices[any_vertex(mesh, random)], radius);
    if (std::find(near.begin(), near.end(), true) == near.end()) continue;
    const TriangleMesh patch = submesh(mesh, near).mesh;
    const Eigen::Vector3d shift = random.uniform(0.2, 9) * any_direction(random);
    const auto offset = static_cast<std::int32_t>(mesh.vertices.size());
    for (const Point& p : patch.vertices) mesh.vertices.push_back(p + shift);
    for (const auto& [a, b, c] : patch.triangles) mesh.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

void add_self_intersections(TriangleMesh& mesh, RandomStream& random) {
  const auto normals = vertex_normals(mesh);
  for (std::size_t k = 1 + random.index(4); k-- > 0;) {
    const std::size_t v = any_vertex(mesh, random);
    if (random.chance(0.5)) {
      const Triangle& t = mesh.triangles[any_triangle(mesh, random)];
      std::swap(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])]);
      continue;
    }
    const Point centre = mesh.vertices[v];
    const double radius = random.uniform(0.5, 2), depth = random.uniform(1, 12);
    for (Point& p : mesh.vertices)
      if ((p - centre).norm() < radius) p -= depth * (1 - (p - centre).norm() / radius) * normals[v];
  }
}

void flip_patches(TriangleMesh& mesh, RandomStream& random) {
  if (random.chance(0.1)) mesh = flipped(mesh);
  for (std::size_t k = 1 + random.index(4); k-- > 0;) {
    const auto near = triangles_near(mesh, mesh.vertices[any_vertex(mesh, random)], random.uniform(0.2, 3));
    for (std::size_t t = 0; t < near.size(); ++t)
      if (near[t]) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
}

/// Coordinates on a coarse grid: equal places, flat triangles, corners on one sphere.
void snap_to_grid(TriangleMesh& mesh, RandomStream& random) {
  const double step = random.chance(0.5) ? 0.05 : random.uniform(0.01, 0.4);
  for (Point& p : mesh.vertices)
    for (double& x : p) x = step * std::round(x / step);
}

/// Far from the origin, very flat, very long, tiny or large.
void distort(TriangleMesh& mesh, RandomStream& random) {
  const std::uint64_t way = random.index(5);
  const Eigen::Vector3d axis = any_direction(random);
  for (Point& p : mesh.vertices) {
    if (way == 0) p += 1e5 * axis;
    if (way == 1) p -= 0.97 * p.dot(axis) * axis;
    if (way == 2) p += 2.5 * p.dot(axis) * axis;
    if (way == 3) p *= 0.3;
    if (way == 4) p -= p.dot(axis) * axis;
  }
}

/// Hardly anything left.
void leave_a_scrap(TriangleMesh& mesh, RandomStream& random) {
  std::vector<bool> rest = triangles_near(mesh, mesh.vertices[any_vertex(mesh, random)], random.uniform(0.3, 3));
  if (random.chance(0.3)) rest.assign(rest.size(), false);
  rest[any_triangle(mesh, random)] = true;
  mesh = submesh(mesh, rest).mesh;
}

/// Only a ring around the tooth, or the crown's top alone: cut by a plane across the axis.
void cut_off(TriangleMesh& mesh, RandomStream& random) {
  const Eigen::Vector3d axis = area_vector(mesh).normalized();
  double low = 1e300, high = -1e300;
  for (const Point& p : mesh.vertices) low = std::min(low, p.dot(axis)), high = std::max(high, p.dot(axis));
  const double at = random.uniform(low, high);
  const bool above = random.chance(0.5);
  std::vector<bool> gone;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) gone.push_back((corner(mesh, t, 0).dot(axis) > at) == above);
  remove(mesh, gone);
}

void close_base(TriangleMesh& mesh, RandomStream&) { mesh = capped(mesh); }

/// Triangles between vertices at random.
void add_random_triangles(TriangleMesh& mesh, RandomStream& random) {
  for (std::size_t k = some(mesh.triangles.size(), 0.02, random); k-- > 0;) {
    const auto v = [&] { return static_cast<std::int32_t>(any_vertex(mesh, random)); };
    mesh.triangles.push_back({v(), v(), v()});
  }
}

using Defect = void (*)(TriangleMesh&, RandomStream&);
struct Kind {
  const char* name;
  Defect defect;
};
constexpr std::array<Kind, 23> kinds{{{"noise", add_noise},
                                      {"spikes", add_spikes},
                                      {"slivers", add_slivers},
                                      {"duplicate vertices", duplicate_vertices},
                                      {"unreferenced vertices", add_unreferenced_vertices},
                                      {"duplicate triangles", duplicate_triangles},
                                      {"degenerate triangles", add_degenerate_triangles},
                                      {"T-junctions", add_t_junctions},
                                      {"non-manifold edges", add_non_manifold_edges},
                                      {"non-manifold vertices", add_non_manifold_vertices},
                                      {"holes", cut_holes},
                                      {"torn border", tear_border},
                                      {"bridges", add_bridges},
                                      {"handles", add_handles},
                                      {"islands", add_islands},
                                      {"self-intersections", add_self_intersections},
                                      {"flipped patches", flip_patches},
                                      {"grid", snap_to_grid},
                                      {"distortion", distort},
                                      {"scrap", leave_a_scrap},
                                      {"cut off", cut_off},
                                      {"random triangles", add_random_triangles},
                                      {"closed base", close_base}}};
constexpr const char* combination = "combination";

}  // namespace

Eigen::Vector3d any_direction(RandomStream& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

std::vector<std::pair<int, int>> border_half_edges(const TriangleMesh& mesh) {
  const EdgeTable table = edge_table(mesh);
  std::vector<std::pair<int, int>> border;
  for (std::size_t e = 0; e < table.size(); ++e) {
    if (table.triangle_count(e) != 1) continue;
    const int h = table.half_edges[static_cast<std::size_t>(table.first[e])];
    border.emplace_back(half_edge_from(mesh, h), half_edge_to(mesh, h));
  }
  return border;
}

void add_tube(TriangleMesh& mesh, std::size_t s, std::size_t t, double bulge) {
  const Triangle from = mesh.triangles[s], to = mesh.triangles[t];
  for (const int v : from)
    if (std::find(to.begin(), to.end(), v) != to.end()) return;
  std::array<int, 3> far{to[0], to[2], to[1]};  // against the sense of `from`, starting near its first corner
  const auto distance = [&](int a, int b) {
    return (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(b)]).norm();
  };
  std::rotate(far.begin(),
              std::min_element(far.begin(), far.end(),
                               [&](int x, int y) { return distance(from[0], x) < distance(from[0], y); }),
              far.end());
  const Eigen::Vector3d out = (triangle_normal(mesh, s) + triangle_normal(mesh, t)).normalized();
  std::array<int, 3> ring{};
  for (std::size_t i = 0; i < 3; ++i)
    ring[i] = add_vertex(mesh, 0.5 * (mesh.vertices[static_cast<std::size_t>(from[i])] +
                                      mesh.vertices[static_cast<std::size_t>(far[i])]) +
                                   bulge * out);
  std::vector<bool> gone(mesh.triangles.size(), false);
  gone[s] = gone[t] = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    for (const auto& [p, q, r, u] :
         {std::array{from[i], from[j], ring[j], ring[i]}, {ring[i], ring[j], far[j], far[i]}}) {
      mesh.triangles.push_back({p, q, r});
      mesh.triangles.push_back({p, r, u});
    }
  }
  gone.resize(mesh.triangles.size(), false);
  remove(mesh, gone);
}

std::vector<std::string> hostile_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  names.emplace_back(combination);
  return names;
}

TriangleMesh hostile_crown(const TriangleMesh& clean, const std::string& kind, std::uint64_t seed) {
  const std::vector<std::string> names = hostile_kinds();
  const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), kind) - names.begin());
  if (place == names.size()) throw UsageError("There is no defect called " + kind + ".");
  RandomStream random(seed, place);
  TriangleMesh mesh = clean;
  if (place < kinds.size()) {
    kinds[place].defect(mesh, random);
  } else {
    if (random.chance(0.3)) close_base(mesh, random);
    for (std::uint64_t k = 2 + random.index(3); k-- > 0;) kinds[random.index(kinds.size() - 1)].defect(mesh, random);
  }
  if (random.chance(0.5))
    for (Point& p : mesh.vertices) p = nearest_float(p);
  return mesh;
}

}  // namespace rhizodont::test
