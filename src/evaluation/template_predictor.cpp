// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// P. Besl, N. McKay, "A method for registration of 3-D shapes", 1992; D. Chetverikov et al., "Robust Euclidean
// alignment of 3D point sets: the trimmed iterative closest point algorithm", 2005.
#include "evaluation/template_predictor.hpp"

#include "base/option_range.hpp"
#include "base/parallel_tasks.hpp"
#include "completion/similarity.hpp"
#include "evaluation/root_figures.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/geometry.hpp"
#include "mesh/mean_point.hpp"
#include "mesh/nearest_vertex.hpp"
#include "mesh/principal_axis.hpp"
#include "mesh/sampling.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "teeth/fdi.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace rhizodont {
namespace {

constexpr double crown_share_of_unlabelled = 0.4;

/// Mean squared distance from the mean.
double spread(const std::vector<Point>& points) {
  const Point mean = mean_point(points);
  double sum = 0;
  for (const Point& p : points) sum += (p - mean).squaredNorm();
  return sum / static_cast<double>(points.size());
}

/// The long axis with its wider end up.
Eigen::Vector3d axis_to_wider_end(const std::vector<Point>& points) {
  const Point mean = mean_point(points);
  const Eigen::Vector3d axis = principal_axis(points);
  // The third moment of width: positive where what lies above the middle is the wider part.
  double lean = 0;
  for (const Point& p : points) {
    const double along = (p - mean).dot(axis);
    lean += along * ((p - mean).squaredNorm() - along * along);
  }
  return lean >= 0 ? axis : Eigen::Vector3d(-axis);
}

std::vector<bool> enamel_vertices(const MeshFile& file) {
  const std::size_t count = file.mesh.vertices.size();
  std::vector<bool> enamel(count, false);
  const auto label = file.vertex_attributes.find("crown");
  if (label != file.vertex_attributes.end())
    for (std::size_t v = 0; v < count; ++v) enamel[v] = label->second.values[v] == 1;
  if (std::find(enamel.begin(), enamel.end(), true) != enamel.end()) return enamel;
  const Eigen::Vector3d axis = axis_to_wider_end(file.mesh.vertices);
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
  for (const Point& p : file.mesh.vertices) low = std::min(low, p.dot(axis)), high = std::max(high, p.dot(axis));
  for (std::size_t v = 0; v < count; ++v)
    enamel[v] = file.mesh.vertices[v].dot(axis) > high - crown_share_of_unlabelled * (high - low);
  return enamel;
}

TriangleMesh mirrored(TriangleMesh mesh) {
  for (Point& p : mesh.vertices) p.x() = -p.x();
  return flipped(mesh);
}

using Transform = Eigen::Transform<double, 3, Eigen::Affine>;

/// Both crowns as points, each with an index for the nearest.
struct Registration {
  Registration(const TriangleMesh& crown, const TemplateTooth& tooth, const TemplateFitOptions& given)
      : options(given),
        axis(crown_growth_axis(crown)),
        target(sample_surface(crown, options.samples, 1).points),
        source(sample_surface(tooth.crown, options.samples, 1).points),
        whole_source(sample_surface(tooth.mesh, 2 * options.samples, 1).points) {
    for (const Triangle& triangle : crown.triangles)
      for (const int v : triangle) border = std::min(border, crown.vertices[static_cast<std::size_t>(v)].dot(axis));
  }

  const TemplateFitOptions& options;
  Eigen::Vector3d axis;  ///< of the crown
  NearestVertexIndex target, source, whole_source;
  double border = std::numeric_limits<double>::infinity();  ///< lowest height of the crown, mm along its axis
};

/// Template points and the crown points that they should come to lie on.
struct Pairs {
  std::vector<Point> from, to;
  double mean_distance = 0;  ///< from the crown's points to the template's, mm
};

/// The template's crown may reach below the scanned one and be worn or shaped otherwise: its points near and below the
/// border and the farthest of the rest are left out. All of the scanned crown's points take part, also with the
/// template's root: a scan may reach below the cemento-enamel junction.
Pairs find_pairs(const Registration& r, const Transform& similarity, double scale) {
  Pairs pairs;
  std::vector<std::pair<double, std::pair<std::size_t, int>>> near;
  for (std::size_t i = 0; i < r.source.size(); ++i) {
    const Point moved = similarity * r.source.points()[i];
    if (moved.dot(r.axis) <= r.border + r.options.border_margin_mm) continue;
    const NearVertex hit = r.target.nearest(moved);
    near.push_back({hit.squared_distance, {i, hit.index}});
  }
  std::sort(near.begin(), near.end());
  near.resize(static_cast<std::size_t>(r.options.trim * static_cast<double>(near.size())));
  for (const auto& [distance, ids] : near) {
    pairs.from.push_back(r.source.points()[ids.first]);
    pairs.to.push_back(r.target.points()[static_cast<std::size_t>(ids.second)]);
  }
  const Transform back = similarity.inverse();
  double sum = 0;
  for (const Point& p : r.target.points()) {
    const NearVertex hit = r.whole_source.nearest(back * p);  // a similarity keeps who is nearest
    pairs.from.push_back(r.whole_source.points()[static_cast<std::size_t>(hit.index)]);
    pairs.to.push_back(p);
    sum += scale * std::sqrt(hit.squared_distance);
  }
  pairs.mean_distance = sum / static_cast<double>(r.target.size());
  return pairs;
}

Eigen::Matrix3Xd as_columns(const std::vector<Point>& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return columns;
}

struct Fit {
  Transform similarity = Transform::Identity();
  double scale = 1;
  double mean_distance = std::numeric_limits<double>::infinity();  ///< mm
};

/// Least squares over the pairs; the scale changes by at most `largest_scale_step`.
void improve(const Pairs& pairs, double largest_scale_step, Fit& fit) {
  const Similarity best = similarity_of_pairs(as_columns(pairs.from), as_columns(pairs.to),
                                              {fit.scale / largest_scale_step, fit.scale * largest_scale_step});
  fit.scale = best.scale;
  fit.similarity.linear() = best.scale * best.rotation;
  fit.similarity.translation() = best.shift;
}

Fit fit_from(const Registration& r, const Eigen::Matrix3d& rotation) {
  Fit fit;
  fit.scale = std::sqrt(spread(r.target.points()) / spread(r.source.points()));
  fit.similarity.linear() = fit.scale * rotation;
  fit.similarity.translation() =
      mean_point(r.target.points()) - fit.similarity.linear() * mean_point(r.source.points());
  for (int i = 0; i < r.options.iterations; ++i)
    improve(find_pairs(r, fit.similarity, fit.scale), r.options.largest_scale_step, fit);
  fit.mean_distance = find_pairs(r, fit.similarity, fit.scale).mean_distance;
  return fit;
}

void require_in_range(const TemplateFitOptions& options) {
  require_ranges("the template fit", {{"start_rotations", options.start_rotations, OptionRange::at_least(1)},
                                      {"iterations", options.iterations, OptionRange::at_least(1)},
                                      {"samples", options.samples, OptionRange::at_least(100)},
                                      {"trim", options.trim, OptionRange::above(0).at_most(1)},
                                      {"border_margin_mm", options.border_margin_mm, OptionRange::at_least(0)},
                                      {"largest_scale_step", options.largest_scale_step, OptionRange::above(1)}});
}

}  // namespace

TemplateTooth load_template_tooth(const std::filesystem::path& folder, int fdi) {
  const int left = fdi_of_type(tooth_type_of_fdi(fdi), false);
  const MeshFile file = load_mesh(folder / ("tooth_" + std::to_string(left) + ".ply"));

  const std::vector<bool> enamel = enamel_vertices(file);
  std::vector<bool> in_crown;
  for (const Triangle& triangle : file.mesh.triangles)
    in_crown.push_back(
        std::all_of(triangle.begin(), triangle.end(), [&](int v) { return enamel[static_cast<std::size_t>(v)]; }));
  TemplateTooth tooth{file.mesh, submesh(file.mesh, in_crown).mesh, {}};
  if (is_right_side(fdi)) {
    tooth.mesh = mirrored(tooth.mesh);
    tooth.crown = mirrored(tooth.crown);
  }
  const Eigen::Vector3d axis = principal_axis(tooth.mesh.vertices);
  tooth.axis = axis.dot(crown_growth_axis(tooth.crown)) > 0 ? axis : Eigen::Vector3d(-axis);
  return tooth;
}

TriangleMesh fit_template(const TriangleMesh& crown, const TemplateTooth& tooth, const TemplateFitOptions& options) {
  require_in_range(options);
  const Registration registration(crown, tooth, options);
  const Eigen::Matrix3d upright = Eigen::Quaterniond::FromTwoVectors(tooth.axis, registration.axis).toRotationMatrix();
  std::vector<Fit> fits(static_cast<std::size_t>(options.start_rotations));
  parallel_tasks(fits.size(), [&](std::size_t k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(fits.size());
    fits[k] = fit_from(registration, Eigen::AngleAxisd(angle, registration.axis) * upright);
  });
  const auto best = std::min_element(fits.begin(), fits.end(),
                                     [](const Fit& a, const Fit& b) { return a.mean_distance < b.mean_distance; });
  TriangleMesh moved = tooth.mesh;
  for (Point& p : moved.vertices) p = best->similarity * p;
  return moved;
}

}  // namespace rhizodont
