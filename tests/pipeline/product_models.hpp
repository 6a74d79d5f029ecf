// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/complete.hpp"
#include "rhizodont/io.hpp"

#include <filesystem>
#include <string>

namespace rhizodont::test {

inline const std::filesystem::path source_folder = RHIZODONT_SOURCE_DIR;

/// The models that the product ships, loaded once.
inline const CompletionModels& models() {
  static const CompletionModels loaded = CompletionModels::load(source_folder / "models");
  return loaded;
}

/// A crown of the folder samples/.
inline TriangleMesh sample(const std::string& name) { return load_mesh(source_folder / "samples" / name).mesh; }

/// Product defaults for a tooth whose number is known.
inline CompleteOptions for_tooth(int fdi) {
  CompleteOptions options;
  options.fdi = fdi;
  return options;
}

}  // namespace rhizodont::test
