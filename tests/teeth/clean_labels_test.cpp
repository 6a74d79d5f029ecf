// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/clean_labels.hpp"
#include "teeth/made_arch.hpp"

namespace rhizodont {
namespace {

using test::expect_input_error, test::made_arch, test::MadeArch, test::place_in_arch, test::teeth_of;

MadeArch lower_arch() { return made_arch(teeth_of(Jaw::lower)); }

/// Numbers all vertices within so many mm of a place (seen from above).
void paint(MadeArch& arch, double x, double y, double radius, int number) {
  for (std::size_t v = 0; v < arch.fdi.size(); ++v)
    if (std::hypot(arch.mesh.vertices[v].x() - x, arch.mesh.vertices[v].y() - y) < radius) arch.fdi[v] = number;
}

void number_vertex(MadeArch& arch, const Point& near, int number) {
  arch.fdi[static_cast<std::size_t>(arch.nearest_vertex(near.x(), near.y()))] = number;
}

TEST(CleanLabels, CleanOnesStayAsTheyAre) {
  const MadeArch arch = lower_arch();
  const CleanedLabels cleaned = clean_labels(arch.mesh, arch.fdi);
  EXPECT_EQ(cleaned.fdi, arch.fdi);
  EXPECT_TRUE(cleaned.changes.empty());
}

TEST(CleanLabels, IslandsBecomeWhatIsAroundThem) {
  const MadeArch arch = lower_arch();
  MadeArch noisy = arch;
  const Point on_36 = place_in_arch(14, Jaw::lower), on_45 = place_in_arch(4, Jaw::lower);
  number_vertex(noisy, on_36, 41);  // in another tooth
  paint(noisy, 0, 10, 0.5, 36);     // in the gum
  number_vertex(noisy, on_45, 0);   // a hole in a tooth
  const CleanedLabels cleaned = clean_labels(noisy.mesh, noisy.fdi);
  EXPECT_EQ(cleaned.fdi, arch.fdi);
  ASSERT_EQ(cleaned.changes.size(), 3U);
  EXPECT_EQ(cleaned.changes[0].number, 0);
  EXPECT_EQ(cleaned.changes[0].became, 45);
  EXPECT_EQ(cleaned.changes[1].number, 36);
  EXPECT_EQ(cleaned.changes[1].became, 0);
  EXPECT_EQ(cleaned.changes[2].number, 41);
  EXPECT_EQ(cleaned.changes[2].became, 36);
  EXPECT_GE(cleaned.changes[2].vertices, 1U);
  EXPECT_LT((cleaned.changes[1].at - Point(0, 10, 0)).norm(), 1);
  EXPECT_NE(describe(cleaned.changes[1]).find("became gum"), std::string::npos);
}

TEST(CleanLabels, AStrayNumberWithoutAToothGoes) {
  const MadeArch arch = lower_arch();
  MadeArch noisy = arch;
  paint(noisy, 0, 10, 0.9, 28);
  number_vertex(noisy, {0, 10, 0}, 27);  // an island in an island
  const CleanedLabels cleaned = clean_labels(noisy.mesh, noisy.fdi);
  EXPECT_EQ(cleaned.fdi, arch.fdi);
  EXPECT_EQ(cleaned.changes.back().number, 28);
  EXPECT_EQ(cleaned.changes.back().became, 0);
}

TEST(CleanLabels, AToothInTwoPiecesStaysAndIsListed) {
  MadeArch arch = lower_arch();
  const Point on_36 = place_in_arch(14, Jaw::lower);
  for (std::size_t v = 0; v < arch.fdi.size(); ++v)  // a groove of gum through it
    if (arch.fdi[v] == 36 && std::abs(arch.mesh.vertices[v].x() - on_36.x()) < 0.4) arch.fdi[v] = 0;
  const CleanedLabels cleaned = clean_labels(arch.mesh, arch.fdi);
  EXPECT_EQ(cleaned.fdi, arch.fdi);
  ASSERT_EQ(cleaned.changes.size(), 1U);
  EXPECT_EQ(cleaned.changes[0].number, 36);
  EXPECT_FALSE(cleaned.changes[0].became);
  EXPECT_NE(describe(cleaned.changes[0]).find("second piece"), std::string::npos);
}

TEST(CleanLabels, OneNumberOnTwoTeethIsRefusedWithPlaces) {
  MadeArch arch = lower_arch();
  for (int& number : arch.fdi) number = number == 46 ? 36 : number;
  expect_input_error([&] { clean_labels(arch.mesh, arch.fdi); }, "number 36 is on two teeth");
  try {
    clean_labels(arch.mesh, arch.fdi);
  } catch (const InputError& error) {
    EXPECT_EQ(error.kind(), ElementKind::vertices);
    EXPECT_FALSE(error.elements().empty());
  }
}

TEST(CleanLabels, APieceFarFromItsToothIsNotIts) {
  const MadeArch arch = lower_arch();
  MadeArch noisy = arch;
  paint(noisy, 0, 10, 0.9, 36);
  const CleanedLabels cleaned = clean_labels(noisy.mesh, noisy.fdi);
  EXPECT_EQ(cleaned.fdi, arch.fdi);
}

TEST(CleanLabels, ResultsDoNotDependOnThePose) {
  MadeArch arch = lower_arch();
  paint(arch, 0, 10, 0.5, 36);
  const std::vector<int> before = clean_labels(arch.mesh, arch.fdi).fdi;
  test::pose(arch.mesh, 3);
  EXPECT_EQ(clean_labels(arch.mesh, arch.fdi).fdi, before);
}

}  // namespace
}  // namespace rhizodont
