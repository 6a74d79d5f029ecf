// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "common/closed_bases.hpp"

#include "base/random_stream.hpp"
#include "common/hostile_crowns.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

namespace rhizodont::test {
namespace {

/// The loop as triangles that close it run along it.
using Loop = std::vector<std::int32_t>;

Loop base_loop(const TriangleMesh& crown) {
  const auto loops = border_loops(crown);
  const auto& longest =
      *std::max_element(loops.begin(), loops.end(), [](const auto& x, const auto& y) { return x.size() < y.size(); });
  return {longest.rbegin(), longest.rend()};
}

Point mean_of(const TriangleMesh& mesh, const Loop& loop) {
  Point sum = Point::Zero();
  for (const int v : loop) sum += mesh.vertices[static_cast<std::size_t>(v)];
  return sum / static_cast<double>(loop.size());
}

/// Out of the crown's base.
Eigen::Vector3d downward(const TriangleMesh& crown) { return -area_vector(crown).normalized(); }

std::int32_t add(TriangleMesh& mesh, const Point& p) {
  mesh.vertices.push_back(p);
  return static_cast<std::int32_t>(mesh.vertices.size()) - 1;
}

void close_by_fan(TriangleMesh& mesh, const Loop& loop, const Point& apex) {
  const std::int32_t centre = add(mesh, apex);
  for (std::size_t i = 0; i < loop.size(); ++i)
    mesh.triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
}

/// Cuts ears, those with the shortest diagonal first, as long as the outline seen along `axis` allows it.
void close_by_ears(TriangleMesh& mesh, Loop loop, const Eigen::Vector3d& axis) {
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const auto flat = [&](std::int32_t i) {
    const Point& p = mesh.vertices[static_cast<std::size_t>(i)];
    return Eigen::Vector2d(p.dot(u), p.dot(v));
  };
  const auto turn = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    const Eigen::Vector2d x = flat(b) - flat(a), y = flat(c) - flat(a);
    return x.x() * y.y() - x.y() * y.x();
  };
  while (loop.size() > 3) {
    const std::size_t n = loop.size();
    std::size_t best = n;
    double shortest = 0;
    for (const bool demanding : {true, false}) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::int32_t a = loop[(i + n - 1) % n], b = loop[i], c = loop[(i + 1) % n];
        const double length =
            (mesh.vertices[static_cast<std::size_t>(a)] - mesh.vertices[static_cast<std::size_t>(c)]).norm();
        if (best < n && length >= shortest) continue;
        if (demanding && !(turn(a, b, c) > 0 && std::none_of(loop.begin(), loop.end(), [&](std::int32_t p) {
                             return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                                    turn(c, a, p) >= 0;
                           })))
          continue;
        best = i;
        shortest = length;
      }
      if (best < n) break;
    }
    mesh.triangles.push_back({loop[(best + n - 1) % n], loop[best], loop[(best + 1) % n]});
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(best));
  }
  mesh.triangles.push_back({loop[0], loop[1], loop[2]});
}

/// A row of quads from the loop to a new one.
Loop add_row(TriangleMesh& mesh, const Loop& loop, const std::function<Point(std::size_t)>& place) {
  Loop next;
  for (std::size_t i = 0; i < loop.size(); ++i) next.push_back(add(mesh, place(i)));
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t j = (i + 1) % loop.size();
    mesh.triangles.push_back({loop[i], loop[j], next[j]});
    mesh.triangles.push_back({loop[i], next[j], next[i]});
  }
  return next;
}

void close_by_rings(TriangleMesh& mesh, Loop loop, const Point& centre) {
  constexpr int rings = 6;
  const TriangleMesh open = mesh;
  const Loop rim = loop;
  for (int ring = 1; ring < rings; ++ring)
    loop = add_row(mesh, loop, [&](std::size_t i) -> Point {
      const double s = static_cast<double>(ring) / rings;
      return (1 - s) * open.vertices[static_cast<std::size_t>(rim[i])] + s * centre;
    });
  close_by_fan(mesh, loop, centre);
}

/// Walls down to a plane, and a bottom in it.
void close_by_block(TriangleMesh& mesh, Loop loop, const Eigen::Vector3d& down, int rows, double widening, bool fan) {
  constexpr double height = 5;  // mm
  const TriangleMesh open = mesh;
  const Loop rim = loop;
  const Point centre = mean_of(mesh, loop);
  const auto foot = [&](std::size_t i) -> Point {
    const Point& p = open.vertices[static_cast<std::size_t>(rim[i])];
    const Eigen::Vector3d out = (p - centre) - (p - centre).dot(down) * down;
    return p + (height - (p - centre).dot(down)) * down + widening * out;
  };
  for (int row = 1; row <= rows; ++row)
    loop = add_row(mesh, loop, [&](std::size_t i) -> Point {
      const double s = static_cast<double>(row) / rows;
      return (1 - s) * open.vertices[static_cast<std::size_t>(rim[i])] + s * foot(i);
    });
  if (fan)
    close_by_fan(mesh, loop, mean_of(mesh, loop));
  else
    close_by_ears(mesh, loop, down);
}

/// Some of the triangles from `first` to `last` cut in three, so that walls have no regular rows.
void make_uneven(TriangleMesh& mesh, std::size_t first, std::size_t last) {
  for (std::size_t t = first; t < last; t += 3) {
    const Triangle c = mesh.triangles[t];
    Point middle = Point::Zero();
    for (const int v : c) middle += mesh.vertices[static_cast<std::size_t>(v)] / 3;
    const std::int32_t m = add(mesh, middle);
    mesh.triangles[t] = {c[0], c[1], m};
    mesh.triangles.push_back({c[1], c[2], m});
    mesh.triangles.push_back({c[2], c[0], m});
  }
}

/// The part above a plane, triangles cut there, an edge's length above the border's highest vertex.
TriangleMesh cut_even(const TriangleMesh& crown) {
  const Eigen::Vector3d up = -downward(crown);
  double height = -1e300;
  for (const auto& loop : border_loops(crown))
    for (const int v : loop) height = std::max(height, crown.vertices[static_cast<std::size_t>(v)].dot(up));
  height += mean_edge_length(crown);
  const auto above = [&](int v) { return crown.vertices[static_cast<std::size_t>(v)].dot(up) - height; };
  TriangleMesh cut{crown.vertices, {}};
  std::map<std::pair<int, int>, std::int32_t> made;
  const auto crossing = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [place, fresh] = made.try_emplace({low, high}, static_cast<std::int32_t>(cut.vertices.size()));
    const Point p = crown.vertices[static_cast<std::size_t>(low)], q = crown.vertices[static_cast<std::size_t>(high)];
    if (fresh) cut.vertices.emplace_back(p + above(low) / (above(low) - above(high)) * (q - p));
    return place->second;
  };
  for (const Triangle& t : crown.triangles) {
    Loop polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      if (above(a) >= 0) polygon.push_back(a);
      if ((above(a) >= 0) != (above(b) >= 0)) polygon.push_back(crossing(a, b));
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      cut.triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
  }
  return compact(cut).mesh;
}

/// Vertices and triangles in another order.
ClosedCrown shuffled(const ClosedCrown& closed, std::uint64_t seed) {
  RandomStream random(seed);
  const auto order = [&](std::size_t size) {
    std::vector<std::size_t> places(size);
    std::iota(places.begin(), places.end(), std::size_t{0});
    for (std::size_t i = size; i-- > 1;) std::swap(places[i], places[random.index(i + 1)]);
    return places;
  };
  const auto vertices = order(closed.mesh.vertices.size()), triangles = order(closed.mesh.triangles.size());
  ClosedCrown other;
  other.mesh.vertices.resize(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) other.mesh.vertices[vertices[v]] = closed.mesh.vertices[v];
  for (const std::size_t t : triangles) {
    Triangle& triangle = other.mesh.triangles.emplace_back(closed.mesh.triangles[t]);
    for (std::int32_t& v : triangle) v = static_cast<std::int32_t>(vertices[static_cast<std::size_t>(v)]);
    other.is_cap.push_back(closed.is_cap[t]);
  }
  return other;
}

}  // namespace

std::vector<std::string> base_kinds() {
  return {"fan",  "cone",  "ears",          "corner fan",  "rings",
          "flat", "block", "tapered block", "plain block", "uneven block"};
}

ClosedCrown closed_base(const TriangleMesh& open_crown, const std::string& kind, std::uint64_t shuffling_seed) {
  ClosedCrown closed{kind == "flat" ? cut_even(open_crown) : open_crown, {}};
  TriangleMesh& mesh = closed.mesh;
  closed.is_cap.assign(mesh.triangles.size(), false);
  const Eigen::Vector3d down = downward(mesh);
  Loop loop = base_loop(mesh);
  const Point centre = mean_of(mesh, loop);
  if (kind == "fan") {
    close_by_fan(mesh, loop, centre);
  } else if (kind == "cone") {
    close_by_fan(mesh, loop, centre + 2 * down);
  } else if (kind == "ears" || kind == "flat") {
    close_by_ears(mesh, loop, down);
  } else if (kind == "corner fan") {
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) mesh.triangles.push_back({loop[0], loop[i], loop[i + 1]});
  } else if (kind == "rings") {
    close_by_rings(mesh, loop, centre + 0.8 * down);
  } else if (kind == "block") {
    close_by_block(mesh, loop, down, 10, 0, true);
  } else if (kind == "tapered block") {
    close_by_block(mesh, loop, down, 8, 0.15, true);
  } else if (kind == "plain block") {
    close_by_block(mesh, loop, down, 1, 0, false);
  } else if (kind == "uneven block") {
    const Eigen::Vector3d aslant = down + 0.09 * down.unitOrthogonal();  // 5 degrees
    close_by_block(mesh, loop, aslant.normalized(), 1, 0, false);
    const std::size_t first = closed.is_cap.size();
    make_uneven(mesh, first, first + 2 * loop.size());
  } else {
    throw UsageError("There is no way to close a base called " + kind + ".");
  }
  closed.is_cap.resize(mesh.triangles.size(), true);
  return shuffling_seed == 0 ? closed : shuffled(closed, shuffling_seed);
}

}  // namespace rhizodont::test
