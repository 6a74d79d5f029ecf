// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// STL as text. No two programs write it alike, so whatever can only mean one thing is taken for it.
#include "io/cursors.hpp"
#include "io/notes.hpp"
#include "io/recognise.hpp"
#include "io/stl.hpp"
#include "io/weld.hpp"

#include <fmt/core.h>

#include <cmath>

namespace rhizodont {
namespace {

bool begins_comment(std::string_view word) {
  return word.starts_with('#') || word.starts_with("//") || word.starts_with(';');
}

bool is_colour(std::string_view word) { return same_word(word, "color") || same_word(word, "colour"); }

class StlTextReader {
 public:
  explicit StlTextReader(std::string_view text) : cursor_(text), points_(text.size() / 400) {}

  MeshFile read() {
    while (const auto word = next_if_any()) {
      if (ended_ && !continues_mesh(*word)) {
        cursor_.rest_of_line();
        has_junk_ = true;
      } else if (same_word(*word, "solid")) {
        pass_name();
      } else if (same_word(*word, "endsolid")) {
        ended_ = true;
        pass_name();
      } else if (same_word(*word, "end")) {
        expect("solid");
        ended_ = true;
        pass_name();
      } else if (same_word(*word, "facet")) {
        read_facet();
        ended_ = false;
      } else {
        fail(*word, "facet");
      }
    }
    if (has_junk_) file_.notes.push_back("Text after the end of the mesh was passed over.");
    if (has_colours_) file_.notes.emplace_back(triangle_colours_note);
    if (!ended_) file_.notes.push_back("The file does not end with 'endsolid': look whether something is missing.");
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
    throw InputError(fmt::format("line {}: '{}' is expected, '{:.30}' was found", cursor_.line(), expected, found),
                     {cursor_.line()});
  }

  // Whether a word after the end of a mesh begins another one, or ends it: text may begin with the same words.
  bool continues_mesh(std::string_view word) const {
    TextCursor ahead = cursor_;
    const std::string_view next = ahead.word().value_or("");
    if (same_word(word, "facet")) return same_word(next, "normal") || same_word(next, "outer");
    if (same_word(word, "end")) return same_word(next, "solid");
    return same_word(word, "solid") || same_word(word, "endsolid");
  }

  // The next word that is no comment and no colour, if there is one.
  std::optional<std::string_view> next_if_any() {
    while (const auto word = cursor_.word()) {
      if (begins_comment(*word)) {
        cursor_.rest_of_line();
      } else if (is_colour(*word)) {
        cursor_.rest_of_line();
        has_colours_ = true;
      } else {
        return word;
      }
    }
    return std::nullopt;
  }

  std::string_view next_word() {
    const auto word = next_if_any();
    if (!word)
      throw InputError(fmt::format("line {}: the file ends in the middle of a triangle", cursor_.line()),
                       {cursor_.line()});
    return *word;
  }

  void expect(std::string_view expected) {
    const std::string_view word = next_word();
    if (!same_word(word, expected)) fail(word, expected);
  }

  // "endloop" or "end loop"
  void expect_end(std::string_view one_word, std::string_view second_word) {
    const std::string_view word = next_word();
    if (same_word(word, "end"))
      expect(second_word);
    else if (!same_word(word, one_word))
      fail(word, one_word);
  }

  // A name of any number of words, to the end of the line; where all of the mesh stands on one line, to the first
  // facet.
  void pass_name() {
    TextCursor name = cursor_;
    TextCursor rest(cursor_.rest_of_line());
    bool has_mesh = false;
    while (const auto word = rest.word()) has_mesh |= same_word(*word, "vertex");
    if (!has_mesh) return;
    for (TextCursor before = name; const auto word = name.word(); before = name) {
      if (!same_word(*word, "facet") && !same_word(*word, "solid")) continue;
      cursor_ = before;
      return;
    }
  }

  void read_facet() {
    pass_normal();
    expect("loop");
    Triangle triangle{};
    for (std::int32_t& v : triangle) {
      expect("vertex");
      v = points_.number_in(read_corner(), file_.mesh.vertices);
    }
    expect_end("endloop", "loop");
    expect_end("endfacet", "facet");
    file_.mesh.triangles.push_back(triangle);
  }

  // To the word "outer". The normal is not used: many files hold zeros or "nan" there, or nothing at all.
  void pass_normal() {
    std::string_view word = next_word();
    if (same_word(word, "normal")) {
      word = next_word();
      for (int i = 0; i < 3 && !same_word(word, "outer"); ++i) word = next_word();
    }
    if (!same_word(word, "outer")) fail(word, "outer");
  }

  Point read_corner() {
    Point corner;
    for (double& x : corner) {
      const auto word = cursor_.word();
      if (!word)
        throw InputError(fmt::format("line {}: the file ends in the middle of a triangle", cursor_.line()),
                         {cursor_.line()});
      const auto value = parse_number<float>(*word);
      if (!value) throw InputError(fmt::format("line {}: {}", cursor_.line(), no_number(*word)), {cursor_.line()});
      if (!std::isfinite(*value))
        throw InputError(fmt::format("line {}: a coordinate is not a finite number", cursor_.line()), {cursor_.line()});
      x = static_cast<double>(*value);
    }
    return corner;
  }

  TextCursor cursor_;
  EqualPoints points_;
  bool ended_ = false, has_junk_ = false, has_colours_ = false;
  MeshFile file_;
};

}  // namespace

bool is_stl_text(std::string_view bytes) {
  if (!is_text(bytes)) return false;
  TextCursor cursor(bytes);
  std::optional<std::string_view> word;
  while ((word = cursor.word()) && (begins_comment(*word) || is_colour(*word))) cursor.rest_of_line();
  if (!word) return false;
  if (same_word(*word, "facet")) return true;
  if (!same_word(*word, "solid")) return false;
  // a title may be anything, but the next line is a facet, a comment or the end
  TextCursor title(cursor.rest_of_line());
  for (word = title.word(); word; word = title.word())
    if (same_word(*word, "facet")) return true;
  while ((word = cursor.word()) && (begins_comment(*word) || is_colour(*word))) cursor.rest_of_line();
  return !word || same_word(*word, "facet") || same_word(*word, "endsolid") || same_word(*word, "end");
}

MeshFile read_stl_text(std::string_view text) { return StlTextReader(text).read(); }

}  // namespace rhizodont
