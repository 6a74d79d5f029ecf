// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/weights.hpp"

#include "rhizodont/error.hpp"

namespace rhizodont {

StoredTensor store_tensor(const torch::Tensor& tensor, TensorType type) {
  const torch::Tensor values = tensor.detach().to(torch::kFloat).contiguous();
  return store_floats({values.data_ptr<float>(), static_cast<std::size_t>(values.numel())}, values.sizes().vec(), type);
}

void load_tensor(const TensorFile& file, const std::string& name, torch::Tensor into) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end() || found->second.type == TensorType::int32)
    throw InputError("The weight file lacks the tensor \"" + name + "\".");
  if (found->second.shape != into.sizes().vec())
    throw InputError("The tensor \"" + name + "\" in the weight file has another shape than the network.");
  std::vector<float> values = load_floats(found->second);
  const torch::Tensor source = torch::from_blob(values.data(), into.sizes());
  if (!torch::isfinite(source).all().item<bool>())
    throw InputError("The tensor \"" + name + "\" in the weight file has values that are not numbers.");
  torch::NoGradGuard no_gradient;
  into.copy_(source);
}

}  // namespace rhizodont
