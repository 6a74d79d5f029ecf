// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/completion_shape.hpp"
#include "networks/layers.hpp"
#include "networks/safetensors.hpp"

#include <cstdint>
#include <vector>

namespace rhizodont::networks {

/// What the network says of a crown, canonical units. Point i belongs to query i / patch_points.
struct Prediction {
  Matrix points;   ///< (queries patch_points) x 3
  Matrix normals;  ///< as points, nearly unit length
  Matrix spread;   ///< queries x patch_points: logarithm of a point's expected distance from its place
};

/// Encoder block: self-attention and MLP, the first one with an edge convolution beside the attention.
struct EncoderBlock {
  Norm norm_attention, norm_mlp;
  Attention attention;
  std::vector<EdgeConvolution> graph;  ///< one or none
  Linear merge;                        ///< where there is one
  Mlp mlp;
};

/// Decoder block: self-attention, cross-attention, MLP; the first one with edge convolutions beside both attentions.
struct DecoderBlock {
  Norm norm_self, norm_query, norm_memory, norm_mlp;
  Attention self_attention, cross_attention;
  std::vector<EdgeConvolution> self_graph, cross_graph;  ///< one or none of each
  Linear merge_self, merge_cross;
  Mlp mlp;
};

/// The finished completion network: AdaPoinTr as learning/adapointr.hpp describes it, without what only training needs
/// (seeds, denoising). Matrices in float, whatever the file has.
struct AdaPoinTr {
  /// Throws InputError if the file is of another network, or a tensor is missing, of another shape or not finite.
  explicit AdaPoinTr(const TensorFile& file);

  CompletionShape shape;
  std::vector<float> patches, patch_normals;  ///< types x queries x patch_points x 3
  Matrix type_embedding;
  Linear input_lift;
  EdgeConvolution edge_1, edge_2, edge_3, edge_4;
  Mlp input_projection, position, form_axis, to_global;
  std::vector<EncoderBlock> encoder;
  std::vector<DecoderBlock> decoder;
  Linear coarse_global, coarse_anchor, query_global, query_position, query_identity;
  Mlp coarse_out, query_out;
  Norm norm_memory, norm_queries;
  Mlp head_global;
  Linear head_global_in, head_query_in, head_position_in, head_hidden, head_summary, head_out, head_spread;
};

/// One crown through the network. points: input_points x 3 in farthest-point order (the first n are also those that
/// farthest-point sampling would keep); type: 0..15 or unknown_type; form_axis: x and y of the axis of the crown's
/// form. The same bits for any number of threads, and whatever else goes through beside it.
Prediction predict(const AdaPoinTr& network, const Matrix& points, int type, const Eigen::Vector2f& form_axis);

}  // namespace rhizodont::networks
