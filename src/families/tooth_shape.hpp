// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "families/tooth_family.hpp"

#include <vector>

namespace rhizodont {

/// Monotone map of heights over the junction: slopes for crown, trunk (down to -trunk_depth) and the rest.
struct HeightMap {
  double crown = 1, trunk = 1, branch = 1;
  double trunk_depth = 3;  ///< template millimetres

  double operator()(double h) const;
};

/// What is drawn for one root.
struct RootShape {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the apex against the trunk, millimetres
  double shift_power = 2;
  Eigen::Vector2d curve = Eigen::Vector2d::Zero();  ///< of the tip, beside the shift, millimetres
  double curve_power = 3;
  double taper = 0, stretch = 0;
  double swelling = 0;       ///< of the lower half, relative
  double cross_section = 0;  ///< relative, along x against y
  double blunt = 0;          ///< millimetres taken off the tip, softly
};

/// All that is drawn for one tooth but its crown's form and surface.
struct ToothShape {
  Eigen::Vector3d scale{1, 1, 1};  ///< of the crown
  HeightMap height;
  double junction_scale = 1;
  Eigen::Vector2d root_section{1, 1};
  double taper = 0;
  Eigen::Vector2d lean = Eigen::Vector2d::Zero();  ///< of the root against the crown, millimetres at the apex
  Eigen::Vector2d bend = Eigen::Vector2d::Zero(), tip_bend = Eigen::Vector2d::Zero();
  double bend_power = 2, tip_power = 5;
  std::vector<RootShape> roots;
};

/// Draws a shape of a type on a template. Depends on the arguments alone.
ToothShape draw_shape(const FamilyTemplate& source, const ToothDimensions& mean, int type,
                      const ToothPopulation& people, const ToothVariation& variation, const SharedDraws& shared,
                      RandomStream& random);

/// Position of a template vertex, which may have been moved by a crown model, in the drawn shape.
/// @param root  root that the vertex belongs to below its branching, else -1
Point shaped(const FamilyTemplate& source, const ToothShape& shape, const Point& p, int root);

/// Smooth displacements: a sum of sine waves in space with a bounded gradient.
class Waves {
 public:
  /// @param deviation  of the displacement along one axis, millimetres
  Waves(RandomStream& random, int count, double shortest, double longest, double deviation);
  Eigen::Vector3d operator()(const Point& p) const;

 private:
  struct Wave {
    Eigen::Vector3d frequency;
    double phase;
    Eigen::Vector3d height;
  };
  std::vector<Wave> waves_;
};

}  // namespace rhizodont
