// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "skirt/ragged_part.hpp"

#include "mesh/adjacency.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/handles.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rhizodont {
namespace {

/// A dome of radius 5 mm, open below, edges of about 0.5 mm.
TriangleMesh crown() { return test::dome(4, 5); }

int nearest(const TriangleMesh& mesh, const Point& p) {
  int best = 0;
  for (int v = 1; v < static_cast<int>(mesh.vertices.size()); ++v)
    if ((mesh.vertices[static_cast<std::size_t>(v)] - p).norm() <
        (mesh.vertices[static_cast<std::size_t>(best)] - p).norm())
      best = v;
  return best;
}

/// The triangles about the top.
std::vector<std::size_t> at_top(const TriangleMesh& mesh) {
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::all_of(mesh.triangles[t].begin(), mesh.triangles[t].end(),
                    [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)].z() > 4.7; }))
      found.push_back(t);
  return found;
}

int dropped_vertices(const TriangleMesh& mesh, const std::vector<bool>& keep) {
  return static_cast<int>(compact(mesh).mesh.vertices.size()) -
         static_cast<int>(submesh(mesh, keep).mesh.vertices.size());
}

/// A strip of two triangles between two edges of the border, across the opening.
void add_bridge(TriangleMesh& mesh, const Point& here, const Point& there) {
  const auto edge_at = [&](const Point& p) {
    std::pair<int, int> best{-1, -1};
    double nearest = 1e9;
    for (const BorderPiece& piece : border_pieces(mesh))
      for (const auto& h : piece.half_edges) {
        const double distance = (mesh.vertices[static_cast<std::size_t>(h.first)] - p).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        best = h;
      }
    return best;
  };
  const auto [a, b] = edge_at(here);
  const auto [c, d] = edge_at(there);
  mesh.triangles.push_back({b, a, d});
  mesh.triangles.push_back({b, d, c});
}

TEST(SoundTriangles, AreAllOfASoundCrown) {
  const std::vector<bool> sound = sound_triangles(crown());
  EXPECT_TRUE(std::all_of(sound.begin(), sound.end(), [](bool s) { return s; }));
}

TEST(SoundTriangles, AreNoneAtCrowdedEdgesAndOfOtherPieces) {
  TriangleMesh mesh = crown();
  const Triangle t = mesh.triangles[at_top(mesh).front()];
  const auto before = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(9, 9, 9);
  mesh.triangles.push_back({t[0], t[1], before});  // a fin
  for (const Point& p : {Point(9, 0, 0), Point(9, 1, 0), Point(9, 0, 1)}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({before + 1, before + 2, before + 3});  // a speck
  mesh.triangles.push_back(mesh.triangles[5]);                     // a copy
  const std::vector<bool> sound = sound_triangles(mesh);
  EXPECT_TRUE(diagnose(submesh(mesh, sound).mesh).is_oriented_manifold());
  EXPECT_EQ(diagnose(submesh(mesh, sound).mesh).components, 1);
  EXPECT_EQ(std::count(sound.begin(), sound.end(), false), 2 + 3);
}

TEST(SoundTriangles, APatchTurnedOverIsAnotherPiece) {
  TriangleMesh mesh = crown();
  const std::vector<std::size_t> patch = at_top(mesh);
  ASSERT_GT(patch.size(), 10U);
  for (const std::size_t t : patch) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const std::vector<bool> sound = sound_triangles(mesh);
  EXPECT_EQ(std::count(sound.begin(), sound.end(), false), static_cast<std::ptrdiff_t>(patch.size()));
  for (const std::size_t t : patch) EXPECT_FALSE(sound[t]);
}

TEST(RaggedDefects, OfACleanCrownAreNone) {
  const std::vector<bool> keep = triangles_without_ragged_defects(crown());
  EXPECT_TRUE(std::all_of(keep.begin(), keep.end(), [](bool k) { return k; }));
}

TEST(RaggedDefects, HandlesAcrossTheOpeningAreOpened) {
  TriangleMesh mesh = crown();
  add_bridge(mesh, {5, 0, 0}, {-5, 0, 0});
  add_bridge(mesh, {0, 5, -0.1}, {0, -5, -0.1});  // over the first: two loops become one
  ASSERT_EQ(handle_count(mesh), 1);
  const std::vector<bool> keep = triangles_without_ragged_defects(mesh);
  EXPECT_EQ(handle_count(submesh(mesh, keep).mesh), 0);
  EXPECT_LE(dropped_vertices(mesh, keep), 2);
}

TEST(RaggedDefects, ATunnelThroughTheToothStays) {
  TriangleMesh mesh = test::torus(40, 24, 4, 1.5);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return (mesh.vertices[static_cast<std::size_t>(t[0])] - Point(5.5, 0, 0)).norm() < 1;
  });
  ASSERT_EQ(handle_count(mesh), 1);
  EXPECT_EQ(handle_count(submesh(mesh, triangles_without_ragged_defects(mesh)).mesh), 1);
}

TEST(RaggedDefects, AreTakenOffWhereTheSurfaceCutsItselfNearTheBorder) {
  for (const bool near_border : {true, false}) {
    TriangleMesh mesh = crown();
    const int v = nearest(mesh, near_border ? Point(5, 0, 0.4) : Point(0, 0, 5));
    const int w = nearest(mesh, near_border ? Point(4.9, 0.6, 0.4) : Point(0.6, 0, 5));
    std::swap(mesh.vertices[static_cast<std::size_t>(v)], mesh.vertices[static_cast<std::size_t>(w)]);
    ASSERT_FALSE(self_intersecting_triangles(mesh).empty());
    const Submesh part = submesh(mesh, triangles_without_ragged_defects(mesh));
    EXPECT_EQ(self_intersecting_triangles(part.mesh).empty(), near_border);
    EXPECT_GT(part.mesh.triangles.size(), mesh.triangles.size() - 40);
  }
}

TEST(RaggedDefects, CrowdedEdgesAndTouchingVerticesNearTheBorderGo) {
  TriangleMesh mesh = crown();
  const int a = nearest(mesh, {5, 0, 0}), b = nearest(mesh, {4.4, 2.4, 0}), c = nearest(mesh, {3.6, 3.6, 0});
  const auto beside = std::find_if(mesh.triangles.begin(), mesh.triangles.end(),
                                   [&](const Triangle& t) { return std::find(t.begin(), t.end(), a) != t.end(); });
  const Triangle t = *beside;
  mesh.triangles.push_back({t[0], t[1], b});
  mesh.triangles.push_back({t[1], t[2], c});
  ASSERT_FALSE(diagnose(mesh).is_oriented_manifold());
  const std::vector<bool> keep = triangles_without_ragged_defects(mesh);
  EXPECT_TRUE(diagnose(submesh(mesh, keep).mesh).is_oriented_manifold());
  EXPECT_LE(dropped_vertices(mesh, keep), 4);
}

TEST(Slits, AreOpenedNearTheBorderAlone) {
  const TriangleMesh slit = test::slit_dome(4, 5, 1e-3);
  RaggedPartOptions options;
  EXPECT_LT(dropped_vertices(slit, triangles_without_slits(slit, options)), 8);  // its ends come near the base
  options.depth = 100;
  const TriangleMesh opened = submesh(slit, triangles_without_slits(slit, options)).mesh;
  // Where two sides stood 1e-3 mm apart, there is a gap of two rows of triangles.
  const auto pieces = border_pieces(opened);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_GT(pieces[1 - base_piece(pieces)].area_vector.norm(), 2);
  const std::vector<bool> all = triangles_without_slits(crown());
  EXPECT_EQ(std::count(all.begin(), all.end(), false), 0);
  options.slit = 2;
  EXPECT_THROW(triangles_without_slits(crown(), options), UsageError);
}

TEST(RaggedDefects, OptionsAreLookedAt) {
  RaggedPartOptions options;
  options.depth = -1;
  EXPECT_THROW(triangles_without_ragged_defects(crown(), options), UsageError);
  options = {};
  options.rounds = 0;
  EXPECT_THROW(triangles_without_ragged_defects(crown(), options), UsageError);
}

}  // namespace
}  // namespace rhizodont
