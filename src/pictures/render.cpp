// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// A software rasteriser: orthographic, z-buffer, smooth normals, three lights, ambient occlusion from the z-buffer
// (in the manner of M. Mittring, "Finding next gen: CryEngine 2", SIGGRAPH 2007 courses), supersampling.
#include "pictures/render.hpp"

#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"

#include <fmt/core.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace rhizodont {
namespace {

using Rotation = Eigen::Matrix3d;  // rows: right, up and towards the viewer

// Right-handed frame about `up`; the front is what is seen from -y where `up` is z.
Rotation upright(const Eigen::Vector3d& up) {
  const Eigen::Vector3d vertical = up.normalized();
  Eigen::Vector3d right = Eigen::Vector3d::UnitX() - vertical.x() * vertical;
  if (right.norm() < 0.1) right = Eigen::Vector3d::UnitY() - vertical.y() * vertical;
  right.normalize();
  Rotation frame;
  frame << right.transpose(), vertical.transpose(), right.cross(vertical).transpose();
  return frame;
}

Rotation view_turn(const std::string& view) {
  constexpr double quarter = std::numbers::pi / 2;
  const auto about_vertical = [](double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
  };
  const auto about_right = [](double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).toRotationMatrix();
  };
  static const std::map<std::string, Rotation> turns{
      {"front", Rotation::Identity()},
      {"back", about_vertical(2 * quarter)},
      {"right", about_vertical(-quarter)},
      {"left", about_vertical(quarter)},
      {"top", about_right(quarter)},
      {"bottom", about_right(-quarter)},
      {"oblique", about_right(0.45) * about_vertical(-0.6)},
  };
  const auto place = turns.find(view);
  if (place == turns.end())
    throw UsageError(fmt::format("'{}' is no view; there are front, back, left, right, top, bottom, oblique", view));
  return place->second;
}

// One mesh as seen in one view: x right, y up, z towards the viewer, in mm about the middle of the tile.
struct Scene {
  std::vector<Eigen::Vector3f> points, normals;
  const TriangleMesh* mesh;
  const std::vector<Colour>* colours;
};

Scene make_scene(const RenderItem& item, const std::vector<Eigen::Vector3d>& normals, const Rotation& turn) {
  Scene scene{{}, {}, item.mesh, &item.colours};
  const Point middle = bounding_box(item.mesh->vertices).center();
  Eigen::AlignedBox3d box;
  for (const Point& p : item.mesh->vertices) box.extend(Point(turn * (p - middle)));
  for (const Point& p : item.mesh->vertices) scene.points.push_back((turn * (p - middle) - box.center()).cast<float>());
  for (const Eigen::Vector3d& n : normals) scene.normals.push_back((turn * n).cast<float>());
  return scene;
}

Eigen::Vector2f half_extent(const Scene& scene) {
  Eigen::Vector2f extent(1e-6F, 1e-6F);
  for (const Eigen::Vector3f& p : scene.points) extent = extent.cwiseMax(p.head<2>().cwiseAbs());
  return extent;
}

struct Sample {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Colour colour{};
  float line = 0;  // 1 on an edge of the wireframe
  bool behind = false;
};

class Tile {
 public:
  Tile(int width, int height, float samples_per_mm, bool wireframe, float line_width)
      : width_(width),
        height_(height),
        scale_(samples_per_mm),
        probes_(make_probes(samples_per_mm)),
        wireframe_(wireframe),
        line_width_(line_width),
        depths_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), nothing),
        samples_(depths_.size()) {}

  void draw(const Scene& scene) {
    for (std::size_t t = 0; t < scene.mesh->triangles.size(); ++t) draw_triangle(scene, t);
  }

  /// Mean colour of a pixel's s x s samples. How open the surroundings are hardly differs between neighbouring samples
  /// of one surface, and is by far the most expensive part: it is found once for all that follow at about that depth.
  Colour pixel(int column, int row, int s) const {
    constexpr float same_surface_mm = 0.15F;
    Colour sum{};
    float depth = nothing, open = 1;
    for (int k = 0; k < s * s; ++k) {
      const int x = column * s + k % s, y = row * s + k / s;
      const std::size_t i = place(x, y);
      Colour part = background(y);
      if (depths_[i] != nothing) {
        if (!(std::abs(depths_[i] - depth) <= same_surface_mm)) {
          depth = depths_[i];
          open = openness(x, y, samples_[i].normal);
        }
        part = lit(samples_[i], open);
        for (float& c : part) c *= 1 - 0.75F * samples_[i].line;
      }
      for (std::size_t c = 0; c < 3; ++c) sum[c] += part[c];
    }
    for (float& c : sum) c /= static_cast<float>(s * s);
    return sum;
  }

 private:
  static constexpr float reach_mm = 1.6F;  // of ambient occlusion
  static constexpr float nothing = -std::numeric_limits<float>::infinity();

  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  void draw_triangle(const Scene& scene, std::size_t t) {
    const Triangle& corners = scene.mesh->triangles[t];
    std::array<Eigen::Vector2f, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f& q = scene.points[static_cast<std::size_t>(corners[i])];
      p[i] = {0.5F * static_cast<float>(width_) + scale_ * q.x(), 0.5F * static_cast<float>(height_) - scale_ * q.y()};
    }
    const auto cross = [](const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); };
    const float doubled = cross(p[1] - p[0], p[2] - p[0]);
    if (doubled == 0) return;
    // y runs down in the picture: counterclockwise in space is clockwise here
    const bool behind = doubled > 0;
    const auto [low, high] = covered(p);
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x) {
        const Eigen::Vector2f q(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        std::array<float, 3> weight{};
        for (std::size_t i = 0; i < 3; ++i) weight[i] = cross(p[(i + 1) % 3] - q, p[(i + 2) % 3] - q) / doubled;
        if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) continue;
        put(scene, t, x, y, weight, behind, wireframe_ ? edge_coverage(p, weight, doubled) : 0);
      }
  }

  std::pair<Eigen::Vector2i, Eigen::Vector2i> covered(const std::array<Eigen::Vector2f, 3>& p) const {
    const Eigen::Vector2f low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const auto clamp = [](float v, int most) { return std::clamp(static_cast<int>(std::floor(v)), 0, most); };
    return {{clamp(low.x(), width_ - 1), clamp(low.y(), height_ - 1)},
            {clamp(high.x(), width_ - 1), clamp(high.y(), height_ - 1)}};
  }

  // Distance to the nearest side in samples, as a line of some width.
  float edge_coverage(const std::array<Eigen::Vector2f, 3>& p, const std::array<float, 3>& weight,
                      float doubled) const {
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
      nearest = std::min(nearest, weight[i] * std::abs(doubled) / (p[(i + 2) % 3] - p[(i + 1) % 3]).norm());
    return nearest < 0.5F * line_width_ ? 1.0F : 0.0F;
  }

  void put(const Scene& scene, std::size_t t, int x, int y, const std::array<float, 3>& weight, bool behind,
           float line) {
    const Triangle& corners = scene.mesh->triangles[t];
    float depth = 0;
    for (std::size_t i = 0; i < 3; ++i) depth += weight[i] * scene.points[static_cast<std::size_t>(corners[i])].z();
    if (depth <= depths_[place(x, y)]) return;
    depths_[place(x, y)] = depth;
    Sample& sample = samples_[place(x, y)];
    sample.normal.setZero();
    for (std::size_t i = 0; i < 3; ++i)
      sample.normal += weight[i] * scene.normals[static_cast<std::size_t>(corners[i])];
    sample.normal.normalize();
    if (behind) sample.normal = -sample.normal;
    sample.behind = behind;
    sample.line = line;
    sample.colour = (*scene.colours)[scene.colours->size() == 1 ? 0 : t];
  }

  // Share of the half-space above a sample that its surroundings leave open, [0, 1].
  float openness(int x, int y, const Eigen::Vector3f& normal) const {
    const float here = depths_[place(x, y)];
    const auto& directions = probes_[static_cast<std::size_t>(x * 7 + y * 3) % probes_.size()];
    float closed = 0;
    for (const auto& steps : directions) {
      float rise = 0;
      for (const Eigen::Vector2i& step : steps) {
        const int u = x + step.x(), v = y + step.y();
        if (u < 0 || v < 0 || u >= width_ || v >= height_) continue;
        const float depth = depths_[place(u, v)];
        if (depth == nothing) continue;
        const Eigen::Vector3f offset(static_cast<float>(step.x()) / scale_, static_cast<float>(-step.y()) / scale_,
                                     depth - here);
        // what stands far in front hides the picture, not the light
        const float fade = 1 - std::abs(offset.z()) / (2 * reach_mm);
        const float along = offset.dot(normal);
        if (fade > 0 && along > 0) rise = std::max(rise, fade * (along / offset.norm() - 0.08F));
      }
      closed += rise;
    }
    return std::clamp(1 - 1.1F * closed / static_cast<float>(directions.size()), 0.0F, 1.0F);
  }

  // Places around a sample at which its surroundings are looked at; neighbouring samples use different sets.
  using Probes = std::array<std::array<std::array<Eigen::Vector2i, 4>, 12>, 5>;
  static Probes make_probes(float scale) {
    Probes probes;
    for (std::size_t set = 0; set < probes.size(); ++set)
      for (std::size_t d = 0; d < probes[set].size(); ++d)
        for (std::size_t k = 0; k < probes[set][d].size(); ++k) {
          const float angle = 2 * std::numbers::pi_v<float> * (static_cast<float>(d) + 0.2F * static_cast<float>(set)) /
                              static_cast<float>(probes[set].size());
          const float radius = reach_mm * scale * static_cast<float>(k + 1) / static_cast<float>(probes[set][d].size());
          probes[set][d][k] = {static_cast<int>(std::lround(radius * std::cos(angle))),
                               static_cast<int>(std::lround(radius * std::sin(angle)))};
          // never the sample itself
          if (probes[set][d][k].isZero()) probes[set][d][k].x() = 1;
        }
    return probes;
  }

  static Colour lit(const Sample& sample, float open) {
    static const Eigen::Vector3f key = Eigen::Vector3f(-0.45F, 0.6F, 0.75F).normalized(),
                                 fill = Eigen::Vector3f(0.8F, 0.1F, 0.45F).normalized();
    const Eigen::Vector3f& n = sample.normal;
    const float diffuse = 0.62F * std::max(0.0F, n.dot(key)) + 0.2F * std::max(0.0F, n.dot(fill));
    const float ambient = (0.26F + 0.1F * n.y()) * open;
    const Eigen::Vector3f halfway = (key + Eigen::Vector3f::UnitZ()).normalized();
    const float gloss = sample.behind ? 0 : 0.16F * std::pow(std::max(0.0F, n.dot(halfway)), 40.0F);
    Colour colour{};
    for (std::size_t i = 0; i < 3; ++i) {
      const float base = sample.behind ? 0.55F * sample.colour[i] + 0.04F : sample.colour[i];
      colour[i] = base * (ambient + diffuse * (0.35F + 0.65F * open)) + gloss;
    }
    return colour;
  }

  Colour background(int y) const {
    const float down = static_cast<float>(y) / static_cast<float>(height_);
    const float light = 0.93F - 0.13F * down;
    return {light, light, light};
  }

  int width_, height_;
  float scale_;
  Probes probes_;
  bool wireframe_;
  float line_width_;
  std::vector<float> depths_;    // mm, larger = nearer; apart, for openness looks at nothing else
  std::vector<Sample> samples_;  // of meaning where there is a depth
};

std::uint8_t to_srgb(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

void copy_to_sheet(const Tile& tile, const RenderOptions& options, int column, int row, Image& sheet) {
  tbb::parallel_for(0, options.height, [&](int y) {
    for (int x = 0; x < options.width; ++x) {
      const Colour colour = tile.pixel(x, y, options.supersampling);
      const auto place = static_cast<std::size_t>(row * options.height + y) * static_cast<std::size_t>(sheet.width) +
                         static_cast<std::size_t>(column * options.width + x);
      for (std::size_t c = 0; c < 3; ++c) sheet.rgb[3 * place + c] = to_srgb(colour[c]);
    }
  });
}

void require_drawable(const std::vector<RenderItem>& items, const RenderOptions& options) {
  constexpr OptionRange pixels = OptionRange::at_least(16).at_most(8192);
  require_ranges("a picture", {{"width", options.width, pixels},
                               {"height", options.height, pixels},
                               {"supersampling", options.supersampling, OptionRange::at_least(1).at_most(8)}});
  if (items.empty() || options.views.empty()) throw UsageError("a picture needs at least one mesh and one view");
  const auto tiles = static_cast<double>(items.size() * options.views.size());
  if (tiles * options.width * options.height > 4e8)
    throw UsageError("the picture is too large; ask for smaller or fewer tiles");
  for (const RenderItem& item : items) {
    if (item.mesh == nullptr || item.mesh->triangles.empty())
      throw InputError("a mesh without triangles cannot be drawn");
    require_valid_indices(*item.mesh);
    require_finite(item.mesh->vertices);
    if (item.colours.size() != 1 && item.colours.size() != item.mesh->triangles.size())
      throw InputError("a mesh needs one colour, or one for each triangle");
    if (!(item.up.value_or(options.up).norm() > 0)) throw UsageError("the upward direction must not be zero");
  }
}

}  // namespace

Image render(const std::vector<RenderItem>& items, const RenderOptions& options) {
  require_drawable(items, options);
  std::vector<Scene> scenes;
  for (const RenderItem& item : items) {
    const std::vector<Eigen::Vector3d> normals = vertex_normals(*item.mesh);
    const Rotation frame = upright(item.up.value_or(options.up));
    for (const std::string& view : options.views) scenes.push_back(make_scene(item, normals, view_turn(view) * frame));
  }
  Eigen::Vector2f extent(0, 0);
  for (const Scene& scene : scenes) extent = extent.cwiseMax(half_extent(scene));
  const int s = options.supersampling;
  const float scale =
      0.93F * 0.5F * static_cast<float>(s) *
      std::min(static_cast<float>(options.width) / extent.x(), static_cast<float>(options.height) / extent.y());

  const auto columns = static_cast<int>(options.views.size());
  Image sheet{columns * options.width, static_cast<int>(items.size()) * options.height, {}};
  sheet.rgb.resize(3 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height));
  parallel_tasks(static_cast<int>(scenes.size()), [&](int k) {
    Tile tile(s * options.width, s * options.height, scale, options.wireframe, 1.1F * static_cast<float>(s));
    tile.draw(scenes[static_cast<std::size_t>(k)]);
    copy_to_sheet(tile, options, k % columns, k / columns, sheet);
  });
  return sheet;
}

Colour plain_colour() { return {0.80F, 0.76F, 0.66F}; }

std::vector<Colour> colours_by_source(const TriangleMesh& mesh, const std::vector<double>& sources) {
  static constexpr std::array<Colour, 3> colours{{{0.80F, 0.76F, 0.66F}, {0.12F, 0.42F, 0.47F}, {0.62F, 0.36F, 0.17F}}};
  if (sources.size() != mesh.vertices.size()) throw InputError("a colour by source needs one value per vertex");
  std::vector<Colour> chosen;
  for (const Triangle& triangle : mesh.triangles) {
    double most = 0;
    for (const std::int32_t v : triangle) most = std::max(most, sources[static_cast<std::size_t>(v)]);
    chosen.push_back(colours[static_cast<std::size_t>(std::clamp(most, 0.0, 2.0))]);
  }
  return chosen;
}

std::vector<Colour> colours_by_value(const TriangleMesh& mesh, const std::vector<double>& values) {
  static constexpr std::array<Colour, 4> ramp{
      {{0.06F, 0.03F, 0.25F}, {0.02F, 0.25F, 0.35F}, {0.15F, 0.5F, 0.12F}, {0.95F, 0.8F, 0.05F}}};
  if (values.size() != mesh.vertices.size() || values.empty())
    throw InputError("a colour by value needs one value per vertex");
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double span = *high > *low ? *high - *low : 1;
  std::vector<Colour> chosen;
  for (const Triangle& triangle : mesh.triangles) {
    double mean = 0;
    for (const std::int32_t v : triangle) mean += values[static_cast<std::size_t>(v)] / 3;
    const double place = std::clamp((mean - *low) / span, 0.0, 1.0) * (ramp.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), ramp.size() - 2);
    const auto part = static_cast<float>(place - static_cast<double>(below));
    Colour colour{};
    for (std::size_t i = 0; i < 3; ++i) colour[i] = (1 - part) * ramp[below][i] + part * ramp[below + 1][i];
    chosen.push_back(colour);
  }
  return chosen;
}

}  // namespace rhizodont
