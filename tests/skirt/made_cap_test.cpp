// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "skirt/made_cap.hpp"

#include "common/closed_bases.hpp"
#include "common/hostile_crowns.hpp"
#include "mesh/test_meshes.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace rhizodont {
namespace {

const std::filesystem::path samples = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "samples";

struct Count {
  int lost = 0;  // crown triangles taken for cap
  int kept = 0;  // cap triangles taken for crown
};

Count compare(const test::ClosedCrown& closed, const std::vector<bool>& found) {
  Count count;
  for (std::size_t t = 0; t < found.size(); ++t) {
    count.lost += found[t] && !closed.is_cap[t];
    count.kept += !found[t] && closed.is_cap[t];
  }
  return count;
}

class MadeCap : public testing::TestWithParam<std::string> {};

TEST_P(MadeCap, IsKnownToTheTriangle) {
  for (const char* name : {"crown_11.stl", "crown_16.ply", "crown_23.ply", "crown_34.ply", "crown_36.stl"}) {
    const TriangleMesh open = load_mesh(samples / name).mesh;
    for (const std::uint64_t seed : {0U, 1U}) {
      SCOPED_TRACE(std::string(name) + ", shuffled with " + std::to_string(seed));
      const test::ClosedCrown closed = test::closed_base(open, GetParam(), seed);
      const auto found = find_made_cap(closed.mesh);
      ASSERT_TRUE(found);
      const Count count = compare(closed, *found);
      EXPECT_EQ(count.lost, 0);
      // Where the file's order says nothing, what fills a notch of the border may pass for crown.
      const bool has_ears = GetParam() == "ears" || GetParam() == "corner fan";
      EXPECT_LE(count.kept, has_ears && seed > 0 ? 12 : 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, MadeCap, testing::ValuesIn(test::base_kinds()), [](const auto& kind) {
  std::string name;
  for (const char c : kind.param)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) name += c;
  return name;
});

TEST(MadeCaps, SurfacesWithoutOneHaveNone) {
  EXPECT_FALSE(find_made_cap(test::sphere(4, 5)));
  EXPECT_FALSE(find_made_cap(test::cube()));
  EXPECT_FALSE(find_made_cap(test::torus(24, 12, 3, 1)));
  // A hollow shell: the band between its outer and its inner side is no base.
  const TriangleMesh outer = test::dome(4, 5), inner = test::dome(4, 4);
  TriangleMesh shell = test::together(outer, flipped(inner), Point::Zero());
  const std::vector<int> loop = border_loops(outer).front();
  const auto offset = static_cast<std::int32_t>(outer.vertices.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::int32_t a = loop[i], b = loop[(i + 1) % loop.size()];
    shell.triangles.push_back({b, a, a + offset});
    shell.triangles.push_back({b, a + offset, b + offset});
  }
  EXPECT_FALSE(find_made_cap(shell));
  // A base closed and meshed as finely as the crown is no sign of a program.
  const TriangleMesh open = load_mesh(samples / "crown_34.ply").mesh;
  const TriangleMesh smooth = test::refined_to(test::capped(open), open.vertices.size() * 4 / 3);
  EXPECT_FALSE(find_made_cap(smooth));
}

}  // namespace
}  // namespace rhizodont
