// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace rhizodont {

/// The linear algebra library that the running program has loaded.
struct LoadedBlas {
  std::string path;   ///< file of the library; empty if none is loaded
  bool fast = false;  ///< true for the OpenMP build of OpenBLAS, the one that the networks are fast with
};

/// Looks through the shared objects of this process for the BLAS that torch's calls reach.
LoadedBlas loaded_blas();

/// One sentence for the user if training will be slow with the loaded BLAS; empty if all is well.
std::string blas_warning();

}  // namespace rhizodont
