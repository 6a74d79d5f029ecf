// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/weld.hpp"

#include "base/disjoint_sets.hpp"
#include "io/notes.hpp"
#include "mesh/places.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace rhizodont {
namespace {

using Place = std::int32_t;  // the first vertex with the same coordinates

/// An edge of a triangle: its ends' places, lower first, and the vertices there.
struct Side {
  std::array<Place, 2> places{};
  std::array<std::int32_t, 2> vertices{};
  auto operator<=>(const Side&) const = default;
};

/// The corners of a triangle in the order of their places.
struct Corners {
  std::array<Place, 3> places{};
  std::array<std::int32_t, 3> vertices{};
  auto operator<=>(const Corners&) const = default;
};

class SeamWelder {
 public:
  explicit SeamWelder(const TriangleMesh& mesh)
      : mesh_(mesh), places_(first_at_place(mesh.vertices)), merged_(mesh.vertices.size()) {
    is_shared_.assign(places_.size(), false);
    for (std::size_t v = 0; v < places_.size(); ++v)
      if (static_cast<std::size_t>(place(static_cast<std::int32_t>(v))) != v) is_shared_[at(places_[v])] = true;
  }

  /// Per vertex the first of those merged with it.
  std::vector<std::int32_t> weld() {
    join_borders();
    join_twins();
    std::vector<std::int32_t> first(places_.size(), -1), result(places_.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
      std::int32_t& f = first[at(merged_.find(static_cast<int>(v)))];
      if (f < 0) f = static_cast<std::int32_t>(v);
      result[v] = f;
    }
    return result;
  }

 private:
  static std::size_t at(std::int32_t v) { return static_cast<std::size_t>(v); }
  Place place(std::int32_t v) const { return places_[at(v)]; }
  bool is_shared(std::int32_t v) const { return is_shared_[at(place(v))]; }

  // The edges that could be one with another edge.
  std::vector<Side> sides_at_shared_places() {
    std::vector<Side> sides;
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        std::int32_t a = t[i], b = t[(i + 1) % 3];
        if (a == b || (!is_shared(a) && !is_shared(b))) continue;
        if (place(a) == place(b)) {
          merged_.join(a, b);
          continue;
        }
        if (place(a) > place(b)) std::swap(a, b);
        sides.push_back({{place(a), place(b)}, {a, b}});
      }
    std::sort(sides.begin(), sides.end());
    return sides;
  }

  void join_borders() {
    const std::vector<Side> sides = sides_at_shared_places();
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
      const Side* border = nullptr;  // an edge here that has one triangle
      for (end = begin; end < sides.size() && sides[end].places == sides[begin].places;) {
        std::size_t next = end;
        while (next < sides.size() && sides[next] == sides[end]) ++next;
        if (next - end == 1) {
          if (border != nullptr)
            for (std::size_t i = 0; i < 2; ++i) merged_.join(border->vertices[i], sides[end].vertices[i]);
          border = &sides[end];
        }
        end = next;
      }
    }
  }

  // Triangles at the same place, whichever way they face: a surface given twice is to be seen as that.
  void join_twins() {
    std::vector<Corners> triangles;
    for (Triangle t : mesh_.triangles) {
      if (!is_shared(t[0]) && !is_shared(t[1]) && !is_shared(t[2])) continue;
      std::sort(t.begin(), t.end(), [&](std::int32_t a, std::int32_t b) { return place(a) < place(b); });
      triangles.push_back({{place(t[0]), place(t[1]), place(t[2])}, t});
    }
    std::sort(triangles.begin(), triangles.end());
    for (std::size_t k = 1; k < triangles.size(); ++k)
      if (triangles[k].places == triangles[k - 1].places)
        for (std::size_t i = 0; i < 3; ++i) merged_.join(triangles[k - 1].vertices[i], triangles[k].vertices[i]);
  }

  const TriangleMesh& mesh_;
  std::vector<Place> places_;
  std::vector<bool> is_shared_;  // per place
  DisjointSets merged_;
};

template <class T>
void keep_entries(std::vector<T>& entries, const std::vector<int>& kept) {
  for (std::size_t k = 0; k < kept.size(); ++k) entries[k] = entries[static_cast<std::size_t>(kept[k])];
  entries.resize(kept.size());
}

}  // namespace

std::size_t EqualPoints::Hash::operator()(const Key& key) const {
  std::uint64_t h = 0;
  for (const std::uint64_t part : key) {
    h = (h ^ part) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
  }
  return h;
}

std::int32_t EqualPoints::number_in(const Point& point, std::vector<Point>& points) {
  Key key{};
  for (std::size_t i = 0; i < 3; ++i)
    key[i] = std::bit_cast<std::uint64_t>(point[static_cast<Eigen::Index>(i)] + 0.0);  // -0 becomes +0
  const auto [place, is_new] = numbers_.try_emplace(key, static_cast<std::int32_t>(points.size()));
  if (is_new) points.push_back(point);
  return place->second;
}

void weld_seams(MeshFile& file) {
  TriangleMesh& mesh = file.mesh;
  const std::vector<std::int32_t> first = SeamWelder(mesh).weld();
  std::vector<int> kept;
  std::vector<std::int32_t> number(first.size());
  for (std::size_t v = 0; v < first.size(); ++v) {
    if (static_cast<std::size_t>(first[v]) == v) kept.push_back(static_cast<int>(v));
    number[v] = static_cast<std::size_t>(first[v]) == v ? static_cast<std::int32_t>(kept.size()) - 1
                                                        : number[static_cast<std::size_t>(first[v])];
  }
  if (kept.size() == first.size()) return;
  for (Triangle& t : mesh.triangles)
    for (std::int32_t& v : t) v = number[static_cast<std::size_t>(v)];
  keep_entries(mesh.vertices, kept);
  for (auto& [name, attribute] : file.vertex_attributes) keep_entries(attribute.values, kept);
  file.notes.push_back(counted(first.size() - kept.size(), "vertex was", "vertices were") +
                       " merged with another one at exactly the same place.");
  file.file_vertices = std::move(kept);
  file.mesh_vertices.assign(number.begin(), number.end());
}

}  // namespace rhizodont
