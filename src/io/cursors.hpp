// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"
#include "rhizodont/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// Words of a text, with the number of the line (from 1) on which the last one stood. Lines end with LF, CR or both.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, std::int64_t first_line = 1) : text_(text), line_(first_line) {}

  std::int64_t line() const { return line_; }

  /// The next word, over line ends; nothing at the end of the text.
  std::optional<std::string_view> word() {
    for (; place_ < text_.size() && is_space(text_[place_]); ++place_) line_ += ends_line(place_);
    if (place_ == text_.size()) return std::nullopt;
    const std::size_t start = place_;
    while (place_ < text_.size() && !is_space(text_[place_])) ++place_;
    return text_.substr(start, place_ - start);
  }

  /// What is left of the current line, without its end.
  std::string_view rest_of_line() {
    std::size_t end = place_;
    while (end < text_.size() && text_[end] != '\n' && text_[end] != '\r') ++end;
    const std::string_view rest = text_.substr(place_, end - place_);
    const bool two = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
    place_ = std::min(end + (two ? 2 : 1), text_.size());
    line_ += end < text_.size();
    return rest;
  }

  std::size_t remaining() const { return text_.size() - place_; }

  /// Bytes among the text, taken as they are. Precondition: count <= remaining().
  std::string_view bytes(std::size_t count) {
    const std::string_view taken = text_.substr(place_, count);
    place_ += count;
    return taken;
  }

 private:
  bool ends_line(std::size_t place) const {
    return text_[place] == '\n' || (text_[place] == '\r' && (place + 1 == text_.size() || text_[place + 1] != '\n'));
  }
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_;
  std::size_t place_ = 0;
  std::int64_t line_;
};

/// Whether a word is the expected one, which is in lower case, in whatever case it is written.
inline bool same_word(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b; });
}

/// The number that a whole word is, in any of the usual spellings; nothing if it is none.
/// Correctly rounded to T.
template <class T>
std::optional<T> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || word.empty()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    // Too small or too large for T: the nearest T is 0 or infinity, and the check for finite numbers comes later.
    if (error == std::errc::result_out_of_range) {
      const double wide = std::strtod(std::string(word).c_str(), nullptr);
      return static_cast<T>(wide);
    }
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

/// Binary numbers one after the other.
class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, std::endian order) : bytes_(bytes), swap_(order != std::endian::native) {}

  std::size_t remaining() const { return bytes_.size() - place_; }
  std::size_t place() const { return place_; }

  /// Precondition: sizeof(T) <= remaining().
  template <class T>
  T read() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + place_, sizeof(T));
    place_ += sizeof(T);
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  /// Precondition: count <= remaining().
  void skip(std::size_t count) { place_ += count; }

 private:
  std::string_view bytes_;
  std::size_t place_ = 0;
  bool swap_;
};

/// The sentence for a word that should be a number.
inline std::string no_number(std::string_view word) {
  std::string with_point(word);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  const bool has_comma = with_point != word && parse_number<double>(with_point);
  return fmt::format("'{:.30}' is not a number{}", word,
                     has_comma ? ": it has a decimal comma; save the file with decimal points" : "");
}

/// Reads the three coordinates of a vertex, in any of the text formats; `fail(sentence)` does not return.
template <class Fail>
Point read_coordinates(TextCursor& words, const Fail& fail) {
  Point point;
  for (double& coordinate : point) {
    const auto word = words.word();
    const auto value = parse_number<double>(word.value_or(""));
    if (!value) fail(word ? no_number(*word) : "a vertex needs three coordinates");
    if (!std::isfinite(*value)) fail("a coordinate is not a finite number");
    coordinate = *value;
  }
  return point;
}

/// An index in a file as ours; values that do not fit become -1, which `finish_reading` refuses.
inline std::int32_t to_index(std::int64_t value) {
  return value < 0 || value > INT32_MAX ? -1 : static_cast<std::int32_t>(value);
}

}  // namespace rhizodont
