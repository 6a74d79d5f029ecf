// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Training pairs for point cloud completion: "Completing Dental Models While Preserving Crown Geometry and Meshing
// Topology", 3.3, with crops, noise and frames as they are at inference.
#include "training/completion_sample.hpp"

#include "base/option_range.hpp"
#include "base/random_stream.hpp"
#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rhizodont {
namespace {

void require_in_range(const CompletionSampleOptions& options) {
  require_ranges("a training sample",
                 {{"input_points", options.input_points, OptionRange::at_least(1)},
                  {"target_points", options.target_points, OptionRange::at_least(1)},
                  {"type", options.type, OptionRange::at_least(-1).below(tooth_type_count)},
                  {"paper_crop_share", options.paper_crop_share, share_range},
                  {"scanner_noise_mm", options.scanner_noise_mm, OptionRange::at_least(0)},
                  {"gap_probability", options.gap_probability, share_range},
                  {"skirt_probability", options.skirt_probability, share_range},
                  {"skirt_mm", options.skirt_mm, OptionRange::at_least(0)},
                  {"lost_turn_share", options.lost_turn_share, share_range},
                  {"rotation_jitter_radians", options.rotation_jitter_radians, OptionRange::at_least(0)},
                  {"form_axis_error_degrees", options.form_axis_error_degrees, OptionRange::at_least(0)},
                  {"arch_axis_share", options.arch_axis_share, share_range},
                  {"arch_axis_error_degrees", options.arch_axis_error_degrees, OptionRange::at_least(0)}});
}

constexpr double degree = std::numbers::pi / 180;

// The axis that a crown gets at inference: that of its border, or between that and where the arch says up is.
Eigen::Vector3d draw_axis(const SyntheticTooth& tooth, const TriangleMesh& crown,
                          const CompletionSampleOptions& options, RandomStream& random) {
  const Eigen::Vector3d of_border = growth_axis(crown);
  const bool in_arch = random.chance(options.arch_axis_share);
  const double error = options.arch_axis_error_degrees * degree;
  const double x = random.normal(0.0, error), y = random.normal(0.0, error);
  return in_arch ? axis_in_arch(of_border, (tooth.crown_axis + Eigen::Vector3d(x, y, 0)).normalized()) : of_border;
}

struct SurfacePoint {
  std::size_t triangle;
  double b0, b1, b2;

  template <typename Values>
  auto mix(const TriangleMesh& mesh, const Values& values) const {
    const Triangle& t = mesh.triangles[triangle];
    return (b0 * values[static_cast<std::size_t>(t[0])] + b1 * values[static_cast<std::size_t>(t[1])] +
            b2 * values[static_cast<std::size_t>(t[2])])
        .eval();
  }
};

// Uniform by area, one point in each of `count` equal shares of the area, then shuffled: more even than independent
// points, and no batch sees an order.
std::vector<SurfacePoint> sample_evenly(const TriangleMesh& mesh, std::size_t count, RandomStream& random) {
  std::vector<double> cumulative;
  double total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) cumulative.push_back(total += triangle_area(mesh, t));
  std::vector<SurfacePoint> points;
  points.reserve(count);
  std::size_t t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = total * (static_cast<double>(i) + random.uniform()) / static_cast<double>(count);
    while (t + 1 < cumulative.size() && cumulative[t] < at) ++t;
    const double root = std::sqrt(random.uniform()), v = random.uniform();
    points.push_back({t, 1 - root, root * (1 - v), root * v});
  }
  for (std::size_t i = count; i > 1; --i) std::swap(points[i - 1], points[random.index(i)]);
  return points;
}

}  // namespace

CompletionSample make_completion_sample(const ToothFamilies& families, std::uint64_t seed,
                                        const CompletionSampleOptions& options) {
  require_in_range(options);
  RandomStream random(seed, 100);
  CompletionSample sample;
  sample.pair.type = static_cast<int>(random.index(tooth_type_count));
  if (options.type >= 0) sample.pair.type = options.type;
  const SyntheticTooth tooth = generate_tooth(families, sample.pair.type, random.bits());
  CroppedCrown crop = draw_cropped_crown(tooth, options.paper_crop_share, options.gap_probability, random);
  if (random.chance(options.skirt_probability)) add_skirt_remains(crop.mesh, options.skirt_mm, random);
  const bool lost = random.chance(options.lost_turn_share);
  const double jitter = lost ? std::numbers::pi : options.rotation_jitter_radians;
  const double turn = random.uniform(-jitter, jitter) - tooth.crown_turn;
  sample.frame = frame_of_crop(crop.mesh, draw_axis(tooth, crop.mesh, options, random), turn);

  CompletionTrainingSample& pair = sample.pair;
  pair.input.reserve(options.input_points);
  const double noise = options.scanner_noise_mm;
  for (const SurfacePoint& s : sample_evenly(crop.mesh, options.input_points, random)) {
    const Point p = s.mix(crop.mesh, crop.mesh.vertices);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    pair.input.push_back(sample.frame.to_canonical(p + noise * Eigen::Vector3d(x, y, z)).cast<float>());
  }

  const std::vector<Eigen::Vector3d> normals = vertex_normals(tooth.mesh);
  pair.target.reserve(options.target_points);
  pair.normals.reserve(options.target_points);
  for (const SurfacePoint& s : sample_evenly(tooth.mesh, options.target_points, random)) {
    const Point p = s.mix(tooth.mesh, tooth.mesh.vertices);
    const Eigen::Vector3d normal = s.mix(tooth.mesh, normals).normalized();
    pair.target.push_back(sample.frame.to_canonical(p).cast<float>());
    pair.normals.push_back(sample.frame.direction_to_canonical(normal).cast<float>());
    pair.is_root.push_back(p.z() > crop.line.height(tooth.junction, p.x(), p.y()) ? 0 : 1);
    sample.target_cement.push_back(p.z() > tooth.junction(p.x(), p.y()) ? 0 : 1);
  }

  if (tooth.own_template) {
    pair.matched.reserve(normals.size());
    pair.matched_normals.reserve(normals.size());
    for (std::size_t v = 0; v < normals.size(); ++v) {
      pair.matched.push_back(sample.frame.to_canonical(tooth.mesh.vertices[v]).cast<float>());
      pair.matched_normals.push_back(sample.frame.direction_to_canonical(normals[v]).cast<float>());
      pair.matched_root.push_back(tooth.crown[v] != 0 ? 0 : 1);
    }
  }

  double low = std::numeric_limits<double>::max(), high = -low, deepest = low;
  for (const Point& p : crop.mesh.vertices) {
    const double z = sample.frame.to_canonical(p).z();
    low = std::min(low, z), high = std::max(high, z);
  }
  for (const Point& p : tooth.mesh.vertices) deepest = std::min(deepest, sample.frame.to_canonical(p).z());
  sample.root_length_mm = (low - deepest) * sample.frame.scale;
  sample.crown_height_mm = (high - low) * sample.frame.scale;
  for (const Point& p : tooth.apices) sample.apices.push_back(sample.frame.to_canonical(p));
  for (const Eigen::Vector3d& axis : tooth.root_axes)
    sample.root_axes.push_back(sample.frame.direction_to_canonical(axis));
  sample.growth_axis = sample.frame.direction_to_canonical(tooth.growth_axis);
  const double error = options.form_axis_error_degrees * degree * (lost ? 3 : 1);
  const double error_x = random.normal(0, error), error_y = random.normal(0, error);
  Eigen::Vector2d form_axis =
      sample.frame.direction_to_canonical(tooth.crown_axis).head<2>() + Eigen::Vector2d(error_x, error_y);
  constexpr double longest = 0.5;  // as the registration has it
  form_axis *= longest / std::max(longest, form_axis.norm());
  const bool is_unknown = lost && random.chance(0.5);
  pair.form_axis = is_unknown ? Eigen::Vector2f::Zero() : Eigen::Vector2f(form_axis.cast<float>());
  sample.junction = tooth.junction;
  sample.gum_line = crop.line;
  sample.furcation_z = tooth.furcation_z;
  return sample;
}

}  // namespace rhizodont
