// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "fusion/fuse.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/diagnosis.hpp"
#include "mesh/geometry.hpp"
#include "mesh/quality.hpp"
#include "mesh/self_intersection.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/prepared_crown.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>

namespace rhizodont {
namespace {

/// The triangles all of whose vertices satisfy `keep`.
TriangleMesh part(const TriangleMesh& mesh, const std::function<bool(const Point&)>& keep) {
  std::vector<bool> mask;
  for (const Triangle& t : mesh.triangles) {
    bool all = true;
    for (const int v : t) all = all && keep(mesh.vertices[static_cast<std::size_t>(v)]);
    mask.push_back(all);
  }
  return submesh(mesh, mask).mesh;
}

/// A turned copy of a sphere's triangulation, so that guiding surface and crown share no vertex.
TriangleMesh turned(TriangleMesh mesh) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.37, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (Point& p : mesh.vertices) p = turn * p;
  return mesh;
}

JoinedTooth complete(const TriangleMesh& crown, const TriangleMesh& surface, const Eigen::Vector3d& axis) {
  return fuse_crown_and_root(prepare_crown(crown), surface, axis).tooth;
}

void expect_promises(const TriangleMesh& crown, const JoinedTooth& tooth) {
  ASSERT_GE(tooth.mesh.vertices.size(), crown.vertices.size());
  ASSERT_GE(tooth.mesh.triangles.size(), crown.triangles.size());
  for (std::size_t v = 0; v < crown.vertices.size(); ++v) ASSERT_EQ(tooth.mesh.vertices[v], crown.vertices[v]) << v;
  for (std::size_t t = 0; t < crown.triangles.size(); ++t) ASSERT_EQ(tooth.mesh.triangles[t], crown.triangles[t]) << t;
  const Diagnosis diagnosis = diagnose(tooth.mesh);
  EXPECT_TRUE(diagnosis.border_edges.empty());
  EXPECT_TRUE(diagnosis.non_manifold_edges.empty());
  EXPECT_TRUE(diagnosis.non_manifold_vertices.empty());
  EXPECT_EQ(diagnosis.components, 1);
  EXPECT_EQ(diagnosis.euler_number, 2);
  EXPECT_GT(volume(tooth.mesh), 0);
  EXPECT_TRUE(self_intersecting_triangles(tooth.mesh).empty());
}

TEST(Fusion, SphereCapBecomesClosedAndKeepsItsTriangles) {
  const TriangleMesh crown = part(test::sphere(4, 5), [](const Point& p) { return p.z() > 0.3; });
  const TriangleMesh surface = turned(test::sphere(5, 5));
  const JoinedTooth tooth = complete(crown, surface, Eigen::Vector3d::UnitZ());
  expect_promises(crown, tooth);
  EXPECT_NEAR(volume(tooth.mesh), 4.0 / 3 * M_PI * 125, 10);
}

TEST(Fusion, CrownWithAnInnerHoleIsFilled) {
  const TriangleMesh crown =
      part(test::sphere(4, 5), [](const Point& p) { return p.z() > 0.3 && (p - Point(3, 0, 4)).norm() > 1.2; });
  ASSERT_EQ(border_loops(crown).size(), 2U);
  expect_promises(crown, complete(crown, turned(test::sphere(5, 5)), Eigen::Vector3d::UnitZ()));
}

TEST(Fusion, ASlitIsFilledAndNotTakenForTheBase) {
  const TriangleMesh surface = turned(test::sphere(5, 5));
  const JoinedTooth whole = complete(test::dome(4, 5), surface, Eigen::Vector3d::UnitZ());
  for (const double gap : {1e-3, 0.02}) {
    const TriangleMesh crown = test::slit_dome(4, 5, gap);
    const JoinedTooth tooth = complete(crown, surface, Eigen::Vector3d::UnitZ());
    expect_promises(crown, tooth);
    EXPECT_NEAR(volume(tooth.mesh), 4.0 / 3 * M_PI * 125, 10);
    // Mending comes to an end in a slit.
    EXPECT_LT(tooth.mesh.triangles.size(), 8 * whole.mesh.triangles.size() / 5);
  }
}

TEST(Fusion, RaggedBorder) {
  const TriangleMesh crown = part(
      test::sphere(4, 5), [](const Point& p) { return p.z() > 0.4 + 0.8 * std::cos(9 * std::atan2(p.y(), p.x())); });
  expect_promises(crown, complete(crown, turned(test::sphere(5, 5)), Eigen::Vector3d::UnitZ()));
}

TEST(Fusion, SeveralHolesAndCocircularVertices) {
  // Rings of a ball by latitude and longitude: every four neighbouring vertices lie on one circle, all on one sphere.
  TriangleMesh crown;
  constexpr int around = 60, rings = 18;
  for (int r = 0; r < rings; ++r)
    for (int i = 0; i < around; ++i) {
      const double polar = (r + 2) * M_PI / 40, turn = 2 * M_PI * i / around;
      crown.vertices.emplace_back(5 * std::sin(polar) * std::cos(turn), 5 * std::sin(polar) * std::sin(turn),
                                  5 * std::cos(polar));
    }
  for (int r = 0; r + 1 < rings; ++r)
    for (int i = 0; i < around; ++i) {
      if (r > 8 && r < 12 && (i % 30) < 4) continue;  // two holes; a third around the pole
      const int a = r * around + i, b = r * around + (i + 1) % around;
      crown.triangles.push_back({a, a + around, b});
      crown.triangles.push_back({b, a + around, b + around});
    }
  crown = compact(crown).mesh;
  ASSERT_EQ(border_loops(crown).size(), 4U);
  expect_promises(crown, complete(crown, turned(test::sphere(5, 5)), Eigen::Vector3d::UnitZ()));
}

TEST(Fusion, NeedleTriangles) {
  // Vertices put on edges, beside their ends, make triangles with angles of about 0.1 degrees.
  TriangleMesh crown = part(test::sphere(4, 5), [](const Point& p) { return p.z() > 0.3; });
  const std::size_t before = crown.triangles.size();
  for (std::size_t t = 0; t < before; t += 40) {
    const auto [a, b, c] = crown.triangles[t];
    const Point middle = (crown.vertices[static_cast<std::size_t>(a)] + crown.vertices[static_cast<std::size_t>(b)] +
                          crown.vertices[static_cast<std::size_t>(c)]) /
                         3;
    const int m = static_cast<int>(crown.vertices.size());
    crown.vertices.push_back(crown.vertices[static_cast<std::size_t>(a)] +
                             0.002 * (middle - crown.vertices[static_cast<std::size_t>(a)]));
    crown.triangles[t] = {a, b, m};
    crown.triangles.push_back({b, c, m});
    crown.triangles.push_back({c, a, m});
  }
  expect_promises(crown, complete(crown, turned(test::sphere(5, 5)), Eigen::Vector3d::UnitZ()));
}

/// A crown with teeth along its border, and a guiding surface with folds around it that the root is hard to join on.
FusedTooth fuse_with_folds(double depth, const FuseOptions& options) {
  const TriangleMesh crown = part(
      test::sphere(4, 5), [](const Point& p) { return p.z() > 0.4 + 0.8 * std::cos(9 * std::atan2(p.y(), p.x())); });
  TriangleMesh surface = turned(test::sphere(5, 5));
  for (Point& p : surface.vertices)
    p *= 1 + depth / 5 * std::exp(-std::pow((p.z() - 0.3) / 0.6, 2)) * std::sin(15 * std::atan2(p.y(), p.x()));
  const FusedTooth fused = fuse_crown_and_root(prepare_crown(crown), surface, Eigen::Vector3d::UnitZ(), options);
  expect_promises(crown, fused.tooth);
  return fused;
}

/// Gives up early where steps would break the tooth.
FuseOptions impatient() {
  FuseOptions options;
  options.other_growths.clear();
  options.restore.rounds = 0;
  options.remesh_attempts = 1;
  options.transition.cut_rounds = 1;
  return options;
}

TEST(Fusion, AFurtherAttemptSaysNothingOfWhatTheOneBeforeCounted) {
  const FusedTooth second = fuse_with_folds(4, impatient());
  ASSERT_FALSE(second.warnings.empty());
  EXPECT_EQ(second.warnings.back(),
            "The root was started farther from the crown's border: The tooth cuts itself at the seam.");
  FuseOptions farther = impatient();
  farther.separation.clearance = 1.6 * farther.separation.clearance + 0.15;  // where the second attempt begins
  farther.attempts = 1;
  const FusedTooth alone = fuse_with_folds(4, farther);
  EXPECT_EQ(second.tooth.mesh.vertices, alone.tooth.mesh.vertices);
  EXPECT_EQ(second.tooth.mesh.triangles, alone.tooth.mesh.triangles);
  EXPECT_EQ(std::vector<std::string>(second.warnings.begin(), second.warnings.end() - 1), alone.warnings);
  EXPECT_EQ(second.root_sites, alone.root_sites);
  EXPECT_EQ(second.remeshing.splits, alone.remeshing.splits);
  EXPECT_EQ(second.tooth.triangles_filled, alone.tooth.triangles_filled);
}

TEST(Fusion, RemeshingThatWasGivenUpCountsNothing) {
  const FusedTooth fused = fuse_with_folds(2.5, impatient());
  ASSERT_FALSE(fused.warnings.empty());
  EXPECT_EQ(fused.warnings.front(), "The root's triangles could not be improved.");
  EXPECT_EQ(fused.remeshing.splits + fused.remeshing.collapses + fused.remeshing.flips + fused.remeshing.mended, 0);
}

TEST(Fusion, StepByStepNothingIsLostWhereOneStepAloneWouldBreakTheTooth) {
  // Remeshed at once the tooth would cut itself: where only one attempt is allowed, it is left out. With patience the
  // triangles about the place are left alone, and all others improved.
  const FusedTooth hasty = fuse_with_folds(1, impatient());
  EXPECT_EQ(hasty.warnings, std::vector<std::string>{"The root's triangles could not be improved."});
  FuseOptions patient;
  patient.other_growths.clear();
  const FusedTooth fused = fuse_with_folds(1, patient);
  EXPECT_TRUE(fused.warnings.empty());
  EXPECT_GT(fused.remeshing.flips, 0);
  EXPECT_GT(fused.remeshing.mended, 0);
  EXPECT_FALSE(fused.transition.cuts_itself);
}

TEST(Fusion, ASeamThatCannotBeSmoothedWhollyIsSaid) {
  FuseOptions options;
  options.other_growths.clear();
  const FusedTooth smooth = fuse_with_folds(0.5, options), folded = fuse_with_folds(2, options);
  EXPECT_GE(smooth.transition.applied, 0.9);
  EXPECT_TRUE(smooth.warnings.empty());
  EXPECT_LT(folded.transition.applied, 0.9);
  const auto percent = std::to_string(std::lround(100 * folded.transition.applied));
  EXPECT_EQ(folded.warnings,
            std::vector<std::string>{"The seam between crown and root was smoothed to " + percent + " % only."});
}

TEST(Fusion, WithoutFurtherAttemptsTheReasonOfTheLastIsTheError) {
  FuseOptions once = impatient();
  once.attempts = 1;
  try {
    fuse_with_folds(4, once);
    FAIL() << "was joined";
  } catch (const NoResultError& error) {
    EXPECT_STREQ(error.what(), "The tooth cuts itself at the seam.");
  }
}

/// The smallest angle of new triangles over what is wanted there.
double least_share(const FusedTooth& fused) {
  const TransitionOptions wanted;
  const JoinedTooth& tooth = fused.tooth;
  double least = 100;
  for (auto t = static_cast<std::size_t>(tooth.crown_triangles); t < tooth.mesh.triangles.size(); ++t) {
    const Triangle& corners = tooth.mesh.triangles[t];
    const bool touches = *std::min_element(corners.begin(), corners.end()) < tooth.crown_vertices;
    for (const double angle : triangle_angles(tooth.mesh, t))
      least = std::min(least, angle * 180 / M_PI / (touches ? wanted.border_angle : wanted.inner_angle));
  }
  return least;
}

TEST(Fusion, OfSeveralGrowthsTheBestToothIsTaken) {
  FuseOptions one;
  one.other_growths.clear();
  FuseOptions other = one;
  other.edge_growth = 0.6;
  const double first = least_share(fuse_with_folds(3, one)), second = least_share(fuse_with_folds(3, other));
  ASSERT_LT(first, 1) << "else no other is tried";
  one.other_growths = {0.6};
  EXPECT_EQ(least_share(fuse_with_folds(3, one)), std::max(first, second));
  other.other_growths = {0.9};
  EXPECT_EQ(least_share(fuse_with_folds(3, other)), second >= 1 ? second : std::max(first, second));
}

TEST(Fusion, OptionsOutOfRange) {
  const TriangleMesh crown = test::dome(2, 5), surface = test::sphere(3, 5);
  const std::vector<std::function<void(FuseOptions&)>> faults{
      [](FuseOptions& o) { o.edge_growth = 0; },     [](FuseOptions& o) { o.edge_shrinkage = -1; },
      [](FuseOptions& o) { o.attempts = 0; },        [](FuseOptions& o) { o.remesh_attempts = 0; },
      [](FuseOptions& o) { o.other_growths = {0}; }, [](FuseOptions& o) { o.transition.cut_rounds = 0; },
      [](FuseOptions& o) { o.sites.spacing = 1; },   [](FuseOptions& o) { o.separation.epsilon = 0; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    FuseOptions options;
    faults[i](options);
    EXPECT_THROW(fuse_crown_and_root(prepare_crown(crown), surface, Eigen::Vector3d::UnitZ(), options), UsageError)
        << i;
  }
}

TEST(Fusion, ASurfaceWithoutARootIsRefused) {
  // Wholly inside of the crown's clearance: no vertex of it is root.
  const TriangleMesh crown = test::dome(3, 5);
  EXPECT_THROW(fuse_crown_and_root(prepare_crown(crown), test::sphere(2, 0.05), Eigen::Vector3d::UnitZ(), {}), Error);
}

TEST(Fusion, ARootThatIsClosedByItselfIsNotJoined) {
  const TriangleMesh crown = test::dome(2, 5);
  Joining joining;
  joining.sites = crown.vertices;
  joining.crown_vertices = static_cast<int>(crown.vertices.size());
  const TriangleMesh ball = test::sphere(1, 2);
  for (const Point& p : ball.vertices) joining.sites.push_back(p - Point(0, 0, 6));
  for (Triangle t : ball.triangles) {
    for (std::int32_t& v : t) v += joining.crown_vertices;
    joining.triangles.push_back(t);
  }
  try {
    restore_crown(crown, joining);
    FAIL() << "joined";
  } catch (const NoResultError& error) {
    EXPECT_STREQ(error.what(), "The predicted root is closed by itself and does not meet the crown.");
  }
  // With an opening towards the crown it is.
  joining.triangles.erase(joining.triangles.begin());
  expect_promises(crown, restore_crown(crown, joining));
  joining.triangles.clear();
  EXPECT_THROW(restore_crown(crown, joining), NoResultError) << "no root at all";
}

TEST(Fusion, ClosedCrownIsRefused) {
  const TriangleMesh ball = test::sphere(3, 5);
  EXPECT_THROW(fuse_crown_and_root(prepare_crown(ball), ball, Eigen::Vector3d::UnitZ()), InputError);
}

TEST(Fusion, ValidationCrownsOnTheirOwnTeeth) {
  const std::filesystem::path folder = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "../shared/data/validation";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no validation teeth at " << folder;
  for (const int fdi : {31, 33, 36, 45}) {
    const TriangleMesh crown = load_mesh(folder / ("crown_" + std::to_string(fdi) + ".ply")).mesh;
    TriangleMesh surface = load_mesh(folder / ("tooth_" + std::to_string(fdi) + ".ply")).mesh;
    // A guiding surface never meets the crown's vertices exactly.
    for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      surface.vertices[v] += 0.01 * Eigen::Vector3d(std::sin(3.0 * v), std::sin(5.0 * v), std::sin(7.0 * v));
    SCOPED_TRACE(fdi);
    const JoinedTooth tooth = complete(crown, surface, area_vector(crown).normalized());
    expect_promises(crown, tooth);
    EXPECT_LT(tooth.triangles_brought_back, 0.01 * tooth.crown_triangles);
  }
}

}  // namespace
}  // namespace rhizodont
