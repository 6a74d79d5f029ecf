// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Whatever is given as a crown: a tooth that keeps the promises, or a reason why there is none.

#include "common/hostile_crowns.hpp"
#include "common/hostile_outcome.hpp"
#include "mesh/geometry.hpp"
#include "mesh/pieces.hpp"
#include "mesh/test_meshes.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

namespace rhizodont {
namespace {

using test::models;
using test::source_folder;

CompleteOptions coarse(int fdi) {
  CompleteOptions options = test::for_tooth(fdi);
  options.e = 1;
  return options;
}

/// 0 for a tooth that keeps the promises, else the exit code of a typed error that tells a reason.
int outcome(const TriangleMesh& crown, const CompleteOptions& options) {
  using Kind = test::HostileOutcome::Kind;
  const test::HostileOutcome outcome = test::outcome_of(crown, models(), options);
  EXPECT_TRUE(outcome.kind != Kind::broken && outcome.kind != Kind::other_error) << outcome.sentence;
  if (outcome.kind == Kind::made || outcome.kind == Kind::warned) return 0;
  return outcome.kind == Kind::unusable ? 3 : 4;
}

/// How many of the three crowns of a kind (a molar, a canine, a molar with repair) become teeth at least. Where none
/// has to, the crown is none any more, or its surface cuts itself in so many places that it is refused.
int least_teeth(const std::string& kind) {
  static const std::map<std::string, int> known{{"duplicate vertices", 1},
                                                {"duplicate triangles", 1},
                                                {"degenerate triangles", 1},
                                                {"T-junctions", 2},
                                                {"non-manifold edges", 1},
                                                {"bridges", 1},
                                                {"handles", 1},
                                                {"islands", 2},
                                                {"self-intersections", 1},
                                                {"flipped patches", 1},
                                                {"distortion", 1},
                                                {"cut off", 1},
                                                {"scrap", 0},
                                                {"combination", 0}};
  const auto found = known.find(kind);
  return found == known.end() ? 3 : found->second;
}

class HostileCrowns : public testing::TestWithParam<std::string> {};

TEST_P(HostileCrowns, GiveAToothOrAReason) {
  const TriangleMesh molar = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 600);
  const TriangleMesh canine = test::coarsened_to(load_mesh(source_folder / "samples/crown_23.ply").mesh, 300);
  int teeth = 0;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(GetParam() + ", seed " + std::to_string(seed));
    const bool is_molar = seed % 2 == 0;
    CompleteOptions options = coarse(is_molar ? 36 : 23);
    options.repair = seed == 2;
    teeth += static_cast<int>(outcome(test::hostile_crown(is_molar ? molar : canine, GetParam(), seed), options) == 0);
  }
  EXPECT_GE(teeth, least_teeth(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, HostileCrowns, testing::ValuesIn(test::hostile_kinds()), [](const auto& kind) {
  std::string name;
  for (const char c : kind.param)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
  return name;
});

TEST(HostileCrown, ACleanOneOfAHundredVerticesIsCompleted) {
  const TriangleMesh molar = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 100);
  EXPECT_EQ(outcome(molar, coarse(36)), 0);
}

TEST(HostileCrown, RepairMakesAToothOfWhatIsRefusedOtherwise) {
  const TriangleMesh molar = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 600);
  CompleteOptions repaired = coarse(36);
  repaired.repair = true;
  for (const std::string kind : {"duplicate vertices", "non-manifold edges", "flipped patches"}) {
    SCOPED_TRACE(kind);
    const TriangleMesh crown = test::hostile_crown(molar, kind, 1);
    try {
      complete_tooth(crown, models(), coarse(36));
      ADD_FAILURE() << "was not refused";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("--repair"), std::string::npos) << error.what();
    }
    EXPECT_EQ(outcome(crown, repaired), 0);
  }
}

TEST(HostileCrown, IslandsGoUnlessTheyAreOfLikeSize) {
  const TriangleMesh molar = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 600);
  CompleteOptions repaired = coarse(36);
  repaired.repair = true;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh crown = test::hostile_crown(molar, "islands", seed);
    EXPECT_EQ(outcome(crown, repaired), sort_pieces(crown).count(PieceKind::like) > 0 ? 3 : 0);
  }
}

TEST(HostileCrown, IsTheSameForTheSameSeed) {
  const TriangleMesh clean = test::dome(4, 4);
  for (const std::string& kind : test::hostile_kinds()) {
    const TriangleMesh one = test::hostile_crown(clean, kind, 5), two = test::hostile_crown(clean, kind, 5);
    EXPECT_EQ(one.vertices, two.vertices) << kind;
    EXPECT_EQ(one.triangles, two.triangles) << kind;
    EXPECT_TRUE(one.vertices != clean.vertices || one.triangles != clean.triangles) << kind;
  }
}

TEST(HostileCrown, RefiningGivesTheAskedNumberOfVerticesAndKeepsTheDisc) {
  const TriangleMesh fine = test::refined_to(test::dome(2, 4), 1234);
  EXPECT_EQ(fine.vertices.size(), 1234U);
  EXPECT_EQ(border_loops(fine).size(), 1U);
  EXPECT_NO_THROW(triangle_adjacency(fine));
  for (const Point& p : fine.vertices) EXPECT_NEAR(p.norm(), 4, 0.25);
}

TEST(HostileCrown, ThingsThatAreNoCrown) {
  outcome(test::torus(24, 12, 3, 1), coarse(36));  // a ring may pass for a crown with a hole

  const std::vector<std::pair<std::string, TriangleMesh>> things{{"plate", test::grid(6)},
                                                                 {"cube", test::cube()},
                                                                 {"tetrahedron", test::tetrahedron()},
                                                                 {"ball", test::sphere(2, 4)},
                                                                 {"inside out", flipped(test::dome(3, 4))},
                                                                 {"nothing", TriangleMesh{}}};
  for (const auto& [name, mesh] : things) {
    SCOPED_TRACE(name);
    EXPECT_NE(outcome(mesh, coarse(36)), 0);
  }
}

}  // namespace
}  // namespace rhizodont
