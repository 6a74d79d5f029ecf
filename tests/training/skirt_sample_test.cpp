// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/skirt_sample.hpp"

#include "families/gum_flange.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/closest_point.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace rhizodont {
namespace {

/// Upper part of a ball, 8 mm wide, its border on a plane.
TriangleMesh dome() {
  TriangleMesh mesh = test::sphere(4, 4);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(),
                       [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)].z() < -1e-9; });
  });
  return compact(mesh).mesh;
}

double lowest(const TriangleMesh& mesh) {
  double z = 1e9;
  for (const Point& p : mesh.vertices) z = std::min(z, p.z());
  return z;
}

TEST(GumFlange, GoesOnFromTheBorderAndLeavesTheCrownAlone) {
  const TriangleMesh crown = dome();
  for (const FlangeKind kind : {FlangeKind::band, FlangeKind::webs, FlangeKind::parts, FlangeKind::lip}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      RandomStream random(seed);
      const Flange flange = add_flange(crown, kind, random);
      ASSERT_EQ(flange.outwards.size(), flange.mesh.vertices.size());
      EXPECT_EQ(flange.crown_triangles, crown.triangles.size());
      for (std::size_t v = 0; v < crown.vertices.size(); ++v) {
        EXPECT_EQ(flange.mesh.vertices[v], crown.vertices[v]);
        EXPECT_EQ(flange.outwards[v], 0);
      }
      const Diagnosis diagnosis = diagnose(flange.mesh);
      EXPECT_TRUE(diagnosis.is_oriented_manifold());
      EXPECT_EQ(diagnosis.euler_number, 1);
      EXPECT_EQ(diagnosis.border_loop_count, 1);
    }
  }
}

TEST(GumFlange, BandsGoOutAndDownLipsGoIn) {
  const TriangleMesh crown = dome();
  double band = 0, lip = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomStream one(seed), other(seed);
    const Flange outer = add_flange(crown, FlangeKind::band, one), inner = add_flange(crown, FlangeKind::lip, other);
    for (const Point& p : outer.mesh.vertices) band = std::max(band, p.head<2>().norm());
    for (std::size_t v = crown.vertices.size(); v < inner.mesh.vertices.size(); ++v)
      lip = std::max(lip, inner.mesh.vertices[v].head<2>().norm());
    EXPECT_LT(lowest(outer.mesh), -0.1);
  }
  EXPECT_GT(band, 4.5);
  EXPECT_LT(lip, 4.05);
}

TEST(LabelByRestored, FindsWhatCoincides) {
  const TriangleMesh ball = test::sphere(4, 4);
  TriangleMesh crown = dome();
  const std::size_t tooth = crown.vertices.size();
  for (int i = 0; i < 3; ++i) crown.vertices.emplace_back(4.5 + i, i, 0.1);
  const auto labels = label_by_restored(crown, ball, 0.02);
  for (std::size_t v = 0; v < labels.size(); ++v) EXPECT_EQ(labels[v], v < tooth ? 1 : 0);
  EXPECT_EQ(label_by_restored(crown, ball, 9), std::vector<std::uint8_t>(labels.size(), 1));
  EXPECT_THROW(label_by_restored(crown, ball, 0), UsageError);
}

TEST(LabelledFiles, SayWhatIsTooth) {
  SkirtSample sample;
  sample.mesh = dome();
  sample.is_tooth.assign(sample.mesh.vertices.size(), 1);
  sample.is_tooth[3] = 0;
  const std::vector<double> wanted(sample.is_tooth.begin(), sample.is_tooth.end());
  EXPECT_EQ(skirt_sample_file(sample).vertex_attributes.at("tooth").values, wanted);
  MeshFile crown;
  crown.mesh = sample.mesh;
  crown.triangle_attributes["label"] = {AttributeType::uint8, std::vector<double>(crown.mesh.triangles.size(), 11)};
  const MeshFile labelled = labelled_crown_file(crown, sample.is_tooth);
  EXPECT_EQ(labelled.vertex_attributes.at("tooth").values, wanted);
  EXPECT_TRUE(labelled.triangle_attributes.empty());
}

class SkirtSamples : public ::testing::Test {
 protected:
  static inline const std::filesystem::path data = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "../shared/data";

  void SetUp() override {
    if (!std::filesystem::exists(data / "templates" / "tooth_21.ply")) GTEST_SKIP() << "no template teeth in " << data;
  }
  static const ToothFamilies& families() {
    static const ToothFamilies loaded = [] {
      FamilyLoadOptions options;
      options.types = {8, 13};
      options.crown_modes = 0;
      return load_tooth_families(data, options);
    }();
    return loaded;
  }
};

TEST_F(SkirtSamples, AreOnePieceLabelledAndVaried) {
  int with_skirt = 0, with_holes = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SkirtSampleOptions options;
    options.type = seed % 2 == 0 ? 8 : 13;
    const SkirtSample sample = make_skirt_sample(families(), seed, options);
    const Diagnosis diagnosis = diagnose(sample.mesh);
    EXPECT_TRUE(diagnosis.is_valid());
    EXPECT_TRUE(diagnosis.non_manifold_edges.empty());
    EXPECT_TRUE(diagnosis.misoriented_edges.empty());
    EXPECT_TRUE(diagnosis.unreferenced_vertices.empty());
    EXPECT_EQ(connected_components(sample.mesh).count, 1);
    ASSERT_EQ(sample.is_tooth.size(), sample.mesh.vertices.size());
    const auto skirt = std::count(sample.is_tooth.begin(), sample.is_tooth.end(), 0);
    if (!sample.has_skirt) {
      EXPECT_EQ(skirt, 0);
    }
    with_skirt += skirt > 0;
    with_holes += diagnosis.border_loop_count > 1;
    EXPECT_GT(area_vector(sample.mesh).z(), 0);
    const double edge = mean_edge_length(sample.mesh);
    EXPECT_GT(edge, 0.2);
    EXPECT_LT(edge, 0.9);
  }
  EXPECT_GE(with_skirt, 9);
  EXPECT_LE(with_skirt, 22);
  EXPECT_GE(with_holes, 2);
}

TEST_F(SkirtSamples, DependOnTheSeedAlone) {
  SkirtSampleOptions options;
  options.type = 8;
  const SkirtSample a = make_skirt_sample(families(), 5, options), b = make_skirt_sample(families(), 5, options);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.is_tooth, b.is_tooth);
  EXPECT_NE(make_skirt_sample(families(), 6, options).mesh.vertices, a.mesh.vertices);
  options.finest_edge_mm = 2;
  EXPECT_THROW(make_skirt_sample(families(), 5, options), UsageError);
}

}  // namespace
}  // namespace rhizodont
