// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"

#include <functional>
#include <string>

namespace rhizodont {

/// A sentence, with a space before it, on the options `--repair` and `--skirt auto` for a crown that was refused with
/// `options`: those of them that are not set yet and with which `would_be_taken`. Empty if there are none.
/// `skirt_known`: whether there is a network to find a skirt with.
std::string way_out(const CompleteOptions& options, bool skirt_known,
                    const std::function<bool(const CompleteOptions&)>& would_be_taken);

}  // namespace rhizodont
