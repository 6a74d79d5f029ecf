// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/matrix.hpp"

namespace rhizodont::networks {

// Functions of single numbers and of rows, on this thread. Compiled without fused multiply-add: the same bits on all
// processors. Errors are absolute, for all finite arguments; of others, NaN stays NaN and infinity may become it.

/// x -> x / 2 (1 + erf(x / sqrt 2)), within 3e-7 (1 + |x|) (Hendrycks, Gimpel: Gaussian Error Linear Units, 2016).
void gelu(MatrixSpan values);

/// x -> tanh x, within 3e-7.
void hyperbolic_tangent(MatrixSpan values);

/// x -> max(x, 0).
void rectify(MatrixSpan values);

/// x -> x where it is positive, else a fifth of it.
void leaky_rectify(MatrixSpan values);

/// Each row becomes exp(x) over the sum of its exponentials.
void softmax_rows(MatrixSpan values);

/// Each row less its mean, over its deviation, times `scale` plus `shift` per channel (Ba et al., Layer
/// Normalization, 2016).
void normalise_rows(MatrixSpan values, const Eigen::RowVectorXf& scale, const Eigen::RowVectorXf& shift);

}  // namespace rhizodont::networks
