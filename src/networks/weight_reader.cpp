// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/weight_reader.hpp"

#include "rhizodont/error.hpp"

#include <algorithm>
#include <cmath>

namespace rhizodont::networks {

std::vector<float> WeightReader::numbers(const std::string& name, const std::vector<std::int64_t>& shape) const {
  const std::string full = prefix_ + name;
  const auto found = file_.tensors.find(full);
  if (found == file_.tensors.end() || found->second.type == TensorType::int32)
    throw InputError("The weight file lacks the tensor \"" + full + "\".");
  if (found->second.shape != shape)
    throw InputError("The tensor \"" + full + "\" in the weight file has another shape than the network.");
  std::vector<float> values = load_floats(found->second);
  if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }))
    throw InputError("The tensor \"" + full + "\" in the weight file has values that are not numbers.");
  return values;
}

Eigen::RowVectorXf WeightReader::row(const std::string& name, Eigen::Index size) const {
  const std::vector<float> values = numbers(name, {size});
  return Eigen::Map<const Eigen::RowVectorXf>(values.data(), size);
}

Matrix WeightReader::matrix(const std::string& name, Eigen::Index rows, Eigen::Index columns) const {
  const std::vector<float> values = numbers(name, {rows, columns});
  return Eigen::Map<const Matrix>(values.data(), rows, columns);
}

Linear WeightReader::linear(const std::string& name, Eigen::Index in, Eigen::Index out, bool with_bias) const {
  const Matrix weight = matrix(name + ".weight", out, in);
  if (!with_bias) return Linear::of_transposed(weight);
  return Linear::of_transposed(weight, numbers(name + ".bias", {out}));
}

Norm WeightReader::norm(const std::string& name, Eigen::Index width) const {
  return {row(name + ".weight", width), row(name + ".bias", width)};
}

Mlp WeightReader::mlp(const std::string& name, const std::vector<Eigen::Index>& widths) const {
  Mlp layers;
  for (std::size_t i = 0; i + 1 < widths.size(); ++i)
    layers.push_back(linear(name + ".layer_" + std::to_string(i), widths[i], widths[i + 1]));
  return layers;
}

EdgeConvolution WeightReader::edge_convolution(const std::string& name, Eigen::Index in, Eigen::Index out,
                                               bool with_norm) const {
  return {linear(name + ".neighbour", in, out, false), linear(name + ".centre", in, out),
          with_norm ? norm(name + ".norm", out) : Norm{}};
}

Attention WeightReader::attention(const std::string& name, Eigen::Index width, Eigen::Index heads) const {
  return {heads, linear(name + ".to_query", width, width), linear(name + ".to_memory", width, 2 * width, false),
          linear(name + ".to_output", width, width)};
}

}  // namespace rhizodont::networks
