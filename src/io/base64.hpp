// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace rhizodont {

/// Bytes of a base64 text (RFC 4648). White space is passed over; after padding a new group may begin, as where several
/// encoded pieces stand one after the other. Reading ends at the first other character.
std::string decode_base64(std::string_view text);

}  // namespace rhizodont
