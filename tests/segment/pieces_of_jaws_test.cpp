// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/pieces_of_jaws.hpp"

#include "mesh/append_mesh.hpp"
#include "segment/sheet.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rhizodont {
namespace {

TriangleMesh plate(double across, double height, int vertices_a_side) {
  return test::sheet(vertices_a_side, vertices_a_side,
                     [&](double s, double t) { return Point(across * s, across * t, height); });
}

TEST(PiecesOfJaws, SayWhichOfTwoWasRead) {
  TriangleMesh scan = plate(60, 0, 30);
  const std::size_t first = scan.vertices.size();
  append_mesh(scan, plate(60, 40, 30));
  std::vector<int> fdi(scan.vertices.size(), 0);
  for (int v = 0; v < 12; ++v) fdi[first + static_cast<std::size_t>(v)] = 31 + v / 4;
  const auto sentence = which_jaw_was_read(scan, fdi, 10);  // a file in cm
  ASSERT_TRUE(sentence);
  EXPECT_NE(sentence->find("2 pieces of a jaw's size"), std::string::npos) << *sentence;
  EXPECT_NE(sentence->find("0 in the one around (3.0, 3.0, 0.0), 3 in the one around (3.0, 3.0, 4.0)"),
            std::string::npos)
      << *sentence;
}

TEST(PiecesOfJaws, CrumbsAndSmallPiecesAreNoJaws) {
  TriangleMesh scan = plate(60, 0, 30);
  append_mesh(scan, plate(20, 5, 30));  // a wax bite, say: as fine, but too small
  append_mesh(scan, plate(60, 9, 4));   // large and hardly there
  std::vector<int> fdi(scan.vertices.size(), 0);
  fdi[3] = fdi[4] = 36;
  EXPECT_FALSE(which_jaw_was_read(scan, fdi, 1));
}

}  // namespace
}  // namespace rhizodont
