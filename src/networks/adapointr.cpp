// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Yu X., Rao Y., Wang Z., Lu J., Zhou J.: AdaPoinTr: Diverse Point Cloud Completion with Adaptive Geometry-Aware
// Transformers, IEEE TPAMI 2023. Tancik M. et al.: Fourier Features Let Networks Learn High Frequency Functions in Low
// Dimensional Domains, NeurIPS 2020.
#include "networks/adapointr.hpp"

#include "networks/neighbours.hpp"
#include "networks/weight_reader.hpp"

#include <cmath>
#include <span>
#include <string>

namespace rhizodont::networks {
namespace {

constexpr int group_neighbours = 16;
constexpr int token_neighbours = 8;
constexpr Eigen::Index octaves = 5;
constexpr Eigen::Index position_features = 3 + 6 * octaves;

/// x, y, z and sines and cosines with wavelengths of 75, 38, 19, 9 and 5 mm (unit 12 mm).
Matrix fourier_features(const MatrixView& points) {
  Matrix features(points.rows(), position_features);
  features.leftCols(3) = points;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      for (Eigen::Index octave = 0; octave < octaves; ++octave) {
        const float phase = points(i, axis) * static_cast<float>(1 << octave);
        features(i, 3 + octaves * axis + octave) = std::sin(phase);
        features(i, 3 + 3 * octaves + octaves * axis + octave) = std::cos(phase);
      }
  return features;
}

/// Neighbours of queries among keys (n x 3, rows without gaps): queries x k.
std::vector<std::int32_t> neighbours_of(const Matrix& queries, const Matrix& keys, int k) {
  const auto numbers = [](const float* data, Eigen::Index points) {
    return std::span<const float>(data, static_cast<std::size_t>(3 * points));
  };
  std::vector<std::int32_t> result(static_cast<std::size_t>(queries.rows() * k));
  for_row_blocks(queries.rows(), [&](Eigen::Index first, Eigen::Index count) {
    const auto found = nearest_keys(numbers(queries.data() + 3 * first, count), numbers(keys.data(), keys.rows()), k);
    std::copy(found.begin(), found.end(), result.begin() + first * k);
  });
  return result;
}

Matrix side_by_side(const Matrix& left, const Matrix& right) {
  Matrix both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

/// Tokens of a crown's centres: the grouper, where they are, which tooth it is and how its form leans; then the
/// encoder.
Matrix encode(const AdaPoinTr& network, const Matrix& points, int type, const Eigen::Vector2f& form_axis) {
  const CompletionShape& shape = network.shape;
  const auto near_input = neighbours_of(points, points, group_neighbours);
  const Matrix first = points.topRows(shape.centres_1), second = points.topRows(shape.centres_2);
  const auto near_1 = neighbours_of(first, first, group_neighbours);
  const auto near_2 = neighbours_of(second, second, token_neighbours);
  // The centres come first: so do their neighbours.
  const auto of_first = [&](const std::vector<std::int32_t>& all, int count) {
    return std::span(all).first(static_cast<std::size_t>(count) * group_neighbours);
  };
  const Matrix lifted = linear(network.input_lift, points);
  const Matrix f1 = edge_convolution(network.edge_1, lifted, lifted, near_input);
  const Matrix f2 =
      edge_convolution(network.edge_2, f1, f1.topRows(shape.centres_1), of_first(near_input, shape.centres_1));
  const Matrix f3 = edge_convolution(network.edge_3, f2, f2, near_1);
  const Matrix f4 =
      edge_convolution(network.edge_4, f3, f3.topRows(shape.centres_2), of_first(near_1, shape.centres_2));
  Matrix x = multilayer(network.input_projection, f4) + multilayer(network.position, fourier_features(second));
  const Matrix axis = form_axis.transpose();
  const Matrix shared = network.type_embedding.row(type) + multilayer(network.form_axis, axis);
  x.rowwise() += shared.row(0);
  for (const EncoderBlock& block : network.encoder) {
    const Matrix n = normalised(block.norm_attention, x);
    Matrix mixed = attention(block.attention, n, n);
    for (const EdgeConvolution& graph : block.graph)
      mixed = linear(block.merge, side_by_side(mixed, edge_convolution(graph, n, n, near_2)));
    x += mixed;
    x += multilayer(block.mlp, normalised(block.norm_mlp, x));
  }
  return normalised(network.norm_memory, std::move(x));
}

/// Queries and memory through the decoder's blocks. `starts`: where the queries are.
Matrix decode(const AdaPoinTr& network, Matrix q, const Matrix& memory, const Matrix& starts, const Matrix& centres) {
  const auto near_self = neighbours_of(starts, starts, token_neighbours);
  const auto near_cross = neighbours_of(starts, centres, token_neighbours);
  for (const DecoderBlock& block : network.decoder) {
    const Matrix n = normalised(block.norm_self, q);
    Matrix mixed = attention(block.self_attention, n, n);
    for (const EdgeConvolution& graph : block.self_graph)
      mixed = linear(block.merge_self, side_by_side(mixed, edge_convolution(graph, n, n, near_self)));
    q += mixed;
    const Matrix asking = normalised(block.norm_query, q), known = normalised(block.norm_memory, memory);
    mixed = attention(block.cross_attention, asking, known);
    for (const EdgeConvolution& graph : block.cross_graph)
      mixed = linear(block.merge_cross, side_by_side(mixed, edge_convolution(graph, known, asking, near_cross)));
    q += mixed;
    q += multilayer(block.mlp, normalised(block.norm_mlp, q));
  }
  return normalised(network.norm_queries, std::move(q));
}

/// What queries start from: a type's tooth of patches.
struct Starts {
  Matrix points;    ///< queries x 3: middles of the patches, later bent to the crown
  Matrix offsets;   ///< queries x (3 patch_points): the patch's points from its middle
  Matrix normals;   ///< queries x (3 patch_points)
  Matrix identity;  ///< queries x features of the place on the type's tooth
};

Starts patch_starts(const AdaPoinTr& network, int type) {
  const Eigen::Index queries = network.shape.queries, points = network.shape.patch_points;
  const Eigen::Index begin = type * queries * points * 3;
  Starts starts{Matrix(queries, 3), Eigen::Map<const Matrix>(network.patches.data() + begin, queries, 3 * points),
                Eigen::Map<const Matrix>(network.patch_normals.data() + begin, queries, 3 * points), Matrix()};
  Matrix mean_normals(queries, 3);
  for (Eigen::Index q = 0; q < queries; ++q) {
    Eigen::Map<Matrix> patch(starts.offsets.row(q).data(), points, 3);
    starts.points.row(q) = patch.colwise().mean();
    patch.rowwise() -= starts.points.row(q);
    mean_normals.row(q) = Eigen::Map<const Matrix>(starts.normals.row(q).data(), points, 3).colwise().mean();
  }
  starts.identity = side_by_side(fourier_features(starts.points), mean_normals);
  return starts;
}

/// Moves the points of each query's patch and turns their normals.
Prediction rebuild(const AdaPoinTr& network, const Matrix& q, const Starts& starts, const Matrix& places) {
  const Eigen::Index queries = network.shape.queries, points = network.shape.patch_points;
  const Matrix summary = largest_of_rows(multilayer(network.head_global, q));
  const Matrix features = activated_sum(linear(network.head_query_in, q) + linear(network.head_position_in, places),
                                        linear(network.head_global_in, summary));
  const Matrix hidden =
      activated_sum(linear(network.head_hidden, features), linear(network.head_summary, largest_of_rows(features)));
  const Matrix out = linear(network.head_out, hidden);
  Prediction prediction{Matrix(queries * points, 3), Matrix(queries * points, 3), linear(network.head_spread, hidden)};
  for (Eigen::Index i = 0; i < queries; ++i)
    for (Eigen::Index p = 0; p < points; ++p) {
      const Eigen::Index row = i * points + p;
      prediction.points.block<1, 3>(row, 0) =
          starts.points.block<1, 3>(i, 0) + starts.offsets.block<1, 3>(i, 3 * p) + out.block<1, 3>(i, 6 * p);
      const Eigen::RowVector3f direction = starts.normals.block<1, 3>(i, 3 * p) + out.block<1, 3>(i, 6 * p + 3);
      prediction.normals.block<1, 3>(row, 0) = direction / std::sqrt(direction.squaredNorm() + 1e-8F);
    }
  return prediction;
}

EncoderBlock read_encoder_block(const WeightReader& weights, const CompletionShape& shape, bool with_graph) {
  const Eigen::Index width = shape.width;
  EncoderBlock block;
  block.norm_attention = weights.norm("norm_attention", width);
  block.norm_mlp = weights.norm("norm_mlp", width);
  block.attention = weights.attention("attention", width, shape.heads);
  block.mlp = weights.mlp("mlp", {width, 2 * width, width});
  if (!with_graph) return block;
  block.graph.push_back(weights.edge_convolution("graph", width, width, false));
  block.merge = weights.linear("merge", 2 * width, width);
  return block;
}

DecoderBlock read_decoder_block(const WeightReader& weights, const CompletionShape& shape, bool with_graph) {
  const Eigen::Index width = shape.width;
  DecoderBlock block;
  block.norm_self = weights.norm("norm_self", width);
  block.norm_query = weights.norm("norm_query", width);
  block.norm_memory = weights.norm("norm_memory", width);
  block.norm_mlp = weights.norm("norm_mlp", width);
  block.self_attention = weights.attention("self_attention", width, shape.heads);
  block.cross_attention = weights.attention("cross_attention", width, shape.heads);
  block.mlp = weights.mlp("mlp", {width, 2 * width, width});
  if (!with_graph) return block;
  block.self_graph.push_back(weights.edge_convolution("self_graph", width, width, false));
  block.cross_graph.push_back(weights.edge_convolution("cross_graph", width, width, false));
  block.merge_self = weights.linear("merge_self", 2 * width, width);
  block.merge_cross = weights.linear("merge_cross", 2 * width, width);
  return block;
}

}  // namespace

AdaPoinTr::AdaPoinTr(const TensorFile& file) : shape(read_shape(file.metadata)) {
  const WeightReader weights(file);
  const Eigen::Index width = shape.width, wide = shape.global_width, types = tooth_types + 1;
  const std::vector<std::int64_t> tooth{types, shape.queries, shape.patch_points, 3};
  patches = weights.numbers("patches", tooth);
  patch_normals = weights.numbers("patch_normals", tooth);
  type_embedding = weights.matrix("type_embedding", types, width);
  input_lift = weights.linear("input_lift", 3, 16);
  edge_1 = weights.edge_convolution("edge_1", 16, 32, true);
  edge_2 = weights.edge_convolution("edge_2", 32, 64, true);
  edge_3 = weights.edge_convolution("edge_3", 64, 64, true);
  edge_4 = weights.edge_convolution("edge_4", 64, 128, true);
  input_projection = weights.mlp("input_projection", {128, width, width});
  position = weights.mlp("position", {position_features, 128, width});
  form_axis = weights.mlp("form_axis", {2, 64, width});
  for (int i = 0; i < shape.encoder_depth; ++i)
    encoder.push_back(read_encoder_block(weights.within("encoder." + std::to_string(i)), shape, i == 0));
  norm_memory = weights.norm("norm_memory", width);
  to_global = weights.mlp("to_global", {width, wide, wide});
  coarse_global = weights.linear("coarse_global", wide, wide);
  coarse_anchor = weights.linear("coarse_anchor", position_features, wide, false);
  coarse_out = weights.mlp("coarse_out", {wide, width, 3});
  query_global = weights.linear("query_global", wide, wide);
  query_position = weights.linear("query_position", position_features, wide, false);
  query_identity = weights.linear("query_identity", position_features + 3, wide, false);
  query_out = weights.mlp("query_out", {wide, width});
  for (int i = 0; i < shape.decoder_depth; ++i)
    decoder.push_back(read_decoder_block(weights.within("decoder." + std::to_string(i)), shape, i == 0));
  norm_queries = weights.norm("norm_queries", width);
  head_global = weights.mlp("head_global", {width, wide, wide});
  head_global_in = weights.linear("head_global_in", wide, width);
  head_query_in = weights.linear("head_query_in", width, width, false);
  head_position_in = weights.linear("head_position_in", position_features, width, false);
  head_hidden = weights.linear("head_hidden", width, wide);
  head_summary = weights.linear("head_summary", width, wide, false);
  head_out = weights.linear("head_out", wide, 6 * Eigen::Index{shape.patch_points});
  head_spread = weights.linear("head_spread", wide, shape.patch_points);
}

Prediction predict(const AdaPoinTr& network, const Matrix& points, int type, const Eigen::Vector2f& form_axis) {
  const Matrix memory = encode(network, points, type, form_axis);
  const Matrix global = largest_of_rows(multilayer(network.to_global, memory));
  Starts starts = patch_starts(network, type);
  starts.points +=
      multilayer(network.coarse_out, activated_sum(linear(network.coarse_anchor, fourier_features(starts.points)),
                                                   linear(network.coarse_global, global)));
  const Matrix places = fourier_features(starts.points);
  Matrix q = multilayer(network.query_out, activated_sum(linear(network.query_position, places) +
                                                             linear(network.query_identity, starts.identity),
                                                         linear(network.query_global, global)));
  q = decode(network, std::move(q), memory, starts.points, points.topRows(network.shape.centres_2));
  return rebuild(network, q, starts, places);
}

}  // namespace rhizodont::networks
