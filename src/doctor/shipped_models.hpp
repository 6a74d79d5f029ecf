// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace rhizodont::doctor {

/// A file of models/ as it was when the program was built.
struct ShippedModel {
  const char* name;
  const char* sha256;
};

/// All of them, by name. Written by CMake.
const std::vector<ShippedModel>& shipped_models();

}  // namespace rhizodont::doctor
