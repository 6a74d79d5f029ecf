// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Crowns as segmentations leave them, with the skirt to be taken off: a tooth that keeps the promises, without a
// repair.

#include "common/raw_crowns.hpp"
#include "common/hostile_crowns.hpp"
#include "families/gum_flange.hpp"
#include "intake/crown_input.hpp"
#include "mesh/border_pieces.hpp"
#include "mesh/geometry.hpp"
#include "pipeline/product_models.hpp"
#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "teeth/frame.hpp"

#include <gtest/gtest.h>

namespace rhizodont {
namespace {

using test::models;
using test::source_folder;

/// A sample crown with its axis up, gum around it, and what of it is tooth.
struct CutCrown {
  TriangleMesh mesh;
  std::vector<std::uint8_t> is_tooth;
};

CutCrown cut_crown(std::uint64_t seed) {
  TriangleMesh crown = test::coarsened_to(load_mesh(source_folder / "samples/crown_36.stl").mesh, 900);
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(growth_axis(crown), Eigen::Vector3d::UnitZ().eval()).toRotationMatrix();
  for (Point& p : crown.vertices) p = turn * p;
  const Point middle = area_centroid(crown);
  for (Point& p : crown.vertices) p -= middle;
  RandomStream random(seed);
  const Flange flange = add_flange(crown, FlangeKind::band, random);
  CutCrown cut{flange.mesh, {}};
  for (const double outwards : flange.outwards) cut.is_tooth.push_back(outwards == 0 ? 1 : 0);
  return cut;
}

CompleteOptions coarse(bool skirt) {
  CompleteOptions options = test::for_tooth(36);
  options.e = 1;
  if (skirt) options.skirt = 0.5;
  return options;
}

void expect_promises(const TriangleMesh& crown, const CompletedTooth& tooth) {
  CheckOptions exact;
  exact.compare_as_float = false;
  const CheckReport report = check(crown, tooth.mesh, exact);
  EXPECT_TRUE(report.holds()) << (report.failures.empty() ? "" : report.failures.front());
  EXPECT_EQ(tooth.record.crown.kept_vertices.size() + tooth.record.crown.dropped_vertices.size(),
            crown.vertices.size());
  EXPECT_TRUE(tooth.record.repairs.empty());
}

class RawCrowns : public testing::TestWithParam<std::string> {};

TEST_P(RawCrowns, AreCompletedWithTheSkirtTakenOff) {
  const CutCrown cut = cut_crown(3);
  const TriangleMesh raw = test::raw_crown(cut.mesh, cut.is_tooth, GetParam(), 3);
  const CompletedTooth tooth = complete_tooth(raw, models(), coarse(true));
  expect_promises(raw, tooth);
  EXPECT_TRUE(tooth.record.promises.new_triangles.holds());
  EXPECT_GT(tooth.record.crown.kept_vertices.size(), 700U);
}

INSTANTIATE_TEST_SUITE_P(All, RawCrowns, testing::ValuesIn(test::raw_kinds()), [](const auto& kind) {
  std::string name;
  for (const char c : kind.param)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
  return name;
});

TEST(RawCrown, ThatIsRefusedSaysThatTheSkirtIsTheReason) {
  const CutCrown cut = cut_crown(3);
  const TriangleMesh raw = test::raw_crown(cut.mesh, cut.is_tooth, "crowded edges", 3);
  try {
    complete_tooth(raw, models(), coarse(false));
    ADD_FAILURE() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--skirt auto"), std::string::npos) << error.what();
  }
}

TEST(RawCrown, OfTwoCrownsNoneIsChosen) {
  const CutCrown cut = cut_crown(3);
  TriangleMesh two = cut.mesh;
  const auto shift = static_cast<std::int32_t>(two.vertices.size());
  for (const Point& p : cut.mesh.vertices) two.vertices.push_back(p + Point(14, 0, 0));
  for (const auto& [a, b, c] : cut.mesh.triangles) two.triangles.push_back({a + shift, b + shift, c + shift});
  EXPECT_THROW(complete_tooth(two, models(), coarse(true)), InputError);
}

TEST(RawCrown, IsTheSameForTheSameSeed) {
  const CutCrown cut = cut_crown(1);
  for (const std::string& kind : test::raw_kinds()) {
    const TriangleMesh one = test::raw_crown(cut.mesh, cut.is_tooth, kind, 5),
                       two = test::raw_crown(cut.mesh, cut.is_tooth, kind, 5);
    EXPECT_EQ(one.vertices, two.vertices) << kind;
    EXPECT_EQ(one.triangles, two.triangles) << kind;
    EXPECT_EQ(one.triangles != cut.mesh.triangles || one.vertices.size() != cut.mesh.vertices.size(),
              kind != "plain" && kind != "crossings")
        << kind;
  }
  EXPECT_THROW(test::raw_crown(cut.mesh, cut.is_tooth, "nothing known", 1), UsageError);
}

TEST(CrownInput, ACrownCutBelowItsFurcationIsRefused) {
  TriangleMesh crown = load_mesh(source_folder / "samples/crown_36.stl").mesh;
  EXPECT_NO_THROW(require_outward_and_uncut(crown));
  // A strip across the opening leaves two of them.
  const auto pieces = border_pieces(crown);
  const BorderPiece& base = pieces[base_piece(pieces)];
  const auto first = base.half_edges.front();
  auto far = first;
  const auto place = [&](int v) { return crown.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& h : base.half_edges)
    if ((place(h.first) - place(first.first)).norm() > (place(far.first) - place(first.first)).norm()) far = h;
  crown.triangles.push_back({first.second, first.first, far.second});
  crown.triangles.push_back({first.second, far.second, far.first});
  try {
    require_outward_and_uncut(crown);
    ADD_FAILURE() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("2 places"), std::string::npos) << error.what();
    EXPECT_FALSE(error.elements().empty());
  }
}

}  // namespace
}  // namespace rhizodont
