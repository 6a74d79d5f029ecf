// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/mean_crowns.hpp"

#include <filesystem>

namespace rhizodont::test {

inline const std::filesystem::path source_folder = RHIZODONT_SOURCE_DIR;

/// The mean crowns that the product ships, loaded once.
inline const Atlas& atlas() {
  static const Atlas loaded = load_atlas(source_folder / "models" / "atlas.safetensors");
  return loaded;
}

}  // namespace rhizodont::test
