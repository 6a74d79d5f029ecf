// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/raw_crowns.hpp"

#include "base/disjoint_sets.hpp"
#include "base/float_bits.hpp"
#include "base/random_stream.hpp"
#include "common/hostile_crowns.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rhizodont::test {
namespace {

/// The crown under work.
struct Work {
  TriangleMesh mesh;
  std::vector<std::uint8_t> gum;  // per vertex: not the tooth's own surface

  const Point& at(int v) const { return mesh.vertices[static_cast<std::size_t>(v)]; }
  bool is_gum(int v) const { return gum[static_cast<std::size_t>(v)] != 0; }
  bool is_gum(const Triangle& t) const {
    return std::all_of(t.begin(), t.end(), [&](int v) { return is_gum(v); });
  }
  int add_vertex(const Point& p) {
    mesh.vertices.push_back(p);
    gum.push_back(1);
    return static_cast<int>(mesh.vertices.size()) - 1;
  }
  std::vector<int> gum_vertices() const {
    std::vector<int> found;
    for (int v = 0; v < static_cast<int>(gum.size()); ++v)
      if (is_gum(v)) found.push_back(v);
    return found;
  }
  std::vector<std::size_t> gum_triangles() const {
    std::vector<std::size_t> found;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (is_gum(mesh.triangles[t])) found.push_back(t);
    return found;
  }
  void drop_unused() {
    Submesh used = compact(mesh);
    std::vector<std::uint8_t> labels;
    for (const int v : used.old_vertices) labels.push_back(gum[static_cast<std::size_t>(v)]);
    mesh = std::move(used.mesh);
    gum = std::move(labels);
  }
  /// Border half-edges whose ends are gum.
  std::vector<std::pair<int, int>> gum_border() const {
    std::vector<std::pair<int, int>> border = border_half_edges(mesh);
    std::erase_if(border, [&](const auto& h) { return !is_gum(h.first) || !is_gum(h.second); });
    return border;
  }
};

void add_nothing(Work&, RandomStream&) {}

/// Strips of two triangles between edges of the ragged border.
void add_bridges(Work& work, RandomStream& random) {
  for (std::uint64_t k = 1 + random.index(6); k-- > 0;) {
    const auto border = work.gum_border();
    if (border.size() < 6) return;
    const auto [a, b] = border[random.index(border.size())];
    const double reach = random.uniform(0.4, 3);
    std::pair<int, int> far{-1, -1};
    double best = 1e9;
    for (const auto& [c, d] : border) {
      const double miss = std::abs((work.at(c) - work.at(a)).norm() - reach);
      if (c == a || c == b || d == a || d == b || miss >= best) continue;
      best = miss;
      far = {c, d};
    }
    if (far.first < 0) continue;
    work.mesh.triangles.push_back({b, a, far.second});
    work.mesh.triangles.push_back({b, far.second, far.first});
  }
}

/// Tubes from one place of the gum to another.
void add_handles(Work& work, RandomStream& random) {
  work.drop_unused();  // as `add_tube` would, and then the labels would be others'
  for (std::uint64_t k = 1 + random.index(5); k-- > 0;) {
    const std::vector<std::size_t> gum = work.gum_triangles();
    if (gum.size() < 20) return;
    const std::size_t s = gum[random.index(gum.size())];
    const double reach = random.uniform(0.6, 2);
    std::size_t far = s;
    double best = 1e9;
    for (const std::size_t t : gum) {
      const double miss =
          std::abs((work.at(work.mesh.triangles[t][0]) - work.at(work.mesh.triangles[s][0])).norm() - reach);
      if (t == s || miss >= best) continue;
      best = miss;
      far = t;
    }
    add_tube(work.mesh, s, far, random.uniform(0.2, 1));
    work.gum.resize(work.mesh.vertices.size(), 1);  // the tube's vertices are last
  }
}

/// Cuts along edges that leave both sides in place, up to 0.02 mm apart.
void add_slits(Work& work, RandomStream& random) {
  for (std::uint64_t k = 1 + random.index(4); k-- > 0;) {
    const std::vector<int> gum = work.gum_vertices();
    if (gum.size() < 20) return;
    std::vector<int> path{gum[random.index(gum.size())]};
    const EdgeTable edges = edge_table(work.mesh);
    std::vector<std::vector<int>> around(work.mesh.vertices.size());
    for (const auto& [a, b] : edges.vertices) {
      around[static_cast<std::size_t>(a)].push_back(b);
      around[static_cast<std::size_t>(b)].push_back(a);
    }
    for (std::uint64_t steps = 3 + random.index(10); steps-- > 0;) {
      const std::vector<int>& next = around[static_cast<std::size_t>(path.back())];
      const int v = next[random.index(next.size())];
      if (work.is_gum(v) && std::find(path.begin(), path.end(), v) == path.end()) path.push_back(v);
    }
    const auto is_cut = [&](int a, int b) {
      const auto it = std::find(path.begin(), path.end(), a);
      return it != path.end() && ((it + 1 != path.end() && *(it + 1) == b) || (it != path.begin() && *(it - 1) == b));
    };
    const auto corners = 3 * work.mesh.triangles.size();
    DisjointSets fans(corners);
    const auto after = [](int h) { return h % 3 == 2 ? h - 2 : h + 1; };
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (is_cut(edges.vertices[e][0], edges.vertices[e][1])) continue;
      for (int i = edges.first[e] + 1; i < edges.first[e + 1]; ++i) {
        const int g = edges.half_edges[static_cast<std::size_t>(i - 1)],
                  h = edges.half_edges[static_cast<std::size_t>(i)];
        const bool same_way = half_edge_from(work.mesh, g) == half_edge_from(work.mesh, h);
        fans.join(g, same_way ? h : after(h));
        fans.join(after(g), same_way ? after(h) : h);
      }
    }
    const Eigen::Vector3d apart = 0.02 * random.uniform() * any_direction(random);
    for (const int v : path) {
      std::vector<std::pair<int, int>> number;  // fan, vertex
      for (int c = 0; c < static_cast<int>(corners); ++c) {
        std::int32_t& corner = work.mesh.triangles[static_cast<std::size_t>(c / 3)][static_cast<std::size_t>(c % 3)];
        if (corner != v) continue;
        const int fan = fans.find(c);
        auto it = std::find_if(number.begin(), number.end(), [&](const auto& n) { return n.first == fan; });
        if (it == number.end()) {
          const int id = number.empty() ? v : work.add_vertex(work.at(v) + apart);
          it = number.insert(number.end(), {fan, id});
        }
        corner = it->second;
      }
    }
  }
}

/// Gum vertices that are missing with their triangles: the more holes, the lower the Euler number.
void cut_holes(Work& work, RandomStream& random) {
  const std::vector<int> gum = work.gum_vertices();
  if (gum.size() < 20) return;
  for (std::uint64_t k = 3 + random.index(9); k-- > 0;) {
    const int v = gum[random.index(gum.size())];
    std::erase_if(work.mesh.triangles, [&](const Triangle& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
  }
}

/// Patches of gum and single triangles beside the crown, not part of it.
void add_pieces(Work& work, RandomStream& random) {
  const std::vector<int> gum = work.gum_vertices();
  if (gum.empty()) return;
  const Point middle = area_centroid(work.mesh);
  for (std::uint64_t k = 1 + random.index(5); k-- > 0;) {
    const Point centre = work.at(gum[random.index(gum.size())]);
    const double radius = random.uniform(0.3, 2);
    std::vector<bool> near;
    for (const Triangle& t : work.mesh.triangles)
      near.push_back((work.at(t[0]) - centre).norm() < radius && work.is_gum(t));
    const Submesh patch = submesh(work.mesh, near);
    const Eigen::Vector3d shift =
        random.uniform(0.2, 3) * ((centre - middle).normalized() + 0.5 * any_direction(random));
    const auto offset = static_cast<std::int32_t>(work.mesh.vertices.size());
    for (const Point& p : patch.mesh.vertices) work.add_vertex(p + shift);
    for (const auto& [a, b, c] : patch.mesh.triangles)
      work.mesh.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

/// Vertices where the ragged part only touches itself, or where a triangle hangs by one corner.
void add_touching_vertices(Work& work, RandomStream& random) {
  for (std::uint64_t k = 1 + random.index(9); k-- > 0;) {
    const auto border = work.gum_border();
    if (border.size() < 6) return;
    const int v = border[random.index(border.size())].first;
    if (random.chance(0.4)) {
      const int a = work.add_vertex(work.at(v) + 0.4 * any_direction(random));
      const int b = work.add_vertex(work.at(v) + 0.4 * any_direction(random));
      work.mesh.triangles.push_back({v, a, b});
      continue;
    }
    int near = -1;
    for (const auto& [w, next] : border) {
      const bool joined = std::any_of(work.mesh.triangles.begin(), work.mesh.triangles.end(), [&](const Triangle& t) {
        return std::find(t.begin(), t.end(), v) != t.end() && std::find(t.begin(), t.end(), w) != t.end();
      });
      if (!joined && (near < 0 || (work.at(w) - work.at(v)).norm() < (work.at(near) - work.at(v)).norm())) near = w;
    }
    if (near < 0 || (work.at(near) - work.at(v)).norm() > 1.5) continue;
    for (Triangle& t : work.mesh.triangles)
      if (std::find(t.begin(), t.end(), v) == t.end()) std::replace(t.begin(), t.end(), near, v);
  }
}

/// Third triangles on the gum's edges, with a corner of their own or one of the gum's.
void add_crowded_edges(Work& work, RandomStream& random) {
  for (std::uint64_t k = 1 + random.index(6); k-- > 0;) {
    const std::vector<std::size_t> gum = work.gum_triangles();
    if (gum.size() < 20) return;
    const Triangle t = work.mesh.triangles[gum[random.index(gum.size())]];
    int tip = work.mesh.triangles[gum[random.index(gum.size())]][0];
    if (random.chance(0.6) || (work.at(tip) - work.at(t[0])).norm() > 1.5 ||
        std::find(t.begin(), t.end(), tip) != t.end())
      tip = work.add_vertex(work.at(t[0]) + random.uniform(0.1, 1) * any_direction(random));
    work.mesh.triangles.push_back(random.chance(0.5) ? Triangle{t[0], t[1], tip} : Triangle{t[1], t[0], tip});
  }
}

/// Parts of the gum pushed through what lies behind them.
void add_crossings(Work& work, RandomStream& random) {
  const auto normals = vertex_normals(work.mesh);
  const std::vector<int> gum = work.gum_vertices();
  if (gum.empty()) return;
  for (std::uint64_t k = 1 + random.index(3); k-- > 0;) {
    const int centre = gum[random.index(gum.size())];
    const Point middle = work.at(centre);
    const Eigen::Vector3d way =
        random.chance(0.5) ? Eigen::Vector3d(-normals[static_cast<std::size_t>(centre)]) : any_direction(random);
    const double radius = random.uniform(0.4, 1.2), depth = random.uniform(0.5, 2);
    for (const int v : gum) {
      const double near = 1 - (work.at(v) - middle).norm() / radius;
      if (near > 0) work.mesh.vertices[static_cast<std::size_t>(v)] += depth * near * way;
    }
  }
}

/// Triangles of the gum's border taken away at random, several times.
void tear_border(Work& work, RandomStream& random) {
  for (std::uint64_t round = 1 + random.index(3); round-- > 0;) {
    std::vector<std::uint8_t> border(work.mesh.vertices.size(), 0);
    for (const auto& [a, b] : work.gum_border())
      border[static_cast<std::size_t>(a)] = border[static_cast<std::size_t>(b)] = 1;
    const double share = random.uniform(0.1, 0.6);
    std::erase_if(work.mesh.triangles, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](int v) { return border[static_cast<std::size_t>(v)] != 0; }) &&
             random.chance(share);
    });
  }
}

using Addition = void (*)(Work&, RandomStream&);
struct RawKind {
  const char* name;
  Addition add;
};
constexpr std::array<RawKind, 10> raw_kind_list{{{"plain", add_nothing},
                                                 {"bridges", add_bridges},
                                                 {"handles", add_handles},
                                                 {"slits", add_slits},
                                                 {"holes", cut_holes},
                                                 {"pieces", add_pieces},
                                                 {"touching vertices", add_touching_vertices},
                                                 {"crowded edges", add_crowded_edges},
                                                 {"crossings", add_crossings},
                                                 {"torn border", tear_border}}};
constexpr const char* raw_combination = "combination";

}  // namespace

std::vector<std::string> raw_kinds() {
  std::vector<std::string> names;
  for (const RawKind& kind : raw_kind_list) names.emplace_back(kind.name);
  names.emplace_back(raw_combination);
  return names;
}

TriangleMesh raw_crown(const TriangleMesh& crown, const std::vector<std::uint8_t>& is_tooth, const std::string& kind,
                       std::uint64_t seed) {
  const std::vector<std::string> names = raw_kinds();
  const auto place = static_cast<std::size_t>(std::find(names.begin(), names.end(), kind) - names.begin());
  if (place == names.size()) throw UsageError("No segmentation leaves what is called " + kind + ".");
  if (is_tooth.size() != crown.vertices.size()) throw UsageError("A raw crown needs a label for each vertex.");
  RandomStream random(seed, 900 + place);
  Work work{crown, {}};
  for (const std::uint8_t tooth : is_tooth) work.gum.push_back(tooth == 0 ? 1 : 0);
  if (place < raw_kind_list.size())
    raw_kind_list[place].add(work, random);
  else
    for (std::uint64_t k = 3 + random.index(3); k-- > 0;)
      raw_kind_list[1 + random.index(raw_kind_list.size() - 1)].add(work, random);
  for (Point& p : work.mesh.vertices) p = nearest_float(p);
  return compact(work.mesh).mesh;
}

}  // namespace rhizodont::test
