// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/frame.hpp"
#include "learning/completion_network.hpp"
#include "rhizodont/complete.hpp"

namespace rhizodont {

struct CompletionModels::Content {
  Atlas atlas;
  CompletionNetwork network;
};

}  // namespace rhizodont
