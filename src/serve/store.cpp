// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/store.hpp"

#include <fmt/format.h>

#include <random>

namespace rhizodont::serve {

std::string random_id() {
  std::random_device system;  // getrandom, not a generator with a seed
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", system(), system(), system(), system());
}

}  // namespace rhizodont::serve
