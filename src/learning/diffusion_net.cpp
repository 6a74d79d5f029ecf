// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// N. Sharp, S. Attaiki, K. Crane, M. Ovsjanikov, "DiffusionNet: Discretization Agnostic Learning on Surfaces", ACM
// Transactions on Graphics 41(3), 2022. Times start spread over all scales instead of at zero: fewer steps are lost.
#include "learning/diffusion_net.hpp"

#include <cmath>

namespace rhizodont {
namespace {

using layers::Precision;

/// Entries of both gradients, row by row; the vectors are channels.
[[gnu::target_clones("avx512f", "avx2", "default")]] void gather(const float* values, std::int64_t channels,
                                                                 const std::int32_t* row, const float* gx,
                                                                 const float* gy, std::int32_t count, float* along_x,
                                                                 float* along_y) {
  for (std::int32_t e = 0; e < count; ++e) {
    const float* from = values + row[e] * channels;
    const float x = gx[e], y = gy[e];
    for (std::int64_t c = 0; c < channels; ++c) {
      along_x[c] += x * from[c];
      along_y[c] += y * from[c];
    }
  }
}

[[gnu::target_clones("avx512f", "avx2", "default")]] void scatter(float* values, std::int64_t channels,
                                                                  const std::int32_t* row, const float* gx,
                                                                  const float* gy, std::int32_t count,
                                                                  const float* along_x, const float* along_y) {
  for (std::int32_t e = 0; e < count; ++e) {
    float* to = values + row[e] * channels;
    const float x = gx[e], y = gy[e];
    for (std::int64_t c = 0; c < channels; ++c) to[c] += x * along_x[c] + y * along_y[c];
  }
}

struct Gradient : torch::autograd::Function<Gradient> {
  static torch::Tensor forward(torch::autograd::AutogradContext* context, const torch::Tensor& given,
                               const torch::Tensor& first, const torch::Tensor& neighbours, const torch::Tensor& gx,
                               const torch::Tensor& gy) {
    context->save_for_backward({first, neighbours, gx, gy});
    const torch::Tensor values = given.contiguous();
    const std::int64_t n = values.size(0), channels = values.size(1);
    torch::Tensor result = torch::zeros({n, 2 * channels});
    const std::int32_t* at = first.data_ptr<std::int32_t>();
    float* out = result.data_ptr<float>();
    for (std::int64_t v = 0; v < n; ++v)
      gather(values.data_ptr<float>(), channels, neighbours.data_ptr<std::int32_t>() + at[v],
             gx.data_ptr<float>() + at[v], gy.data_ptr<float>() + at[v], at[v + 1] - at[v], out + 2 * v * channels,
             out + (2 * v + 1) * channels);
    return result;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const auto saved = context->get_saved_variables();
    const torch::Tensor gradient = gradients[0].contiguous();
    const std::int64_t n = gradient.size(0), channels = gradient.size(1) / 2;
    torch::Tensor result = torch::zeros({n, channels});
    const std::int32_t* at = saved[0].data_ptr<std::int32_t>();
    const float* in = gradient.data_ptr<float>();
    for (std::int64_t v = 0; v < n; ++v)
      scatter(result.data_ptr<float>(), channels, saved[1].data_ptr<std::int32_t>() + at[v],
              saved[2].data_ptr<float>() + at[v], saved[3].data_ptr<float>() + at[v], at[v + 1] - at[v],
              in + 2 * v * channels, in + (2 * v + 1) * channels);
    return {result, torch::Tensor(), torch::Tensor(), torch::Tensor(), torch::Tensor()};
  }
};

torch::Tensor copied(const std::vector<float>& values, std::initializer_list<std::int64_t> shape) {
  return torch::from_blob(const_cast<float*>(values.data()), shape).clone();
}

torch::Tensor copied(const std::vector<std::int32_t>& values) {
  return torch::from_blob(const_cast<std::int32_t*>(values.data()), {static_cast<std::int64_t>(values.size())},
                          torch::kInt)
      .clone();
}

}  // namespace

SurfaceTensors to_tensors(const SurfaceSample& s, bool labelled) {
  check_surface_sample(s, labelled);
  SurfaceTensors t;
  t.features = copied(s.features, {s.vertices, surface_feature_count});
  t.mass = copied(s.mass, {s.vertices, 1});
  t.eigenvalues = copied(s.eigenvalues, {s.eigenvectors, 1});
  t.basis = copied(s.basis, {s.vertices, s.eigenvectors});
  t.first = copied(s.first);
  t.neighbours = copied(s.neighbours);
  const auto entries = static_cast<std::int64_t>(s.neighbours.size());
  t.gradient_x = copied(s.gradient_x, {entries});
  t.gradient_y = copied(s.gradient_y, {entries});
  if (labelled) t.labels = copied({s.labels.begin(), s.labels.end()}, {s.vertices});
  return t;
}

torch::Tensor diffuse(const SurfaceTensors& surface, const torch::Tensor& values, const torch::Tensor& times) {
  const torch::Tensor coefficients = torch::matmul(surface.basis.t(), surface.mass * values);
  const torch::Tensor decay = torch::exp(-surface.eigenvalues * times.unsqueeze(0));
  return torch::matmul(surface.basis, decay * coefficients);
}

torch::Tensor surface_gradient(const SurfaceTensors& surface, const torch::Tensor& values) {
  return Gradient::apply(values, surface.first, surface.neighbours, surface.gradient_x, surface.gradient_y);
}

DiffusionBlockImpl::DiffusionBlockImpl(std::int64_t width) {
  const double shortest = std::log(2e-3), longest = std::log(0.5);
  time = register_parameter("time", torch::exp(torch::linspace(shortest, longest, width, torch::kFloat)));
  const double deviation = 1 / std::sqrt(static_cast<double>(width));
  rotation_real = register_parameter("rotation_real_weight", torch::randn({width, width}) * deviation);
  rotation_imaginary = register_parameter("rotation_imaginary_weight", torch::randn({width, width}) * deviation);
  for (int i = 0; i < 3; ++i)
    mlp.push_back(register_module("mlp_" + std::to_string(i), layers::Linear(i == 0 ? 3 * width : width, width)));
}

torch::Tensor DiffusionBlockImpl::gradient_features(const SurfaceTensors& surface, const torch::Tensor& spread) {
  const std::int64_t n = spread.size(0), width = spread.size(1);
  const torch::Tensor both = surface_gradient(surface, spread).view({n, 2, width});
  const torch::Tensor x = both.select(1, 0), y = both.select(1, 1);
  const torch::Tensor by_real = torch::matmul(both, rotation_real),
                      by_imaginary = torch::matmul(both, rotation_imaginary);
  const torch::Tensor real = by_real.select(1, 0) - by_imaginary.select(1, 1);
  const torch::Tensor imaginary = by_real.select(1, 1) + by_imaginary.select(1, 0);
  return torch::tanh(x * real + y * imaginary);
}

torch::Tensor DiffusionBlockImpl::forward(const SurfaceTensors& surface, const torch::Tensor& x) {
  const torch::Tensor spread = diffuse(surface, x, time.clamp_min(1e-8));
  torch::Tensor h = torch::cat({x, spread, gradient_features(surface, spread)}, 1);
  for (std::size_t i = 0; i < mlp.size(); ++i) {
    h = mlp[i]->forward(h, Precision::single);
    if (i + 1 < mlp.size()) h = torch::relu(h);
  }
  return x + h;
}

DiffusionNetImpl::DiffusionNetImpl(const SurfaceShape& shape) : shape_(shape) {
  check_surface_shape(shape);
  std::vector<std::int64_t> columns;
  for (int c = 0; c < surface_feature_count; ++c) {
    const bool wanted = c < SurfaceFeature::normal      ? shape.position
                        : c < SurfaceFeature::signature ? shape.surroundings
                                                        : shape.signature;
    if (wanted) columns.push_back(c);
  }
  columns_ = torch::tensor(columns);
  first = register_module("first", layers::Linear(static_cast<std::int64_t>(columns.size()), shape.width));
  for (int i = 0; i < shape.blocks; ++i)
    blocks.push_back(register_module("block_" + std::to_string(i), DiffusionBlock(shape.width)));
  last = register_module("last", layers::Linear(shape.width, 1));
}

torch::Tensor DiffusionNetImpl::forward(const SurfaceTensors& surface) {
  torch::Tensor x = first->forward(surface.features.index_select(1, columns_), Precision::single);
  for (DiffusionBlock& block : blocks) x = block->forward(surface, x);
  return last->forward(x, Precision::single).squeeze(1);
}

}  // namespace rhizodont
