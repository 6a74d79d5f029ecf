// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "networks/layers.hpp"
#include "networks/safetensors.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace rhizodont::networks {

/// Takes the layers of a network out of a file, by the names that the trainer gives them. All functions throw
/// InputError, naming the tensor, if it is missing, of another shape or has values that are not finite.
class WeightReader {
 public:
  /// `file` must outlive the reader. `prefix` stands before all names.
  explicit WeightReader(const TensorFile& file, std::string prefix = {}) : file_(file), prefix_(std::move(prefix)) {}
  /// For the layers inside of one: names begin with "<name>." then.
  WeightReader within(const std::string& name) const { return WeightReader(file_, prefix_ + name + "."); }

  std::vector<float> numbers(const std::string& name, const std::vector<std::int64_t>& shape) const;
  Eigen::RowVectorXf row(const std::string& name, Eigen::Index size) const;
  Matrix matrix(const std::string& name, Eigen::Index rows, Eigen::Index columns) const;

  Linear linear(const std::string& name, Eigen::Index in, Eigen::Index out, bool with_bias = true) const;
  Norm norm(const std::string& name, Eigen::Index width) const;
  Mlp mlp(const std::string& name, const std::vector<Eigen::Index>& widths) const;
  EdgeConvolution edge_convolution(const std::string& name, Eigen::Index in, Eigen::Index out, bool with_norm) const;
  Attention attention(const std::string& name, Eigen::Index width, Eigen::Index heads) const;

 private:
  const TensorFile& file_;
  std::string prefix_;
};

}  // namespace rhizodont::networks
