// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <string_view>

namespace rhizodont::command_line {
namespace {

/// Damerau and Levenshtein's distance, neighbours swapped counting as one.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, changed});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> closest_word(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t shortest_beginning = 3;
  std::optional<std::string> best;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  bool is_alone = true;
  for (const std::string& candidate : known) {
    const bool begins = word.size() >= shortest_beginning && candidate.starts_with(word);
    const std::size_t wrong = begins ? 0 : edits(word, candidate);
    if (wrong == fewest) is_alone = false;
    if (wrong >= fewest) continue;
    fewest = wrong;
    best = candidate;
    is_alone = true;
  }
  return is_alone ? best : std::nullopt;
}

std::string error_line(const Error& error, const std::string& where_all_are) {
  constexpr std::size_t most_shown = 3;
  const auto& ids = error.elements();
  std::string text = error.what();
  if (ids.empty()) return text;
  text += fmt::format(
      " [{}",
      fmt::join(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(std::min(ids.size(), most_shown)), ", "));
  if (ids.size() > most_shown)
    text += fmt::format(", ...: {} in all{}", ids.size(), where_all_are.empty() ? "" : ", " + where_all_are);
  return text + "]";
}

std::string fault_line(const std::exception& fault) {
  if (dynamic_cast<const std::bad_alloc*>(&fault) != nullptr) return "the machine's memory is not enough for this";
  // oneTBB tells of a thread for which there is no memory as a runtime error with these words
  if (std::string_view(fault.what()).starts_with("pthread_create has failed"))
    return "the machine's memory, or the number of threads that it allows, is not enough for this";
  return std::string("a fault of the program: ") + fault.what();
}

}  // namespace rhizodont::command_line
