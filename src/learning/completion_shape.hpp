// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace rhizodont {

inline constexpr int tooth_types = 16;   ///< upper 1..8 are 0..7, lower 1..8 are 8..15; left and right share a type
inline constexpr int unknown_type = 16;  ///< the type of a crown whose FDI number is not known

/// Sizes of the completion network. The defaults are those of the shipped weights.
struct CompletionShape {
  int input_points = 1024;  ///< crown points that the network looks at, >= centres_1
  int centres_1 = 256;      ///< points left after the grouper's first thinning, >= centres_2
  int centres_2 = 128;      ///< tokens of the encoder, >= 16
  int width = 192;          ///< channels of a token, a multiple of `heads`
  int heads = 3;            ///< attention heads, >= 1
  int encoder_depth = 4;    ///< blocks, >= 1
  int decoder_depth = 4;    ///< blocks, >= 1
  int global_width = 384;   ///< channels of the global feature, >= 1
  int queries = 256;        ///< patches of the output, >= 8
  int patch_points = 12;    ///< points per patch, >= 1
};

}  // namespace rhizodont
