// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/segment.hpp"
#include "segment/arch_model.hpp"
#include "segment/teeth_reading.hpp"

namespace rhizodont {

/// Teeth, numbers and borders from what a network says of a scan. @param scan  in millimetres, three different corners
/// in range per triangle; places in the options and the result are in the options' unit. Throws as segment_scan.
SegmentedScan label_scan(const TriangleMesh& scan, const TeethReading& reading, const ArchModel& arch,
                         const SegmentOptions& options);

}  // namespace rhizodont
