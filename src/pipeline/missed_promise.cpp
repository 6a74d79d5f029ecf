// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/missed_promise.hpp"

#include "mesh/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

namespace rhizodont {
namespace {

/// The sharpest of some triangles, and how many others are too sharp.
struct Sharp {
  std::size_t triangle = 0;
  double degrees = 180;
  int others = 0;

  void add(std::size_t t, double angle) {
    if (degrees < 180) ++others;
    if (angle >= degrees) return;
    triangle = t;
    degrees = angle;
  }
  bool any() const { return degrees < 180; }
};

MissedPlace place(const char* where, const Sharp& sharp, double bound, const TriangleMesh& tooth,
                  const std::vector<int>& kept_vertices) {
  MissedPlace missed;
  Point middle = Point::Zero();
  for (const int v : tooth.triangles[sharp.triangle]) {
    middle += tooth.vertices[static_cast<std::size_t>(v)] / 3;
    if (static_cast<std::size_t>(v) < kept_vertices.size())
      missed.crown_vertices.push_back(kept_vertices[static_cast<std::size_t>(v)]);
  }
  const std::string others =
      sharp.others == 0 ? "" : fmt::format("; {} more have less than {:.0f} degrees", sharp.others, bound);
  missed.sentence = fmt::format("A new triangle {} has an angle of only {:.2g} degrees, at ({:.2f}, {:.2f}, {:.2f}){}.",
                                where, sharp.degrees, middle.x(), middle.y(), middle.z(), others);
  return missed;
}

}  // namespace

std::vector<MissedPlace> where_promise_three_is_missed(const TriangleMesh& tooth, const std::vector<int>& kept_vertices,
                                                       std::size_t crown_triangles, const NewTriangleFigures& figures) {
  std::vector<MissedPlace> places;
  if (figures.holds() || !figures.all) return places;
  Sharp at_border, inner;
  for (std::size_t t = crown_triangles; t < tooth.triangles.size(); ++t) {
    const Triangle& triangle = tooth.triangles[t];
    const bool touches = std::any_of(triangle.begin(), triangle.end(),
                                     [&](int v) { return static_cast<std::size_t>(v) < kept_vertices.size(); });
    const auto angles = triangle_angles(tooth, t);
    const double angle = *std::min_element(angles.begin(), angles.end()) * 180 / std::numbers::pi;
    if (angle < (touches ? NewTriangleFigures::least_border_angle : NewTriangleFigures::least_inner_angle))
      (touches ? at_border : inner).add(t, angle);
  }
  if (at_border.any())
    places.push_back(
        place("at the crown's border", at_border, NewTriangleFigures::least_border_angle, tooth, kept_vertices));
  if (inner.any())
    places.push_back(place("of the root", inner, NewTriangleFigures::least_inner_angle, tooth, kept_vertices));
  if (places.empty())
    places.push_back(
        {fmt::format("New triangles are less even than promised: mean quality {:.3f} ({} promised), {:.2f} % "
                     "of angles under 30 degrees ({} % promised).",
                     figures.all->q_avg, NewTriangleFigures::least_q_avg, figures.all->percent_below_30,
                     NewTriangleFigures::most_percent_below_30),
         {}});
  return places;
}

}  // namespace rhizodont
