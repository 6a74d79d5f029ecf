// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/safetensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

class Safetensors : public ::testing::Test {
 protected:
  std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("rhizodont_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".safetensors");

  void TearDown() override { std::filesystem::remove(path_); }

  void write_raw(const std::string& header, const std::string& data) {
    std::ofstream stream(path_, std::ios::binary);
    const std::uint64_t length = header.size();
    stream.write(reinterpret_cast<const char*>(&length), sizeof length);
    stream << header << data;
  }

  std::string bytes() {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  void expect_refused() { EXPECT_THROW(read_safetensors(path_), InputError); }
};

std::string entry(const std::string& type, const std::string& shape, const std::string& offsets) {
  return R"({"dtype":")" + type + R"(","shape":)" + shape + R"(,"data_offsets":)" + offsets + "}";
}

TEST_F(Safetensors, RoundTripKeepsEverything) {
  TensorFile file;
  const std::vector<float> values{1.5F, -0.0F, 3e-20F, std::numeric_limits<float>::infinity(), 7, 8};
  const std::vector<std::int32_t> integers{-1, 2147483647};
  file.tensors["weights"] = store_floats(values, {2, 3});
  file.tensors["ids"] = store_integers(integers, {2});
  file.tensors["empty"] = store_floats({}, {0, 4});
  file.tensors["number"] = store_floats(std::vector<float>{4}, {});
  file.metadata = {{"title", "a \"quoted\" name"}, {"unit", "12 mm"}};
  write_safetensors(path_, file);
  const TensorFile read = read_safetensors(path_);
  EXPECT_EQ(read.metadata, file.metadata);
  ASSERT_EQ(read.tensors.size(), 4U);
  EXPECT_EQ(read.tensors.at("weights").shape, (std::vector<std::int64_t>{2, 3}));
  const std::vector<float> back = load_floats(read.tensors.at("weights"));
  EXPECT_EQ(std::memcmp(back.data(), values.data(), sizeof(float) * values.size()), 0);
  EXPECT_EQ(load_integers(read.tensors.at("ids")), integers);
  EXPECT_TRUE(load_floats(read.tensors.at("empty")).empty());
  EXPECT_TRUE(read.tensors.at("number").shape.empty());
  EXPECT_EQ(load_floats(read.tensors.at("number")), std::vector<float>{4});
}

TEST_F(Safetensors, SameContentSameBytes) {
  TensorFile file;
  file.tensors["b"] = store_floats(std::vector<float>{1, 2}, {2});
  file.tensors["a"] = store_floats(std::vector<float>{3}, {1}, TensorType::bfloat16);
  write_safetensors(path_, file);
  const std::string first = bytes();
  write_safetensors(path_, file);
  EXPECT_EQ(bytes(), first);
}

TEST(HalfPrecision, KnownValues) {
  const auto half = [](float value) {
    const StoredTensor tensor = store_floats(std::vector<float>{value}, {1}, TensorType::float16);
    std::uint16_t bits = 0;
    std::memcpy(&bits, tensor.bytes.data(), 2);
    return bits;
  };
  EXPECT_EQ(half(1.0F), 0x3c00);
  EXPECT_EQ(half(-2.0F), 0xc000);
  EXPECT_EQ(half(65504.0F), 0x7bff);      // the largest finite half
  EXPECT_EQ(half(65520.0F), 0x7c00);      // rounds up to infinity
  EXPECT_EQ(half(0x1p-24F), 0x0001);      // the smallest subnormal
  EXPECT_EQ(half(0x1p-25F), 0x0000);      // a tie, to even
  EXPECT_EQ(half(0x1.8p-24F), 0x0002);    // a tie, to even
  EXPECT_EQ(half(0x1p-14F), 0x0400);      // the smallest normal
  EXPECT_EQ(half(1 + 0x1p-11F), 0x3c00);  // a tie, to even
  EXPECT_EQ(half(1 + 0x1.8p-10F), 0x3c02);
  EXPECT_EQ(half(-0.0F), 0x8000);
  EXPECT_EQ(half(std::numeric_limits<float>::quiet_NaN()) & 0x7e00, 0x7e00);
}

TEST(HalfPrecision, EveryHalfNumberComesBack) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    if ((bits & 0x7c00) == 0x7c00 && (bits & 0x3ff) != 0) continue;  // NaN
    StoredTensor tensor{TensorType::float16, {1}, std::vector<std::byte>(2)};
    const auto pattern = static_cast<std::uint16_t>(bits);
    std::memcpy(tensor.bytes.data(), &pattern, 2);
    const std::vector<float> value = load_floats(tensor);
    ASSERT_EQ(store_floats(value, {1}, TensorType::float16).bytes, tensor.bytes) << bits;
  }
}

TEST(HalfPrecision, RoundsToTheNearest) {
  for (float value = 1e-7F; value < 6e4F; value *= 1.0137F) {
    const float half = load_floats(store_floats(std::vector<float>{value}, {1}, TensorType::float16))[0];
    EXPECT_LE(std::abs(half - value), std::max(value * 0x1p-11F, 0x1p-25F));
    const float brain = load_floats(store_floats(std::vector<float>{value}, {1}, TensorType::bfloat16))[0];
    EXPECT_LE(std::abs(brain - value), value * 0x1p-8F);
  }
}

TEST(StoredTensors, RefuseWrongShapesAndTypes) {
  const std::vector<float> values{1, 2, 3};
  EXPECT_THROW(store_floats(values, {2}), UsageError);
  EXPECT_THROW(store_floats(values, {-3}), UsageError);
  EXPECT_THROW(store_floats(values, {3}, TensorType::int32), UsageError);
  EXPECT_THROW(load_integers(store_floats(values, {3})), UsageError);
  EXPECT_THROW(load_floats(store_integers(std::vector<std::int32_t>{1}, {1})), UsageError);
}

TEST_F(Safetensors, MissingFileAndFolder) {
  expect_refused();
  EXPECT_THROW(write_safetensors("/proc/nowhere/at/all.safetensors", {}), OutputError);
}

TEST_F(Safetensors, EveryTruncationIsRefused) {
  TensorFile file;
  file.tensors["a"] = store_floats(std::vector<float>{1, 2, 3}, {3});
  write_safetensors(path_, file);
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    EXPECT_THROW(read_safetensors(path_), InputError) << size;
  }
}

TEST_F(Safetensors, DamagedHeadersAreRefused) {
  const std::string eight(8, '\0');
  const std::vector<std::string> headers{
      "not json",
      "[]",
      R"({"a":1})",
      R"({"__metadata__":{"x":1}})",
      R"({"a":)" + entry("F64", "[1]", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[2]", "[0,9]") + "}",
      R"({"a":)" + entry("F32", "[3]", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[-2]", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[2.0]", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[4294967296,4294967296,4294967296]", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[2]", "[8,0]") + "}",
      R"({"a":)" + entry("F32", "2", "[0,8]") + "}",
      R"({"a":)" + entry("F32", R"({"x":2})", "[0,8]") + "}",
      R"({"a":)" + entry("F32", "[2]", R"({"x":0,"y":8})") + "}",
      R"({"a":)" + entry("F32", "[2]", "[0]") + "}",
      R"({"a":)" + entry("F32", "[1]", "[0,4]") + "}",                                              // data left over
      R"({"a":)" + entry("F32", "[1]", "[4,8]") + "}",                                              // a gap
      R"({"a":)" + entry("F32", "[2]", "[0,8]") + R"(,"b":)" + entry("F32", "[1]", "[4,8]") + "}",  // an overlap
  };
  for (const std::string& header : headers) {
    write_raw(header, eight);
    EXPECT_THROW(read_safetensors(path_), InputError) << header;
  }
  write_raw(R"({"a":)" + entry("F32", "[2]", "[0,8]") + "}", eight);  // the same with nothing wrong
  EXPECT_EQ(load_floats(read_safetensors(path_).tensors.at("a")), (std::vector<float>{0, 0}));
}

TEST_F(Safetensors, HugeHeaderLengthIsRefused) {
  std::ofstream(path_, std::ios::binary) << std::string(8, '\xff') << "{}";
  expect_refused();
}

}  // namespace
}  // namespace rhizodont
