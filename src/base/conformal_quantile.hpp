// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace rhizodont {

/// The bound that a further value like these stays at or below with a probability of at least `share` (0..1): of n
/// values, the ceil(share (n + 1))-th (split conformal prediction: H. Papadopoulos, K. Proedrou, V. Vovk, A. Gammerman,
/// "Inductive confidence machines for regression", 2002). Precondition: not empty.
double conformal_quantile(std::vector<double> values, double share);

}  // namespace rhizodont
