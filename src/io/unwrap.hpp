// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// What a file holds without its wrapping.
struct Unwrapped {
  std::string_view bytes;          ///< within what was given or `storage`
  std::string storage;             ///< of what was unpacked or converted; not moved while `bytes` is in use
  std::vector<std::string> notes;  ///< what was taken off
};

/// Unpacks gzip (RFC 1952, also in several members), turns UTF-16 of either byte order, with or without a byte order
/// mark, into UTF-8, and takes off a byte order mark. Unpacked contents may be 1 GiB, and where they are more than 64
/// MiB, 200 times the packed size: meshes pack far less, and a larger one would only fill the memory. Throws InputError
/// for packed data that are damaged, cut off or larger, and for UTF-32.
void unwrap(std::string_view bytes, Unwrapped& result);

}  // namespace rhizodont
