// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rhizodont {

/// One record of a table, with the line that it begins on, from 1.
struct CsvRecord {
  int line = 0;
  std::vector<std::string> fields;
};

/// Reads RFC 4180: fields in double quotes may hold separators, ends of lines and doubled quotes. Lines end with LF,
/// CRLF or CR; empty lines are passed over, a byte order mark too. Throws InputError, with the line, for a quote inside
/// of an unquoted field, text after a closing quote, a quote that is never closed, and for text that is not UTF-8.
std::vector<CsvRecord> read_csv(std::string_view text, char separator);

}  // namespace rhizodont
