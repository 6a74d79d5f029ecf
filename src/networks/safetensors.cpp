// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// The safetensors format, as described at huggingface.co/docs/safetensors: a little-endian 64-bit header length, a JSON
// object that maps names to element type, shape and byte range, then the data without gaps.
#include "networks/safetensors.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>

#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

namespace rhizodont {
namespace {

static_assert(std::endian::native == std::endian::little, "tensors are stored as they lie in memory");

constexpr std::uint64_t longest_header = 100'000'000;  // the limit that the format itself sets

std::size_t element_size(TensorType type) {
  return type == TensorType::float16 || type == TensorType::bfloat16 ? 2 : 4;
}

const char* type_name(TensorType type) {
  switch (type) {
    case TensorType::float32:
      return "F32";
    case TensorType::float16:
      return "F16";
    case TensorType::bfloat16:
      return "BF16";
    case TensorType::int32:
      return "I32";
  }
  return "";
}

[[noreturn]] void damaged(const std::filesystem::path& path, const std::string& why) {
  throw InputError("The weight file " + path.string() + " is damaged: " + why + ".");
}

/// Number of elements, or nothing if a dimension is negative or the product is beyond any memory.
bool count_elements(const std::vector<std::int64_t>& shape, std::uint64_t& count) {
  count = 1;
  for (const std::int64_t size : shape) {
    if (size < 0) return false;
    if (size != 0 && count > (std::uint64_t{1} << 40) / static_cast<std::uint64_t>(size)) return false;
    count *= static_cast<std::uint64_t>(size);
  }
  return true;
}

void require_count(const std::vector<std::int64_t>& shape, std::size_t values) {
  std::uint64_t count = 0;
  if (!count_elements(shape, count) || count != values)
    throw UsageError("A tensor's shape does not match its number of values.");
}

std::uint16_t to_bfloat16(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if ((bits & 0x7fffffffU) > 0x7f800000U) return static_cast<std::uint16_t>((bits >> 16) | 0x40U);  // stay a NaN
  return static_cast<std::uint16_t>((bits + 0x7fffU + ((bits >> 16) & 1U)) >> 16);
}

std::uint16_t to_float16(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude > 0x7f800000U) return static_cast<std::uint16_t>(sign | 0x7e00U);
  if (magnitude >= 0x47800000U) return static_cast<std::uint16_t>(sign | 0x7c00U);
  if (magnitude < 0x38800000U) {
    // Below the smallest normal half number: adding 0.5 shifts the mantissa to where a subnormal half has it, and the
    // addition rounds to nearest even.
    const float shifted = std::bit_cast<float>(magnitude) + 0.5F;
    return static_cast<std::uint16_t>(sign | (std::bit_cast<std::uint32_t>(shifted) - 0x3f000000U));
  }
  const std::uint32_t rounded = magnitude - 0x38000000U + 0xfffU + ((magnitude >> 13) & 1U);
  return static_cast<std::uint16_t>(sign | (rounded >> 13));
}

float from_float16(std::uint16_t half) {
  const std::uint32_t rest = half & 0x7fffU;
  // The exponent's bias differs by 112, also for numbers below the smallest normal one; infinity and what is not a
  // number have all bits of the exponent set. Without branches: weights are read by the million.
  const auto magnitude = std::bit_cast<std::uint32_t>(std::bit_cast<float>(rest << 13) * 0x1p112F);
  const std::uint32_t beyond = rest >= 0x7c00U ? 0x7f800000U : 0U;
  return std::bit_cast<float>(((half & 0x8000U) << 16) | magnitude | beyond);
}

StoredTensor read_entry(const std::filesystem::path& path, const std::string& name, const nlohmann::json& entry,
                        const std::vector<char>& data, std::pair<std::uint64_t, std::uint64_t>& range) {
  StoredTensor tensor;
  std::string type;
  std::vector<std::uint64_t> offsets;
  try {
    type = entry.at("dtype").get<std::string>();
    if (!entry.at("shape").is_array() || !entry.at("data_offsets").is_array())
      damaged(path, "shape and byte range of \"" + name + "\" are not lists");
    for (const auto& size : entry.at("shape")) {
      if (!size.is_number_unsigned()) damaged(path, "the shape of \"" + name + "\" is not made of counts");
      tensor.shape.push_back(size.get<std::int64_t>());
    }
    for (const auto& offset : entry.at("data_offsets")) {
      if (!offset.is_number_unsigned()) damaged(path, "the byte range of \"" + name + "\" is not made of counts");
      offsets.push_back(offset.get<std::uint64_t>());
    }
  } catch (const nlohmann::json::exception&) {
    damaged(path, "the entry of \"" + name + "\" lacks its type, shape or byte range");
  }
  if (type == "F32") {
    tensor.type = TensorType::float32;
  } else if (type == "F16") {
    tensor.type = TensorType::float16;
  } else if (type == "BF16") {
    tensor.type = TensorType::bfloat16;
  } else if (type == "I32") {
    tensor.type = TensorType::int32;
  } else {
    damaged(path, "\"" + name + "\" has the element type \"" + type + "\", which is not supported");
  }
  std::uint64_t count = 0;
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > data.size())
    damaged(path, "the byte range of \"" + name + "\" is not in the file");
  if (!count_elements(tensor.shape, count) || count * element_size(tensor.type) != offsets[1] - offsets[0])
    damaged(path, "the shape of \"" + name + "\" contradicts its byte range");
  range = {offsets[0], offsets[1]};
  tensor.bytes.resize(offsets[1] - offsets[0]);
  if (!tensor.bytes.empty()) std::memcpy(tensor.bytes.data(), data.data() + offsets[0], tensor.bytes.size());
  return tensor;
}

std::uint64_t read_header_length(const std::filesystem::path& path, std::ifstream& stream, std::uint64_t file_size) {
  std::uint64_t length = 0;
  if (file_size < sizeof length || !stream.read(reinterpret_cast<char*>(&length), sizeof length))
    damaged(path, "it is shorter than its header");
  if (length > longest_header || length > file_size - sizeof length) damaged(path, "its header is cut off");
  return length;
}

}  // namespace

StoredTensor store_floats(std::span<const float> values, std::vector<std::int64_t> shape, TensorType type) {
  if (type == TensorType::int32) throw UsageError("Floats cannot be stored as an integer tensor.");
  require_count(shape, values.size());
  StoredTensor tensor{type, std::move(shape), std::vector<std::byte>(values.size() * element_size(type))};
  if (values.empty()) return tensor;
  if (type == TensorType::float32) {
    std::memcpy(tensor.bytes.data(), values.data(), tensor.bytes.size());
    return tensor;
  }
  std::vector<std::uint16_t> halves(values.size());
  std::transform(values.begin(), values.end(), halves.begin(), type == TensorType::float16 ? to_float16 : to_bfloat16);
  std::memcpy(tensor.bytes.data(), halves.data(), tensor.bytes.size());
  return tensor;
}

StoredTensor store_integers(std::span<const std::int32_t> values, std::vector<std::int64_t> shape) {
  require_count(shape, values.size());
  StoredTensor tensor{TensorType::int32, std::move(shape), std::vector<std::byte>(values.size_bytes())};
  if (!values.empty()) std::memcpy(tensor.bytes.data(), values.data(), tensor.bytes.size());
  return tensor;
}

std::vector<float> load_floats(const StoredTensor& tensor) {
  if (tensor.type == TensorType::int32) throw UsageError("An integer tensor was read as floats.");
  std::vector<float> values(tensor.bytes.size() / element_size(tensor.type));
  if (values.empty()) return values;
  if (tensor.type == TensorType::float32) {
    std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
    return values;
  }
  std::vector<std::uint16_t> halves(values.size());
  std::memcpy(halves.data(), tensor.bytes.data(), tensor.bytes.size());
  if (tensor.type == TensorType::float16) {
    std::transform(halves.begin(), halves.end(), values.begin(), from_float16);
  } else {
    std::transform(halves.begin(), halves.end(), values.begin(),
                   [](std::uint16_t half) { return std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16); });
  }
  return values;
}

std::vector<std::int32_t> load_integers(const StoredTensor& tensor) {
  if (tensor.type != TensorType::int32) throw UsageError("A floating tensor was read as integers.");
  std::vector<std::int32_t> values(tensor.bytes.size() / sizeof(std::int32_t));
  if (!values.empty()) std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  return values;
}

TensorFile read_safetensors(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError("The weight file " + path.string() + " cannot be opened.");
  std::error_code failure;
  const std::uint64_t file_size = std::filesystem::file_size(path, failure);
  if (failure) throw InputError("The weight file " + path.string() + " cannot be opened.");
  const std::uint64_t header_length = read_header_length(path, stream, file_size);
  std::string header(header_length, '\0');
  std::vector<char> data(file_size - sizeof header_length - header_length);
  if (!stream.read(header.data(), static_cast<std::streamsize>(header.size())) ||
      !stream.read(data.data(), static_cast<std::streamsize>(data.size())))
    damaged(path, "it is cut off");
  const nlohmann::json table = nlohmann::json::parse(header, nullptr, false);
  if (!table.is_object()) damaged(path, "its header is not a JSON object");

  TensorFile file;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  for (const auto& [name, entry] : table.items()) {
    if (name == "__metadata__") {
      if (!entry.is_object()) damaged(path, "its metadata is not a JSON object");
      for (const auto& [key, text] : entry.items()) {
        if (!text.is_string()) damaged(path, "the metadata \"" + key + "\" is not text");
        file.metadata[key] = text.get<std::string>();
      }
      continue;
    }
    std::pair<std::uint64_t, std::uint64_t> range;
    file.tensors[name] = read_entry(path, name, entry, data, range);
    ranges.push_back(range);
  }
  std::sort(ranges.begin(), ranges.end());
  std::uint64_t end = 0;
  for (const auto& [begin, stop] : ranges) {
    if (begin != end) damaged(path, "its tensors overlap or leave gaps");
    end = stop;
  }
  if (end != data.size()) damaged(path, "it has data that belongs to no tensor");
  return file;
}

std::string safetensors_bytes(const TensorFile& file) {
  nlohmann::json table = nlohmann::json::object();
  if (!file.metadata.empty()) table["__metadata__"] = file.metadata;
  std::uint64_t offset = 0;
  for (const auto& [name, tensor] : file.tensors) {
    table[name] = {{"dtype", type_name(tensor.type)},
                   {"shape", tensor.shape},
                   {"data_offsets", {offset, offset + tensor.bytes.size()}}};
    offset += tensor.bytes.size();
  }
  std::string header = table.dump();
  header.resize((header.size() + 7) / 8 * 8, ' ');  // keeps the data aligned for readers that map the file
  const std::uint64_t length = header.size();

  std::string bytes(reinterpret_cast<const char*>(&length), sizeof length);
  bytes.reserve(sizeof length + header.size() + offset);
  bytes += header;
  for (const auto& [name, tensor] : file.tensors)
    bytes.append(reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size());
  return bytes;
}

void write_safetensors(const std::filesystem::path& path, const TensorFile& file) {
  write_output_files({{path, safetensors_bytes(file)}});
}

}  // namespace rhizodont
