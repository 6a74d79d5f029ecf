// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/export.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont {

/// A result on its way to the disk.
struct OutputFile {
  std::filesystem::path path;
  std::string bytes;
};

/// Writes all files of a command, or none: each is written in full beside its place and brought to the disk before the
/// first one is moved into place; if a move fails, those before it are taken back. Missing folders are made, and
/// removed again on failure.
///
/// - A file that is replaced hands on its mode and, where the user may, its owner. One without any right to write is
///   not replaced.
/// - Links are followed, also one that leads to nothing yet; the link stays. Other names of a hard-linked file keep the
///   older contents.
/// - Pipes and devices are written to, never replaced, after all files are ready and before the first is moved.
/// - Signals that would end the program wait until the files are all in place or all taken back; then they end it. A
///   full pipe's reader that went away and a file beyond the limit of sizes are failures like any other.
///
/// Where the file system can keep files without a name (O_TMPFILE), not even SIGKILL leaves an unfinished one behind.
/// Throws OutputError, with the reason, if any of them cannot be written; then what stood there before stands there
/// still.
RHIZODONT_EXPORT void write_output_files(const std::vector<OutputFile>& files);

/// Whether a file could be written here, without writing: for use before long work. Missing folders do not matter if
/// they could be made. Throws OutputError if not.
RHIZODONT_EXPORT void require_writable_place(const std::filesystem::path& path);

/// Refuses outputs that are the same file as an input or as another output: by name, through links of both kinds, or
/// because both would lead to the same new file. Devices may be named several times, pipes may not. Throws UsageError.
RHIZODONT_EXPORT void require_separate_files(const std::vector<std::filesystem::path>& inputs,
                                             const std::vector<std::filesystem::path>& outputs);

/// Whether writing there goes into a pipe, a device or a file that the program was started with (/dev/fd/3), whose name
/// says nothing of its contents.
RHIZODONT_EXPORT bool is_stream(const std::filesystem::path& path);

/// Whether this path is the program's own standard output, such as /dev/stdout.
RHIZODONT_EXPORT bool is_standard_output(const std::filesystem::path& path);

}  // namespace rhizodont
