// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/csv.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace rhizodont {
namespace {

[[noreturn]] void fail(int line, const char* what) { throw InputError(fmt::format("Line {}: {}.", line, what)); }

/// Bytes of the UTF-8 character that begins so; 0 if none does.
std::size_t utf8_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

void require_utf8(std::string_view text) {
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(static_cast<unsigned char>(text[i]));
    const std::string_view rest = text.substr(i + 1, length == 0 ? 0 : length - 1);
    const bool is_whole = length != 0 && rest.size() == length - 1 &&
                          std::all_of(rest.begin(), rest.end(), [](char c) { return (c & 0xC0) == 0x80; });
    if (!is_whole || text[i] == '\0') fail(line, "this is no text in UTF-8; save the table as CSV with UTF-8");
    line += text[i] == '\n' || (text[i] == '\r' && text.substr(i + 1, 1) != "\n");
    i += length;
  }
}

class CsvReader {
 public:
  CsvReader(std::string_view text, char separator) : text_(text), separator_(separator) {}

  std::vector<CsvRecord> read() {
    std::vector<CsvRecord> records;
    while (at_ < text_.size()) {
      CsvRecord record{line_, {}};
      do record.fields.push_back(field());
      while (takes(separator_));
      take_line_end();
      if (record.fields.size() > 1 || !record.fields.front().empty()) records.push_back(std::move(record));
    }
    return records;
  }

 private:
  bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }

  bool takes(char c) {
    const bool is_next = next_is(c);
    at_ += is_next ? 1 : 0;
    return is_next;
  }

  bool take_line_end() {
    const bool carriage_return = takes('\r');
    const bool ended = takes('\n') || carriage_return;
    line_ += ended ? 1 : 0;
    return ended;
  }

  std::string field() {
    if (takes('"')) return quoted_field();
    std::string value;
    while (at_ < text_.size() && !next_is(separator_) && !next_is('\r') && !next_is('\n')) {
      if (next_is('"')) fail(line_, "a quote stands inside of a field; put the whole field in quotes, and double it");
      value += text_[at_++];
    }
    return value;
  }

  std::string quoted_field() {
    const int begin = line_;
    std::string value;
    while (true) {
      if (at_ == text_.size()) fail(begin, "a quote is opened and never closed");
      if (takes('"')) {
        if (!takes('"')) break;
        value += '"';
      } else if (take_line_end()) {
        value += '\n';
      } else {
        value += text_[at_++];
      }
    }
    if (at_ < text_.size() && !next_is(separator_) && !next_is('\r') && !next_is('\n'))
      fail(line_, "text follows the quote that closes a field");
    return value;
  }

  std::string_view text_;
  char separator_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::vector<CsvRecord> read_csv(std::string_view text, char separator) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  require_utf8(text);
  return CsvReader(text, separator).read();
}

}  // namespace rhizodont
