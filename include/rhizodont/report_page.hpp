// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/arch.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/mesh.hpp"

#include <string>

namespace rhizodont {

/// Whether the library was built with the pages that the functions below give.
RHIZODONT_EXPORT bool has_report_pages();

/// A tooth to look at: the report with the tooth and its crown in three dimensions, as HTML in one file that needs
/// nothing beside it. Throws UsageError if there are no pages.
/// @param crown  as it was given to `complete_tooth`
RHIZODONT_EXPORT std::string tooth_page(const CompletedTooth& tooth, const TriangleMesh& crown);

/// All teeth of an arch likewise.
/// @param scan, options  as they were given to `complete_arch`
RHIZODONT_EXPORT std::string arch_page(const CompletedArch& arch, const LabelledScan& scan, const ArchOptions& options);

}  // namespace rhizodont
