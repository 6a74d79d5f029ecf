// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/arch_family.hpp"
#include "networks/labelled_cloud.hpp"
#include "segment/scan_points.hpp"

#include <cstdint>
#include <filesystem>

namespace rhizodont {

/// The frame of the network that finds teeth in a generated scan, as it truly is: z occlusal, y to the front.
ScanFrame true_frame(const GeneratedArch& arch);

/// Generated scan number `seed` as the network that finds teeth is trained on it: points in the true frame, with the
/// teeth that they belong to. Depends on its arguments alone. Throws as sample_arch and scan_points.
LabelledCloud make_arch_cloud(const ArchFamily& family, std::uint64_t seed, const ArchDrawOptions& options = {});

/// The same from a folder of such clouds, made and put there where it is missing. The folder must be of the same
/// version of the generator. Throws OutputError where it cannot be written to, InputError for a damaged file.
LabelledCloud kept_arch_cloud(const ArchFamily& family, std::uint64_t seed, const std::filesystem::path& folder,
                              const ArchDrawOptions& options = {});

}  // namespace rhizodont
