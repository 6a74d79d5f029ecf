// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/loaded_blas.hpp"

#include <dlfcn.h>
#include <link.h>

#include <climits>
#include <cstdlib>
#include <string_view>

namespace rhizodont {
namespace {

/// Keeps the first library whose file name is that of a BLAS: the loader resolves symbols in the same order.
int find_blas(dl_phdr_info* info, std::size_t, void* found) {
  const std::string_view path = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  const std::string_view file = path.substr(path.rfind('/') + 1);
  auto& result = *static_cast<std::string*>(found);
  if (result.empty() && (file.starts_with("libblas.so") || file.starts_with("libopenblas") ||
                         file.starts_with("libmkl_rt.so") || file.starts_with("libblis")))
    result = std::string(path);
  return 0;
}

}  // namespace

LoadedBlas loaded_blas() {
  LoadedBlas blas;
  dl_iterate_phdr(find_blas, &blas.path);
  if (blas.path.empty()) return blas;
  char resolved[PATH_MAX];
  const std::string real = realpath(blas.path.c_str(), resolved) == nullptr ? blas.path : resolved;
  blas.fast = real.find("openblas-openmp") != std::string::npos;
  blas.path = real;
  return blas;
}

std::string blas_warning() {
  const LoadedBlas blas = loaded_blas();
  if (blas.fast) return {};
  return "Training will be slow: the loaded linear algebra library is " + (blas.path.empty() ? "unknown" : blas.path) +
         ", not the OpenMP build of OpenBLAS (Debian package libopenblas0-openmp).";
}

}  // namespace rhizodont
