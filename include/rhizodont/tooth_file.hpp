// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/export.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace rhizodont {

/// A completed tooth as a file with the vertex attributes `source` (values of VertexSource) and `uncertainty` (mm).
/// Where `crown`, the file that the tooth was completed from, has colours (red, green, blue, perhaps alpha; 0 to 255,
/// or floats from 0 to 1), scan vertices keep them and new vertices get their mean. Precondition: `tooth.record` has
/// the numbers of `crown.mesh`, not yet those of the file (`refer_to_file`).
RHIZODONT_EXPORT MeshFile tooth_file(const CompletedTooth& tooth, const MeshFile& crown);

/// The crown as a file with what the skirt network thinks of its vertices: `confidence`, that one is tooth, 0 to 1, -1
/// where it was not judged; `kept`, 1 if it is in the tooth. Precondition as of `tooth_file`; the record is of a
/// completion in which a skirt was looked for.
RHIZODONT_EXPORT MeshFile confidence_file(const MeshFile& crown, const CompletionRecord& record);

/// The FDI number of a permanent tooth that a file's name holds, if it holds just one: two digits with none beside them
/// that are no part of a date.
RHIZODONT_EXPORT std::optional<int> fdi_in_name(const std::filesystem::path& file);

/// Rounds the crown's coordinates to float, which is all that STL and GLB can hold. Returns by how much at most, in mm;
/// nothing if they were floats before. Throws InputError (id of the vertex) for a coordinate beyond all floats.
RHIZODONT_EXPORT std::optional<double> round_coordinates(MeshFile& crown, double millimetres_per_unit);

/// Throws UsageError where the format that the name `written_as` stands for has not the digits of the crown's
/// coordinates; the sentence calls the files `crown_name` and `output`.
RHIZODONT_EXPORT void require_format_holds_crown(const MeshFile& crown, const std::string& crown_name,
                                                 const std::filesystem::path& output,
                                                 const std::filesystem::path& written_as);

/// Puts a warning into the record if the crown was rounded before it was completed.
RHIZODONT_EXPORT void warn_of_rounding(const ReportedInput& input, CompletionRecord& record);

/// Throws NoResultError where the format of `output` holds single precision alone and the tooth needs more: of a crown
/// in single precision so far from the origin that new vertices there have double (`complete_tooth`).
RHIZODONT_EXPORT void require_format_holds(const CompletedTooth& tooth, const std::filesystem::path& output);

/// Puts a record of `crown.mesh` into the terms of the file that it was read from: vertices get their numbers there
/// (`MeshFile::file_vertices`), and the reader's notes go in front of the warnings, with a sentence on colours that a
/// tooth written to `output` cannot hold. To be called once, when the record's numbers are no longer needed as they
/// were.
RHIZODONT_EXPORT void refer_to_file(CompletionRecord& record, const MeshFile& crown,
                                    const std::filesystem::path& output);

/// The error with the file's numbers, where its elements are vertices.
RHIZODONT_EXPORT InputError in_terms_of_file(const InputError& error, const MeshFile& crown);
RHIZODONT_EXPORT NoResultError in_terms_of_file(const NoResultError& error, const MeshFile& crown);

}  // namespace rhizodont
