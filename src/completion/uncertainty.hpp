// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/complete_points.hpp"
#include "rhizodont/mesh.hpp"
#include "teeth/prepared_crown.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont {

/// What turns the network's expected distances into statements about a tooth: measured on generated teeth that were
/// never trained on (split conformal prediction: Papadopoulos et al., "Inductive confidence machines for regression",
/// 2002) and kept in the weight file.
struct UncertaintyScales {
  double length_low = 0;   ///< 10 % quantile of (true - predicted root length) / expected distance at the apex
  double length_high = 0;  ///< 90 % quantile of the same
  double apex = 0;         ///< 80 % quantile of the apex's distance from the true one / expected distance at the apex
  double surface = 0;      ///< mean distance of new vertices from the true surface / their mean expected distance
};

/// Reads them from a weight file's metadata: those of the type of a permanent tooth (FDI number) where they were
/// measured, else those of all teeth together; nothing if the weights were never calibrated. Throws InputError if they
/// cannot be read as numbers.
std::optional<UncertaintyScales> uncertainty_scales(const std::map<std::string, std::string>& metadata, int fdi = 0);
/// Adds them to a weight file's metadata: those of all teeth, and of types by the FDI number of their left tooth, whose
/// `surface` is that of all. What types were there before is taken away.
void note_uncertainty_scales(const UncertaintyScales& scales, std::map<std::string, std::string>& metadata,
                             const std::map<int, UncertaintyScales>& by_tooth = {});

/// Expected distance from their places, mm, of the predicted points that lie deepest along the growth axis: the mean
/// over 16 of them. Precondition: at least 16 points; growth_axis is a unit vector from root to crown.
double expected_distance_at_apex(const PredictedTooth& predicted, const Eigen::Vector3d& growth_axis);

/// Where a root's length lies with 80 % probability, mm: among the lengths that roots can have, and never without the
/// length itself. `expected_at_apex`: mm, >= 0.
std::pair<double, double> length_interval(double length, double expected_at_apex, const UncertaintyScales& scales);

/// Expected distance of each vertex of a tooth, mm: that of the predicted points nearby. It fades to nothing at the
/// crown, whose own surface corrects the prediction around it over `reach` mm (> 0), and is 0 on the crown itself.
/// @param tooth   the crown's vertices first
/// @param crown   the first vertices and triangles of the tooth
std::vector<double> expected_distances(const TriangleMesh& tooth, const PreparedCrown& crown,
                                       const PredictedTooth& predicted, double reach);

}  // namespace rhizodont
