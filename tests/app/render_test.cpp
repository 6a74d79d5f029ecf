// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pictures/render.hpp"
#include "pictures/tiles.hpp"
#include "pictures/tooth_colours.hpp"
#include "pictures/upward.hpp"

#include "mesh/test_meshes.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace rhizodont {
namespace {

using test::cube, test::grid, test::sphere, test::together;

std::array<int, 3> pixel(const Image& image, int x, int y) {
  const auto place =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.rgb[place], image.rgb[place + 1], image.rgb[place + 2]};
}

bool is_grey(const std::array<int, 3>& p) { return p[0] == p[1] && p[1] == p[2]; }

RenderOptions small(std::vector<std::string> views = {"front"}) {
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.views = std::move(views);
  options.supersampling = 2;
  return options;
}

constexpr Colour red{0.8F, 0.05F, 0.05F}, green{0.05F, 0.8F, 0.05F};

TEST(Render, MeshInTheMiddleBackgroundAround) {
  const TriangleMesh ball = sphere(3);
  const Image image = render({{&ball, {red}, {}}}, small());
  ASSERT_EQ(image.rgb.size(), 3U * 64U * 48U);
  EXPECT_TRUE(is_grey(pixel(image, 1, 1)));
  EXPECT_TRUE(is_grey(pixel(image, 62, 46)));
  const auto middle = pixel(image, 32, 24);
  EXPECT_GT(middle[0], middle[1] + 40);
  // it fills the tile's shorter side but for a margin
  EXPECT_TRUE(is_grey(pixel(image, 32, 0)));
  EXPECT_FALSE(is_grey(pixel(image, 32, 4)));
}

TEST(Render, WhatIsNearerHidesWhatIsBehind) {
  // a red square in front of (less y than) a green one
  TriangleMesh two = together(grid(1), grid(1), {0, 0, 2});
  for (Point& p : two.vertices) p = Point(p.x(), p.z(), p.y());
  const std::vector<Colour> colours{red, red, green, green};
  const auto front = pixel(render({{&two, colours, {}}}, small({"front"})), 32, 24);
  EXPECT_GT(front[0], front[1]);
  const auto back = pixel(render({{&two, colours, {}}}, small({"back"})), 32, 24);
  EXPECT_LT(back[0], back[1]);
}

TEST(Render, ViewsShowTheirSide) {
  // one colour for the triangles of the cube whose normal points to each side
  const TriangleMesh box = cube();
  const std::vector<std::pair<std::string, std::size_t>> sides{{"bottom", 0}, {"top", 1},  {"front", 2},
                                                               {"back", 3},   {"left", 4}, {"right", 5}};
  for (const auto& [view, side] : sides) {
    std::vector<Colour> colours(12, green);
    colours[2 * side] = colours[2 * side + 1] = red;
    const auto middle = pixel(render({{&box, colours, {}}}, small({view})), 34, 25);
    EXPECT_GT(middle[0], middle[1]) << view;
  }
}

TEST(Render, UpPointsUp) {
  // a cone of a few triangles with its tip to +x; with up = x the tip is at the top and the tile's top corners are
  // empty
  TriangleMesh cone{{{0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, {2, 0, 0}},
                    {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}}};
  RenderOptions options = small();
  options.width = options.height = 48;
  const Image image = render({{&cone, {red}, Eigen::Vector3d(1, 0, 0)}}, options);
  EXPECT_TRUE(is_grey(pixel(image, 6, 6)));
  EXPECT_TRUE(is_grey(pixel(image, 41, 6)));
  EXPECT_FALSE(is_grey(pixel(image, 6, 43)));
  EXPECT_FALSE(is_grey(pixel(image, 41, 43)));
}

TEST(Render, SheetHasARowPerMeshAndAColumnPerView) {
  const TriangleMesh ball = sphere(2), large = sphere(2, 3);
  const Image image = render({{&ball, {red}, {}}, {&large, {green}, {}}}, small({"front", "top", "left"}));
  EXPECT_EQ(image.width, 3 * 64);
  EXPECT_EQ(image.height, 2 * 48);
  for (int column = 0; column < 3; ++column) {
    const auto upper = pixel(image, column * 64 + 32, 24), lower = pixel(image, column * 64 + 32, 48 + 24);
    EXPECT_GT(upper[0], upper[1]);
    EXPECT_LT(lower[0], lower[1]);
  }
  // all at one scale: the small ball fills only a third of its tile
  EXPECT_TRUE(is_grey(pixel(image, 32, 12)));
  EXPECT_FALSE(is_grey(pixel(image, 32, 48 + 12)));
}

TEST(Render, WireframeDrawsDarkLines) {
  const TriangleMesh ball = sphere(1);
  RenderOptions options = small();
  const Image plain = render({{&ball, {red}, {}}}, options);
  options.wireframe = true;
  const Image lines = render({{&ball, {red}, {}}}, options);
  std::size_t darker = 0, lighter = 0;
  for (std::size_t k = 0; k < plain.rgb.size(); ++k) {
    darker += lines.rgb[k] < plain.rgb[k];
    lighter += lines.rgb[k] > plain.rgb[k];
  }
  EXPECT_GT(darker, 300U);
  EXPECT_EQ(lighter, 0U);
}

TEST(Render, SamePictureWhereverTheMeshIsAndHoweverItIsNumbered) {
  TriangleMesh egg = sphere(2);
  for (Point& p : egg.vertices) p.x() *= 0.75;
  const RenderOptions options = small({"front", "oblique"});
  const Image image = render({{&egg, {red}, {}}}, options);
  TriangleMesh other = egg;
  for (Point& p : other.vertices) p = 4 * p + Point(64, -32, 8);  // rounds nothing
  std::rotate(other.vertices.begin(), other.vertices.begin() + 1, other.vertices.end());
  const auto last = static_cast<std::int32_t>(other.vertices.size()) - 1;
  for (Triangle& t : other.triangles)
    for (std::int32_t& v : t) v = v == 0 ? last : v - 1;
  std::size_t unlike = 0;
  const Image again = render({{&other, {red}, {}}}, options);
  ASSERT_EQ(again.rgb.size(), image.rgb.size());
  for (std::size_t k = 0; k < image.rgb.size(); ++k) unlike += std::abs(image.rgb[k] - again.rgb[k]) > 2;
  EXPECT_LT(unlike, image.rgb.size() / 200) << "but for a pixel on an edge here and there";
  const Image turned = render({{&egg, {red}, {}}}, small({"left", "oblique"}));
  unlike = 0;
  for (std::size_t k = 0; k < image.rgb.size(); ++k) unlike += std::abs(image.rgb[k] - turned.rgb[k]) > 2;
  EXPECT_GT(unlike, image.rgb.size() / 50) << "from elsewhere it looks otherwise";
}

TEST(Render, PngHoldsThePicture) {
  const TriangleMesh ball = sphere(2);
  const Image image = render({{&ball, {red}, {}}}, small());
  const std::string bytes = encode_png(image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()));
  header.format = PNG_FORMAT_RGB;
  EXPECT_EQ(static_cast<int>(header.width), image.width);
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, image.rgb);
}

TEST(Render, ColoursBySourceAndValue) {
  const TriangleMesh mesh = grid(1);  // triangles 0 1 3, 0 3 2
  const auto by_source = colours_by_source(mesh, {0, 0, 1, 0});
  EXPECT_EQ(by_source[0], plain_colour());
  EXPECT_NE(by_source[1], plain_colour());
  EXPECT_NE(colours_by_source(mesh, {0, 0, 2, 0})[1], by_source[1]);
  const auto by_value = colours_by_value(mesh, {0, 5, -5, 0});
  EXPECT_LT(by_value[1][0], by_value[0][0]);
  EXPECT_EQ(colours_by_value(mesh, {1, 1, 1, 1})[0], colours_by_value(mesh, {1, 1, 1, 1})[1]);
  EXPECT_THROW(colours_by_source(mesh, {0}), InputError);
  EXPECT_THROW(colours_by_value(mesh, {0}), InputError);
}

TEST(Render, TeethHaveOtherColoursThanTheirNeighboursAndGum) {
  const std::vector<int> upper{18, 17, 16, 15, 14, 13, 12, 11, 21, 22, 23, 24, 25, 26, 27, 28};
  for (const int fdi : upper) EXPECT_NE(colour_of_tooth(fdi), colour_of_tooth(0));
  for (std::size_t i = 1; i < upper.size(); ++i)
    EXPECT_NE(colour_of_tooth(upper[i]), colour_of_tooth(upper[i - 1])) << upper[i];
  const TriangleMesh mesh = grid(1);  // triangles 0 1 3, 0 3 2
  const std::vector<Colour> colours = colours_by_tooth(mesh, {36, 36, 0, 0});
  EXPECT_EQ(colours[0], colour_of_tooth(36));
  EXPECT_EQ(colours[1], colour_of_tooth(0));
  EXPECT_THROW(colours_by_tooth(mesh, {36}), InputError);
}

TEST(Render, BadInputIsRefused) {
  const TriangleMesh ball = sphere(1), none;
  TriangleMesh bad = ball;
  bad.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(render({}, small()), UsageError);
  EXPECT_THROW(render({{&ball, {red}, {}}}, small({})), UsageError);
  EXPECT_THROW(render({{&ball, {red}, {}}}, small({"behind"})), UsageError);
  EXPECT_THROW(render({{&ball, {red}, Eigen::Vector3d(0, 0, 0)}}, small()), UsageError);
  EXPECT_THROW(render({{&none, {red}, {}}}, small()), InputError);
  EXPECT_THROW(render({{&bad, {red}, {}}}, small()), InputError);
  EXPECT_THROW(render({{&ball, {red, green}, {}}}, small()), InputError);
  RenderOptions huge = small();
  huge.width = 100000;
  EXPECT_THROW(render({{&ball, {red}, {}}}, huge), UsageError);
}

TEST(Tiles, RowsStandSideBySideAndTheRestIsWhite) {
  const Image tall{1, 6, {1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6}};  // three rows of two pixels
  const Image wide = side_by_side(tall, 3, 2);
  EXPECT_EQ(wide.width, 2);
  EXPECT_EQ(wide.height, 4);
  std::vector<int> first;  // of each pixel's three
  for (std::size_t i = 0; i < wide.rgb.size(); i += 3) first.push_back(wide.rgb[i]);
  EXPECT_EQ(first, (std::vector<int>{1, 3, 2, 4, 5, 255, 6, 255}));
}

TEST(Upward, IsFromRootToCrown) {
  const Eigen::Vector3d leaning = Eigen::Vector3d(0, 1, 1).normalized();
  MeshFile file;
  file.mesh = sphere(2);
  EXPECT_EQ(upward_of(file), Eigen::Vector3d::UnitZ()) << "closed";
  VertexAttribute source{AttributeType::uint8, {}};
  for (const Point& p : file.mesh.vertices) source.values.push_back(p.dot(leaning) > 0.05 ? 0 : 2);
  file.vertex_attributes[source_attribute] = source;
  EXPECT_GT(upward_of(file).dot(leaning), 0.99);
  file.vertex_attributes.clear();
  std::erase_if(file.mesh.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(),
                       [&](std::int32_t v) { return source.values[static_cast<std::size_t>(v)] > 0; });
  });
  EXPECT_GT(upward_of(file).dot(leaning), 0.99);
}

}  // namespace
}  // namespace rhizodont
