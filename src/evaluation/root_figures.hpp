// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evaluation/root_apices.hpp"
#include "rhizodont/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace rhizodont {

struct RootFigureOptions {
  std::size_t samples = 16384;       ///< points on each tooth's surface, >= 100 (the paper's number of output points)
  std::uint64_t seed = 7;            ///< of the sampling, the same for both teeth
  double root_threshold_mm = 0.5;    ///< > 0: at which the root's F-score is taken
  double surface_threshold = 0.01;   ///< > 0: at which the whole surface's F-score is taken, share of the diagonal
  double least_prominence_mm = 1.0;  ///< > 0: a shallower bump on a root is not an apex of its own
};

/// How far a predicted tooth is from the true one. "Root" is what lies, along the growth axis, below the lowest point
/// of the crown, on either tooth.
struct RootFigures {
  double true_root_length_mm = 0;   ///< lowest point of the crown to the lowest of the true tooth, along the axis
  double root_length_error_mm = 0;  ///< predicted minus true; positive: the prediction is too long
  double apex_distance_mm = 0;      ///< between the lowest vertices along the axis

  std::vector<RootApex> true_apices, predicted_apices;  ///< deepest first; as many as the tooth has roots
  std::vector<ApexPair> matched_apices;                 ///< by true apex
  double matched_apex_distance_mm = 0;                  ///< mean over the pairs; apex_distance_mm where there is none

  /// Predicted minus true height of the highest furcation along the axis; where both teeth have several roots.
  std::optional<double> furcation_height_error_mm;

  double root_chamfer_mm = 0;      ///< mean of the two mean distances, each from one root's points to the other's
  double root_f_score = 0;         ///< [0, 1], at root_threshold_mm
  double root_hausdorff95_mm = 0;  ///< larger of the two directions' 95th percentiles
  double root_axis_angle_deg = 0;  ///< between the directions from the upper half of the root's surface to the lower

  /// Whole surface, lengths divided by the diagonal of the true tooth's bounding box.
  double chamfer_l2_e3 = 0;  ///< 1000 x sum of the two mean squared distances
  double f_score = 0;        ///< [0, 1], at surface_threshold
};

/// Unit growth axis of an open crown, root to crown: its area vector (which depends on the border alone).
/// Throws InputError for a closed crown, which has none.
Eigen::Vector3d crown_growth_axis(const TriangleMesh& crown);

/// Compares two whole teeth that stand on one crown. All distances are between points sampled from the surfaces
/// (uniform, as many on each tooth), so that figures of two equal surfaces with different triangles do not reach zero:
/// half the spacing of the samples remains, about 0.1 mm. Chamfer-L2 and F-score at 1 % as in the paper, 4.2, in units
/// of the bounding box's diagonal.
/// @param crown  gives the level below which there is root; open or closed
/// @param axis   from root to crown, any length > 0
/// Throws InputError for a crown or a tooth without surface, with an index out of range or a coordinate that is not a
/// number, and for a true tooth that does not reach below the crown; NoResultError for a prediction that does not;
/// UsageError for an option out of range.
RootFigures root_figures(const TriangleMesh& crown, const TriangleMesh& truth, const TriangleMesh& predicted,
                         const Eigen::Vector3d& axis, const RootFigureOptions& options = {});

}  // namespace rhizodont
