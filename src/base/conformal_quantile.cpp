// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/conformal_quantile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace rhizodont {

double conformal_quantile(std::vector<double> values, double share) {
  assert(!values.empty());
  const auto n = static_cast<double>(values.size());
  const auto place = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * (n + 1)), 1.0, n)) - 1;
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

}  // namespace rhizodont
