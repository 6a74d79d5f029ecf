// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <filesystem>

namespace rhizodont {

/// A completed tooth as a file with the vertex attributes `source` (values of VertexSource) and `uncertainty` (mm).
/// Where `crown`, the file that the tooth was completed from, has colours (red, green, blue, perhaps alpha; 0 to 255,
/// or floats from 0 to 1), scan vertices keep them and new vertices get their mean. Precondition: `tooth.record` has
/// the numbers of `crown.mesh`, not yet those of the file (`refer_to_file`).
MeshFile tooth_file(const CompletedTooth& tooth, const MeshFile& crown);

/// The FDI number of a permanent tooth that a file's name holds, if it holds just one: two digits with none beside them
/// that are no part of a date.
std::optional<int> fdi_in_name(const std::filesystem::path& file);

/// Throws NoResultError where the format of `output` holds single precision alone and the tooth needs more: of a crown
/// in single precision so far from the origin that new vertices there have double (`complete_tooth`).
void require_format_holds(const CompletedTooth& tooth, const std::filesystem::path& output);

/// Puts a record of `crown.mesh` into the terms of the file that it was read from: vertices get their numbers there
/// (`MeshFile::file_vertices`), and the reader's notes go in front of the warnings, with a sentence on colours that a
/// tooth written to `output` cannot hold. To be called once, when the record's numbers are no longer needed as they
/// were.
void refer_to_file(CompletionRecord& record, const MeshFile& crown, const std::filesystem::path& output);

/// The error with the file's numbers, where its elements are vertices.
InputError in_terms_of_file(const InputError& error, const MeshFile& crown);
NoResultError in_terms_of_file(const NoResultError& error, const MeshFile& crown);

}  // namespace rhizodont
