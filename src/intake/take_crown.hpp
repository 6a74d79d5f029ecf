// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "networks/surface_network.hpp"
#include "rhizodont/complete.hpp"
#include "skirt/skirt.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont {

/// What was found and done on the way from an input to a usable crown.
struct IntakeRecord {
  bool cap_dropped = false;
  std::vector<float> tooth_confidence;  ///< as CrownRecord::tooth_confidence
  std::map<std::string, std::string>
      skirt_model;  ///< what the skirt network's weights say of themselves, if it was asked
  std::vector<RepairStep> repairs;
};

/// The part of an input that its tooth will have.
struct TakenCrown {
  KeptCrown kept;
  IntakeRecord record;
};

/// What the tooth will keep of an input: in millimetres, repaired if asked for, open at the base, its border made of
/// simple loops. Numbers of vertices and triangles in the result, and ids of errors, are the input's. Throws InputError
/// where there is no crown that a root can be joined to.
/// `skirt`: judges the crown if `options.skirt` is set; UsageError if it is not there then.
TakenCrown take_crown(const TriangleMesh& input, const Atlas& atlas, const std::optional<SurfaceNetwork>& skirt,
                      const CompleteOptions& options);

}  // namespace rhizodont
