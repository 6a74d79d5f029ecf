// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/weights.hpp"

#include <array>
#include <charconv>
#include <utility>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

const std::string format_name = "rhizodont completion 4";

constexpr std::array<std::pair<const char*, int CompletionShape::*>, 10> sizes{{
    {"input_points", &CompletionShape::input_points},
    {"centres_1", &CompletionShape::centres_1},
    {"centres_2", &CompletionShape::centres_2},
    {"width", &CompletionShape::width},
    {"heads", &CompletionShape::heads},
    {"encoder_depth", &CompletionShape::encoder_depth},
    {"decoder_depth", &CompletionShape::decoder_depth},
    {"global_width", &CompletionShape::global_width},
    {"queries", &CompletionShape::queries},
    {"patch_points", &CompletionShape::patch_points},
}};

}  // namespace

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

void note_shape(const CompletionShape& shape, std::map<std::string, std::string>& metadata) {
  metadata["format"] = format_name;
  for (const auto& [name, member] : sizes) metadata["shape." + std::string(name)] = std::to_string(shape.*member);
}

CompletionShape read_shape(const std::map<std::string, std::string>& metadata) {
  const auto format = metadata.find("format");
  if (format == metadata.end() || format->second != format_name)
    throw InputError("This file does not hold weights of the completion network.");
  CompletionShape shape;
  for (const auto& [name, member] : sizes) {
    const auto found = metadata.find("shape." + std::string(name));
    const std::string text = found == metadata.end() ? "" : found->second;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), shape.*member);
    if (text.empty() || failure != std::errc() || end != text.data() + text.size())
      throw InputError("The weight file does not say how large the network is (" + std::string(name) + ").");
  }
  try {
    check_shape(shape);
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  return shape;
}

void check_shape(const CompletionShape& shape) {
  for (const auto& [name, member] : sizes) {
    if (shape.*member < 1 || shape.*member > 65536)
      throw UsageError("The network's size " + std::string(name) + " is out of range.");
  }
  if (shape.centres_2 < 16 || shape.centres_1 < shape.centres_2 || shape.input_points < shape.centres_1 ||
      shape.width % shape.heads != 0 || shape.queries < 8)
    throw UsageError("The network's sizes do not fit together.");
}

}  // namespace rhizodont
