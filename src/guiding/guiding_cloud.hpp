// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"
#include "teeth/prepared_crown.hpp"

#include <vector>

namespace rhizodont {

struct GuidingCloudOptions {
  double crown_spacing = 0.15;       ///< mm, > 0: mean distance of the samples taken on the scanned crown
  double orientation_spacing = 0.4;  ///< mm, > 0: of those of them that take part in orienting the prediction
  double crown_confidence = 4;       ///< > 0: how much more than predicted points the scanned ones count
  double gap = 0.25;                 ///< mm, >= 0: predicted points nearer to the crown are left out
  double correction_reach = 6;       ///< mm, > 0: how far from the crown the prediction is corrected to meet it
  int smoothing_neighbours = 40;     ///< >= 12: neighbours to which a quadric is fitted at each predicted point
  int smoothing_rounds = 3;          ///< >= 0: how often predicted points are moved to that quadric
};

/// The oriented points that the guiding surface is made of.
struct GuidingCloud {
  OrientedPoints samples;
  std::vector<double> confidence;  ///< per sample
  int crown_samples = 0;           ///< the first ones; the rest is predicted
  int predicted_dropped = 0;       ///< predicted points over the crown or too near to it
  double prediction_error = 0;     ///< mm, mean distance of predicted crown points from the scanned crown
};

/// Puts dense samples of the scanned crown (paper, 3.5: additional points before the Poisson solver) and the predicted
/// points beyond it into one cloud. The prediction is first corrected by what it gets wrong on the crown, where the
/// truth is known: the correction fades with the distance from the crown. Predicted normals serve as hints; directions
/// come from the points.
/// `predicted`: whole tooth in mm, normals outward but rough. Throws InputError as `orient_normals` does, NoResultError
/// where no predicted point lies beyond the crown.
GuidingCloud assemble_guiding_cloud(const PreparedCrown& crown, const OrientedPoints& predicted,
                                    const GuidingCloudOptions& options = {});

}  // namespace rhizodont
