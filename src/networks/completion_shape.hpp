// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

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

/// Notes the sizes of a network in a file's metadata ("shape.width" and so on, "format").
void note_shape(const CompletionShape& shape, std::map<std::string, std::string>& metadata);

/// The sizes noted. Throws InputError if they are missing or out of range.
CompletionShape read_shape(const std::map<std::string, std::string>& metadata);

/// Throws UsageError if a size is out of range.
void check_shape(const CompletionShape& shape);

}  // namespace rhizodont
