// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/weights.hpp"

#include "networks/weight_reader.hpp"

namespace rhizodont {

StoredTensor store_tensor(const torch::Tensor& tensor, TensorType type) {
  const torch::Tensor values = tensor.detach().to(torch::kFloat).contiguous();
  return store_floats({values.data_ptr<float>(), static_cast<std::size_t>(values.numel())}, values.sizes().vec(), type);
}

void load_tensor(const TensorFile& file, const std::string& name, torch::Tensor into) {
  std::vector<float> values = networks::WeightReader(file).numbers(name, into.sizes().vec());
  torch::NoGradGuard no_gradient;
  into.copy_(torch::from_blob(values.data(), into.sizes()));
}

}  // namespace rhizodont
