// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/surface_sample.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "rhizodont/error.hpp"

namespace rhizodont {

void check_surface_sample(const SurfaceSample& s, bool labelled) {
  const auto n = static_cast<std::size_t>(std::max(s.vertices, 0)),
             k = static_cast<std::size_t>(std::max(s.eigenvectors, 0));
  const std::size_t entries = s.neighbours.size();
  bool good = n > 0 && k > 0 && s.features.size() == n * surface_feature_count && s.mass.size() == n &&
              s.eigenvalues.size() == k && s.basis.size() == n * k && s.first.size() == n + 1 &&
              s.gradient_x.size() == entries && s.gradient_y.size() == entries &&
              (labelled ? s.labels.size() == n : true);
  if (!good) throw InputError("The arrays of a surface do not fit each other.");
  good =
      s.first.front() == 0 && s.first.back() == static_cast<std::int32_t>(entries) &&
      std::is_sorted(s.first.begin(), s.first.end()) &&
      std::all_of(s.neighbours.begin(), s.neighbours.end(), [&](std::int32_t v) { return v >= 0 && v < s.vertices; });
  for (const auto* values : {&s.features, &s.mass, &s.eigenvalues, &s.basis, &s.gradient_x, &s.gradient_y})
    good = good && std::all_of(values->begin(), values->end(), [](float x) { return std::isfinite(x); });
  if (!good) throw InputError("A surface has features or operators that are not finite or out of range.");
}

}  // namespace rhizodont
