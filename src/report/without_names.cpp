// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/without_names.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <system_error>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

/// A name without a dot or a folder may be a word of the sentence too: it is the file's where a reader or the system
/// puts one, in front or in brackets.
bool is_plain_word(const std::string& name) { return name.find_first_of("./") == std::string::npos; }

void replace_all(std::string& text, const std::string& what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos;) {
    const bool is_name = !is_plain_word(what) || at == 0 || text[at - 1] == '[' || text[at - 1] == '"';
    if (is_name) text.replace(at, what.size(), with);
    at = text.find(what, at + (is_name ? with.size() : what.size()));
  }
}

/// A reader shows what is not ASCII by question marks.
std::string as_read(std::string name) {
  for (char& c : name)
    if (c < ' ' || c > '~') c = '?';
  return name;
}

/// All forms of the files' names, the longest first.
std::vector<std::string> names_of(const std::vector<fs::path>& files) {
  std::set<std::string> names;
  for (const fs::path& file : files) {
    std::error_code ignored;
    for (const fs::path& form : {file, file.lexically_normal(), fs::absolute(file, ignored),
                                 fs::weakly_canonical(file, ignored), file.filename()})
      names.insert(form.string());
  }
  std::vector<std::string> sorted;
  for (const std::string& name : names) {
    if (name.find_first_not_of("./") == std::string::npos) continue;
    sorted.push_back(name);
    if (as_read(name) != name) sorted.push_back(as_read(name));
  }
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return sorted;
}

/// Words that formats and options have of their own.
bool is_known_word(std::string_view word) {
  static const std::set<std::string_view> known{"labels",   "instances", "jaw",    "solid",  "facet",
                                                "normal",   "outer",     "loop",   "vertex", "endloop",
                                                "endfacet", "endsolid",  "point:", "cell:"};
  return known.contains(word);
}

std::string without_quoted(const std::string& text) {
  std::string result;
  std::size_t at = 0;
  while (true) {
    // An apostrophe ("tooth's") has a letter before it and opens nothing.
    std::size_t open = text.find('\'', at);
    while (open != std::string::npos && open > 0 && text[open - 1] != ' ' && text[open - 1] != '(')
      open = text.find('\'', open + 1);
    const std::size_t close = open == std::string::npos ? open : text.find('\'', open + 1);
    if (close == std::string::npos) return result + text.substr(at);
    const std::string_view word = std::string_view(text).substr(open + 1, close - open - 1);
    result += text.substr(at, open - at);
    result += is_known_word(word) ? "'" + std::string(word) + "'" : "a word";
    at = close + 1;
  }
}

}  // namespace

std::string without_names(std::string sentence, const std::vector<fs::path>& files) {
  for (const std::string& name : names_of(files)) replace_all(sentence, name, "the file");
  return without_quoted(sentence);
}

}  // namespace rhizodont
