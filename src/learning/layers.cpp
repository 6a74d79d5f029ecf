// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Building blocks of the completion network: transformer layers (Vaswani et al., Attention Is All You Need, 2017;
// pre-norm as in Dosovitskiy et al., 2021) and edge convolutions (Wang et al., Dynamic Graph CNN, 2019).
#include "learning/layers.hpp"

#include <ATen/Parallel.h>

#include <cmath>

namespace rhizodont::layers {
namespace {

constexpr double leak = 0.2;

torch::Tensor in_precision(const torch::Tensor& x, Precision precision) {
  return x.to(precision == Precision::half ? torch::kBFloat16 : torch::kFloat);
}

/// Weights that halve the size of a signal: residual branches then start small, and chains of layers do not fade out.
torch::Tensor initial_weight(std::int64_t in, std::int64_t out) {
  const double deviation = 0.5 / std::sqrt(static_cast<double>(in));
  return (torch::randn({out, in}) * deviation).clamp(-2 * deviation, 2 * deviation);
}

/// For one query: the largest value per channel and which neighbour has it.
[[gnu::target_clones("avx512f", "avx2", "default")]] void max_over_rows(const float* values, std::int64_t channels,
                                                                        const std::int32_t* rows, std::int64_t count,
                                                                        float* largest, std::int32_t* from) {
  const float* first = values + rows[0] * channels;
  for (std::int64_t c = 0; c < channels; ++c) {
    largest[c] = first[c];
    from[c] = rows[0];
  }
  for (std::int64_t k = 1; k < count; ++k) {
    const float* row = values + rows[k] * channels;
    const std::int32_t index = rows[k];
    for (std::int64_t c = 0; c < channels; ++c) {
      const bool larger = row[c] > largest[c];
      largest[c] = larger ? row[c] : largest[c];
      from[c] = larger ? index : from[c];
    }
  }
}

struct GatherMax : torch::autograd::Function<GatherMax> {
  static torch::Tensor forward(torch::autograd::AutogradContext* context, const torch::Tensor& given,
                               const torch::Tensor& neighbours) {
    const torch::Tensor values = given.to(torch::kFloat).contiguous();
    const torch::Tensor rows = neighbours.contiguous();
    const std::int64_t batch = values.size(0), points = values.size(1), channels = values.size(2);
    const std::int64_t queries = rows.size(1), count = rows.size(2);
    torch::Tensor largest = torch::empty({batch, queries, channels});
    torch::Tensor from = torch::empty({batch, queries, channels}, torch::kInt);
    const float* value = values.data_ptr<float>();
    const std::int32_t* row = rows.data_ptr<std::int32_t>();
    float* out = largest.data_ptr<float>();
    std::int32_t* where = from.data_ptr<std::int32_t>();
    at::parallel_for(0, batch * queries, 64, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t q = begin; q < end; ++q)
        max_over_rows(value + q / queries * points * channels, channels, row + q * count, count, out + q * channels,
                      where + q * channels);
    });
    context->save_for_backward({from});
    context->saved_data["points"] = points;
    context->saved_data["type"] = given.scalar_type();
    return largest;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 const torch::autograd::variable_list& gradients) {
    const torch::Tensor from = context->get_saved_variables()[0];
    const torch::Tensor gradient = gradients[0].to(torch::kFloat).contiguous();
    const std::int64_t points = context->saved_data["points"].toInt();
    const std::int64_t batch = from.size(0), queries = from.size(1), channels = from.size(2);
    torch::Tensor result = torch::zeros({batch, points, channels});
    const float* in = gradient.data_ptr<float>();
    const std::int32_t* where = from.data_ptr<std::int32_t>();
    float* out = result.data_ptr<float>();
    at::parallel_for(0, batch, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t row = begin * queries; row < end * queries; ++row) {
        float* base = out + row / queries * points * channels;
        for (std::int64_t c = 0; c < channels; ++c)
          base[where[row * channels + c] * channels + c] += in[row * channels + c];
      }
    });
    return {result.to(context->saved_data["type"].toScalarType()), torch::Tensor()};
  }
};

}  // namespace

bool half_is_fast() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0;
}

LinearImpl::LinearImpl(std::int64_t in, std::int64_t out, bool with_bias)
    : weight(register_parameter("weight", initial_weight(in, out))) {
  if (with_bias) bias = register_parameter("bias", torch::zeros({out}));
}

torch::Tensor LinearImpl::forward(const torch::Tensor& x, Precision precision) {
  return torch::linear(in_precision(x, precision), in_precision(weight, precision),
                       bias.defined() ? in_precision(bias, precision) : bias);
}

NormImpl::NormImpl(std::int64_t width)
    : weight(register_parameter("weight", torch::ones({width}))),
      bias(register_parameter("bias", torch::zeros({width}))) {}

torch::Tensor NormImpl::forward(const torch::Tensor& x) {
  return torch::layer_norm(x.to(torch::kFloat), {weight.size(0)}, weight, bias, 1e-5);
}

MlpImpl::MlpImpl(const std::vector<std::int64_t>& widths) {
  for (std::size_t i = 0; i + 1 < widths.size(); ++i)
    layers.push_back(register_module("layer_" + std::to_string(i), Linear(widths[i], widths[i + 1])));
}

torch::Tensor MlpImpl::forward(torch::Tensor x, Precision precision) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (i > 0) x = torch::gelu(x);
    x = layers[i]->forward(x, precision);
  }
  return x;
}

torch::Tensor gather_max(const torch::Tensor& values, const torch::Tensor& neighbours) {
  return GatherMax::apply(values, neighbours);
}

torch::Tensor gather_rows(const torch::Tensor& points, const torch::Tensor& indices) {
  const std::int64_t batch = points.size(0), count = points.size(1), channels = points.size(2);
  const torch::Tensor flat = (indices + torch::arange(batch, torch::kLong).unsqueeze(1) * count).flatten();
  return points.reshape({batch * count, channels}).index_select(0, flat).view({batch, indices.size(1), channels});
}

EdgeConvImpl::EdgeConvImpl(std::int64_t in, std::int64_t out, bool with_norm)
    : neighbour(register_module("neighbour", Linear(in, out, false))),
      centre(register_module("centre", Linear(in, out))) {
  // Few narrow features, no residual: the usual fan-in scale.
  torch::NoGradGuard no_gradient;
  neighbour->weight.normal_(0, 1 / std::sqrt(static_cast<double>(in)));
  centre->weight.normal_(0, 1 / std::sqrt(static_cast<double>(in)));
  if (with_norm) norm = register_module("norm", Norm(out));
}

torch::Tensor EdgeConvImpl::forward(const torch::Tensor& keys, const torch::Tensor& queries,
                                    const torch::Tensor& neighbours, Precision precision) {
  torch::Tensor x = gather_max(neighbour->forward(keys, precision), neighbours) + centre->forward(queries, precision);
  if (norm) x = norm->forward(x);
  return torch::leaky_relu(x, leak);
}

AttentionImpl::AttentionImpl(std::int64_t width, std::int64_t heads)
    : heads_(heads),
      to_query(register_module("to_query", Linear(width, width))),
      // A bias of the keys shifts all scores of a query alike, which softmax ignores; one of the values is the
      // output's.
      to_memory(register_module("to_memory", Linear(width, 2 * width, false))),
      to_output(register_module("to_output", Linear(width, width))) {}

torch::Tensor AttentionImpl::forward(const torch::Tensor& queries, const torch::Tensor& memory, Precision precision,
                                     std::int64_t isolated) {
  const std::int64_t batch = queries.size(0), count = queries.size(1), width = queries.size(2);
  const std::int64_t keys = memory.size(1), channels = width / heads_;
  const double scale = 1 / std::sqrt(static_cast<double>(channels));
  // (B H) x points x channels; the scale goes to the queries, which are fewer numbers than the scores
  const torch::Tensor q = (to_query->forward(queries, precision) * scale)
                              .view({batch, count, heads_, channels})
                              .transpose(1, 2)
                              .reshape({batch * heads_, count, channels});
  const torch::Tensor kv = to_memory->forward(memory, precision)
                               .view({batch, keys, 2, heads_, channels})
                               .permute({2, 0, 3, 1, 4})
                               .reshape({2, batch * heads_, keys, channels});
  const torch::Tensor k = kv[0].transpose(1, 2), v = kv[1];
  torch::Tensor mixed;
  if (isolated < 0 || isolated >= count) {
    mixed = torch::bmm(torch::softmax(torch::bmm(q, k), -1), v);
  } else {
    const torch::Tensor near = torch::softmax(torch::bmm(q.narrow(1, 0, isolated), k.narrow(2, 0, isolated)), -1);
    const torch::Tensor far = torch::softmax(torch::bmm(q.narrow(1, isolated, count - isolated), k), -1);
    mixed = torch::cat({torch::bmm(near, v.narrow(1, 0, isolated)), torch::bmm(far, v)}, 1);
  }
  return to_output->forward(mixed.view({batch, heads_, count, channels}).transpose(1, 2).reshape({batch, count, width}),
                            precision);
}

}  // namespace rhizodont::layers
