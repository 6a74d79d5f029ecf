// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Private to this room: brings in torch.

#include <span>
#include <vector>

#include "learning/layers.hpp"
#include "networks/completion_shape.hpp"

namespace rhizodont {

/// Crowns as the network takes them: points in farthest-point order, so that the first n points are also the n that
/// farthest-point sampling would keep, and the neighbours of each of the grouper's layers.
struct CrownBatch {
  torch::Tensor points;           ///< float, B x input_points x 3
  torch::Tensor types;            ///< int64, B; 0..15 or unknown_type
  torch::Tensor form_axes;        ///< float, B x 2: CompletionTrainingSample::form_axis
  torch::Tensor near_input;       ///< int32, B x input_points x 16: among the input
  torch::Tensor near_1_of_input;  ///< int32, B x centres_1 x 16: of the first centres, among the input
  torch::Tensor near_1;           ///< int32, B x centres_1 x 16: among the first centres
  torch::Tensor near_2_of_1;      ///< int32, B x centres_2 x 16: of the second centres, among the first
  torch::Tensor near_2;           ///< int32, B x centres_2 x 8: among the second centres
};

/// Puts each crown (x, y, z of point 0, ...; at least `input_points` points) in farthest-point order, thins it and
/// finds neighbours. The result does not depend on the order of a crown's points. `form_axes`: x and y for each crown.
CrownBatch make_crown_batch(const CompletionShape& shape, const std::vector<std::vector<float>>& crowns,
                            const std::vector<std::int64_t>& types, const std::vector<float>& form_axes);

/// What the network says, canonical units.
struct Prediction {
  torch::Tensor coarse;    ///< B x queries x 3
  torch::Tensor fine;      ///< B x (queries patch_points) x 3; point i belongs to query i / patch_points
  torch::Tensor normals;   ///< as fine, unit length
  torch::Tensor spread;    ///< B x (queries patch_points): logarithm of a point's expected distance from its place
  torch::Tensor denoised;  ///< B x seeds x patch_points x 3; undefined without seeds
};

/// Encoder block: self-attention and MLP, the first one with an edge convolution beside the attention.
struct EncoderBlockImpl : torch::nn::Module {
  EncoderBlockImpl(const CompletionShape& shape, bool with_graph);
  torch::Tensor forward(torch::Tensor x, const torch::Tensor& neighbours, layers::Precision precision);

  layers::Norm norm_attention{nullptr}, norm_mlp{nullptr};
  layers::Attention attention{nullptr};
  layers::EdgeConv graph{nullptr};
  layers::Linear merge{nullptr};
  layers::Mlp mlp{nullptr};
};
TORCH_MODULE(EncoderBlock);

/// Neighbours of queries for the decoder's first block.
struct QueryNeighbours {
  torch::Tensor self;   ///< int32, B x (queries + seeds) x 8
  torch::Tensor cross;  ///< int32, B x (queries + seeds) x 8, among the encoder's centres
};

/// Decoder block: self-attention, cross-attention, MLP; the first one with edge convolutions beside both attentions.
struct DecoderBlockImpl : torch::nn::Module {
  DecoderBlockImpl(const CompletionShape& shape, bool with_graph);
  torch::Tensor forward(torch::Tensor q, const torch::Tensor& memory, const QueryNeighbours& neighbours,
                        std::int64_t isolated, layers::Precision precision);

  layers::Norm norm_self{nullptr}, norm_query{nullptr}, norm_memory{nullptr}, norm_mlp{nullptr};
  layers::Attention self_attention{nullptr}, cross_attention{nullptr};
  layers::EdgeConv self_graph{nullptr}, cross_graph{nullptr};
  layers::Linear merge_self{nullptr}, merge_cross{nullptr};
  layers::Mlp mlp{nullptr};
};
TORCH_MODULE(DecoderBlock);

/// What queries start from, B x (queries + seeds) each.
struct Starts {
  torch::Tensor points;    ///< x 3: where they are now
  torch::Tensor offsets;   ///< x (3 patch_points): the patch's points from its middle
  torch::Tensor normals;   ///< x (3 patch_points): the patch's normals
  torch::Tensor identity;  ///< x features of the place on the type's tooth; zero for a seed without a patch
};

/// AdaPoinTr (Yu et al., AdaPoinTr: Diverse Point Cloud Completion with Adaptive Geometry-Aware Transformers, 2023) for
/// teeth, with these differences:
/// - Each tooth type, and "unknown", has a learned tooth of patches of points with normals. Queries start at the
/// middles
///   of the patches, which a small network bends to the crown at hand; the rebuild head moves a patch's points and
///   turns its normals from there. They replace the candidates and their ranking, which gets no gradient in the
///   published code.
/// - The tooth type is an embedding added to every token, and so is how far the crown's form leans against its border.
/// - Coordinates enter with sines and cosines of several wavelengths (Tancik et al., Fourier Features, 2020).
/// - Edge convolutions normalise after the maximum, per point; the rebuild head has no batch normalisation.
/// - Denoising queries start at disturbed points of the target, root included, instead of the input's; nothing of the
///   main prediction sees them, the rebuild head's maximum included.
/// - Each output point has a normal and an expected distance from its true place, learned beside the points.
struct AdaPoinTrImpl : torch::nn::Module {
  explicit AdaPoinTrImpl(const CompletionShape& shape);

  /// Sets the tooth of type 0..15 or unknown_type: queries x patch_points x 3 numbers each.
  void set_patches(int type, std::span<const float> points, std::span<const float> normals);

  /// seeds: B x n x 3 disturbed target points, or undefined; seed_patches: int64, B x n, the patch that a seed stands
  /// for, or -1.
  Prediction forward(const CrownBatch& crowns, const torch::Tensor& seeds, const torch::Tensor& seed_patches,
                     layers::Precision precision);

  CompletionShape shape;
  torch::Tensor patches, patch_normals, type_embedding;
  layers::Linear input_lift{nullptr};
  layers::EdgeConv edge_1{nullptr}, edge_2{nullptr}, edge_3{nullptr}, edge_4{nullptr};
  layers::Mlp input_projection{nullptr}, position{nullptr}, form_axis{nullptr}, to_global{nullptr};
  torch::nn::ModuleList encoder{nullptr}, decoder{nullptr};
  layers::Linear coarse_global{nullptr}, coarse_anchor{nullptr}, query_global{nullptr}, query_position{nullptr};
  layers::Linear query_identity{nullptr};
  layers::Mlp coarse_out{nullptr}, query_out{nullptr};
  layers::Norm norm_memory{nullptr}, norm_queries{nullptr};
  layers::Mlp head_global{nullptr};
  layers::Linear head_global_in{nullptr}, head_query_in{nullptr}, head_position_in{nullptr};
  layers::Linear head_hidden{nullptr}, head_summary{nullptr}, head_out{nullptr}, head_spread{nullptr};

 private:
  Starts patch_starts(const torch::Tensor& types) const;
  torch::Tensor encode(const CrownBatch& crowns, layers::Precision precision);
  void rebuild(const torch::Tensor& q, const Starts& starts, std::int64_t main, Prediction& prediction,
               layers::Precision precision);
};
TORCH_MODULE(AdaPoinTr);

}  // namespace rhizodont
