// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"
#include "networks/surface_network.hpp"
#include "rhizodont/complete.hpp"
#include "skirt/skirt.hpp"

namespace rhizodont {

/// What the tooth will keep of an input: in millimetres, repaired if asked for, open at the base, its border made of
/// simple loops. Numbers of vertices and triangles in the result, and ids of errors, are the input's. Notes in the
/// record what was kept, dropped and repaired. Throws InputError where there is no crown that a root can be joined to.
/// `skirt`: judges the crown if `options.skirt` is set; UsageError if it is not there then.
KeptCrown take_crown(const TriangleMesh& input, const Atlas& atlas, const std::optional<SurfaceNetwork>& skirt,
                     const CompleteOptions& options, CompletionRecord& record);

}  // namespace rhizodont
