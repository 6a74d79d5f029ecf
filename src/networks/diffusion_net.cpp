// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// N. Sharp, S. Attaiki, K. Crane, M. Ovsjanikov, "DiffusionNet: Discretization Agnostic Learning on Surfaces", ACM
// Transactions on Graphics 41(3), 2022.
#include "networks/diffusion_net.hpp"

#include "networks/elementwise.hpp"
#include "networks/weight_reader.hpp"

#include <cmath>
#include <string>

namespace rhizodont::networks {
namespace {

constexpr Eigen::Index summed_rows = 512;  // of vertices, in one sum of the block

Eigen::Map<const Matrix> basis_of(const SurfaceSample& surface) {
  return {surface.basis.data(), surface.vertices, surface.eigenvectors};
}

/// <phi_k, x_c> under the mass: eigenvectors x C.
Matrix coefficients(const SurfaceSample& surface, const Matrix& values) {
  const Eigen::Index vertices = surface.vertices, blocks = (vertices + summed_rows - 1) / summed_rows;
  std::vector<Matrix> parts(static_cast<std::size_t>(blocks));
  const auto basis = basis_of(surface);
  const Eigen::Map<const Eigen::VectorXf> mass(surface.mass.data(), vertices);
  tbb::parallel_for(Eigen::Index{0}, blocks, [&](Eigen::Index b) {
    const Eigen::Index first = b * summed_rows, count = std::min(summed_rows, vertices - first);
    const Matrix weighted = mass.segment(first, count).asDiagonal() * values.middleRows(first, count);
    const Matrix transposed = basis.middleRows(first, count).transpose();
    Matrix& part = parts[static_cast<std::size_t>(b)];
    part.resize(surface.eigenvectors, values.cols());
    product(transposed, PackedMatrix(weighted), part);
  });
  for (std::size_t b = 1; b < parts.size(); ++b) parts[0] += parts[b];
  return std::move(parts[0]);
}

/// Adds one vertex's entries of both gradients.
[[gnu::target_clones("avx2", "default")]] void gather(const float* values, Eigen::Index channels,
                                                      const std::int32_t* row, const float* gx, const float* gy,
                                                      std::int32_t count, float* along_x, float* along_y) {
  for (std::int32_t e = 0; e < count; ++e) {
    const float* from = values + row[e] * channels;
    const float x = gx[e], y = gy[e];
    for (Eigen::Index c = 0; c < channels; ++c) {
      along_x[c] += x * from[c];
      along_y[c] += y * from[c];
    }
  }
}

/// tanh of the inner product of each channel's gradient with a learned combination of all channels' gradients, each
/// turned and scaled in the tangent plane: the same for any choice of the plane's axes. gradients: 2 n x C.
void gradient_features(const DiffusionBlock& block, const MatrixView& gradients, MatrixSpan result) {
  const Eigen::Index width = gradients.cols();
  Matrix turned(gradients.rows(), 2 * width);
  product(gradients, block.rotation, turned);
  for (Eigen::Index v = 0; v < result.rows(); ++v) {
    const auto x = gradients.row(2 * v).array(), y = gradients.row(2 * v + 1).array();
    const auto x_turned = turned.row(2 * v).array(), y_turned = turned.row(2 * v + 1).array();
    result.row(v) =
        x * (x_turned.head(width) - y_turned.tail(width)) + y * (y_turned.head(width) + x_turned.tail(width));
  }
  hyperbolic_tangent(result);
}

/// What the block adds to `x`.
Matrix forward(const DiffusionBlock& block, const SurfaceSample& surface, const Matrix& x) {
  const Eigen::Index width = x.cols();
  const Matrix spread = diffuse(surface, x, block.time), gradients = surface_gradient(surface, spread);
  Matrix result(x.rows(), width);
  for_row_blocks(x.rows(), [&](Eigen::Index first, Eigen::Index count) {
    Matrix h(count, 3 * width);
    h.leftCols(width) = x.middleRows(first, count);
    h.middleCols(width, width) = spread.middleRows(first, count);
    gradient_features(block, gradients.middleRows(2 * first, 2 * count), h.rightCols(width));
    for (std::size_t i = 0; i < block.mlp.size(); ++i) {
      Matrix next(count, block.mlp[i].columns());
      product(h, block.mlp[i], next);
      if (i + 1 < block.mlp.size()) rectify(next);
      h = std::move(next);
    }
    result.middleRows(first, count) = h;
  });
  return result;
}

DiffusionBlock read_block(const WeightReader& weights, Eigen::Index width) {
  constexpr float shortest_time = 1e-8F;
  DiffusionBlock block;
  block.time = weights.row("time", width).cwiseMax(shortest_time);
  Matrix rotation(width, 2 * width);
  rotation << weights.matrix("rotation_real_weight", width, width),
      weights.matrix("rotation_imaginary_weight", width, width);
  block.rotation = PackedMatrix(rotation);
  for (int i = 0; i < 3; ++i)
    block.mlp.push_back(weights.linear("mlp_" + std::to_string(i), i == 0 ? 3 * width : width, width));
  return block;
}

}  // namespace

Matrix diffuse(const SurfaceSample& surface, const Matrix& values, const Eigen::RowVectorXf& times) {
  Matrix spectrum = coefficients(surface, values);
  for (Eigen::Index k = 0; k < spectrum.rows(); ++k)
    spectrum.row(k).array() *= (-surface.eigenvalues[static_cast<std::size_t>(k)] * times.array()).exp();
  return linear(PackedMatrix(spectrum), basis_of(surface));
}

Matrix surface_gradient(const SurfaceSample& surface, const Matrix& values) {
  const Eigen::Index channels = values.cols();
  Matrix result = Matrix::Zero(2 * surface.vertices, channels);
  for_row_blocks(surface.vertices, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index v = first; v < first + count; ++v) {
      const std::int32_t begin = surface.first[static_cast<std::size_t>(v)];
      gather(values.data(), channels, surface.neighbours.data() + begin, surface.gradient_x.data() + begin,
             surface.gradient_y.data() + begin, surface.first[static_cast<std::size_t>(v) + 1] - begin,
             result.data() + 2 * v * channels, result.data() + (2 * v + 1) * channels);
    }
  });
  return result;
}

DiffusionNet::DiffusionNet(const TensorFile& file) : shape(read_surface_shape(file.metadata)) {
  for (int c = 0; c < surface_feature_count; ++c) {
    const bool wanted = c < SurfaceFeature::normal      ? shape.position
                        : c < SurfaceFeature::signature ? shape.surroundings
                                                        : shape.signature;
    if (wanted) columns.push_back(c);
  }
  const WeightReader weights(file);
  first = weights.linear("first", static_cast<Eigen::Index>(columns.size()), shape.width);
  for (int i = 0; i < shape.blocks; ++i)
    blocks.push_back(read_block(weights.within("block_" + std::to_string(i)), shape.width));
  last = weights.linear("last", shape.width, 1);
}

Eigen::VectorXf predict(const DiffusionNet& network, const SurfaceSample& surface) {
  const Eigen::Map<const Matrix> features(surface.features.data(), surface.vertices, surface_feature_count);
  const Matrix chosen = features(Eigen::all, network.columns);
  Matrix x = linear(network.first, chosen);
  for (const DiffusionBlock& block : network.blocks) x += forward(block, surface, x);
  return linear(network.last, x);
}

}  // namespace rhizodont::networks
