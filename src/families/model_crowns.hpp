// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "families/crown_model.hpp"
#include "families/tooth_family.hpp"

#include <filesystem>
#include <vector>

namespace rhizodont {

/// A statistical crown model as a surface of its own, without a template: what is finer than a template has stays.
struct ModelCrown {
  /// Left type, closed surface of the mean crown, millimetres, axes as in a tooth's frame, about its middle. No root.
  SyntheticTooth mean;
  std::vector<Eigen::MatrixX3d> modes;  ///< displacement of each vertex in that frame
  std::vector<double> deviations;       ///< of the modes' coefficients, millimetres
  /// How far above the end at the gum a drawn crown's junction lies, millimetres.
  static constexpr double junction_above_rim_mm = 0.3;
};

/// A surface through points that lie close on one, turned outward, by advancing fronts (D. Cohen-Steiner, F. Da, "A
/// greedy Delaunay-based surface reconstruction algorithm", 2004; CGAL). Vertices keep their order.
TriangleMesh closed_surface(const std::vector<Point>& points);

/// Reads folder/crown_ssm_FDI.safetensors for x1-x7 of all four quadrants, those of the right side mirrored, and meshes
/// each model's mean points by advancing fronts (D. Cohen-Steiner, F. Da, "A greedy Delaunay-based surface
/// reconstruction algorithm", 2004; CGAL).
/// Throws as load_crown_shape_model, InputError if a model's points give no closed surface of genus 0.
std::vector<ModelCrown> load_model_crowns(const std::filesystem::path& folder);

/// A crown of the model in the frame of SyntheticTooth: coefficients of its modes drawn with `factor` times their
/// deviations.
SyntheticTooth draw_model_crown(const ModelCrown& crown, double factor, RandomStream& random);

}  // namespace rhizodont
