// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace rhizodont {

/// Element types that the safetensors reader and writer know.
enum class TensorType {
  float32,   ///< "F32"
  float16,   ///< "F16", IEEE half precision
  bfloat16,  ///< "BF16", the upper half of a float32
  int32,     ///< "I32"
};

/// One dense row-major tensor as it lies in a file (little endian).
struct StoredTensor {
  TensorType type = TensorType::float32;
  std::vector<std::int64_t> shape;  ///< empty: a single number
  std::vector<std::byte> bytes;     ///< product of the shape times the element's size
};

/// The content of a safetensors file: named tensors and free text.
struct TensorFile {
  std::map<std::string, StoredTensor> tensors;
  std::map<std::string, std::string> metadata;
};

/// Packs `values` as a tensor of a floating type; rounds to nearest, ties to even.
/// Values beyond the range of half precision become infinite. Throws UsageError if the shape does not have
/// `values.size()` elements or `type` is int32.
StoredTensor store_floats(std::span<const float> values, std::vector<std::int64_t> shape,
                          TensorType type = TensorType::float32);

/// Packs integers. Throws UsageError if the shape does not have `values.size()` elements.
StoredTensor store_integers(std::span<const std::int32_t> values, std::vector<std::int64_t> shape);

/// The elements of a floating tensor as float32, exact for each type. Throws UsageError for an int32 tensor.
std::vector<float> load_floats(const StoredTensor& tensor);

/// The elements of an int32 tensor. Throws UsageError for a floating tensor.
std::vector<std::int32_t> load_integers(const StoredTensor& tensor);

/// Reads a safetensors file (huggingface.co/docs/safetensors: 8-byte header length, JSON header, data).
/// Throws InputError if the file cannot be read or is damaged: truncated, header not JSON, unknown element type, sizes
/// that contradict shapes, data that overlaps or leaves gaps.
TensorFile read_safetensors(const std::filesystem::path& path);

/// A safetensors file; the same content gives the same bytes.
std::string safetensors_bytes(const TensorFile& file);

/// Writes it as `write_output_files` does: a stopped run leaves the older file as it was. Throws OutputError if it
/// cannot be written.
void write_safetensors(const std::filesystem::path& path, const TensorFile& file);

}  // namespace rhizodont
