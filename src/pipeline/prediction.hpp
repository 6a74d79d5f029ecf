// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/complete_points.hpp"
#include "completion/registration.hpp"
#include "completion/solidity.hpp"
#include "pipeline/models.hpp"
#include "rhizodont/complete.hpp"

#include <functional>

namespace rhizodont {

/// A whole tooth for a crown, and the pose in which it was predicted.
struct RootPrediction {
  PredictedTooth tooth;
  CrownFrame frame;
  RootSource source = RootSource::network;
  Solidity solidity;  ///< of the root's points
};

/// The network's tooth for a crown. Where its root comes out as shreds, the crown is laid anew (turned about its axis;
/// upright by its form instead of its border) and the most solid root is taken; where none is solid, the mean tooth of
/// the type, laid on the crown, with the uncertainty that has. `frame`: as found from the crown. `makes_a_root` has the
/// last word on each prediction whose points are solid, best first, and is called for no other once it agreed. Throws
/// as `complete_points`, NoResultError where that does not fit either.
RootPrediction predict_tooth(const TriangleMesh& crown, int fdi, const CrownFrame& frame,
                             const CompletionModels::Content& models,
                             const std::function<bool(const RootPrediction&)>& makes_a_root);

/// Whether the root of a closed surface made of the prediction tapers towards its apex, as roots do and shreds do not.
bool root_tapers(const TriangleMesh& surface, const TriangleMesh& crown, const CrownFrame& frame);

}  // namespace rhizodont
