// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Legacy VTK files ("VTK File Formats", Kitware), versions 1 to 5.1, with a surface (POLYDATA): text or big-endian
// bytes.
#include "base/lower_case.hpp"
#include "io/colours.hpp"
#include "io/cursors.hpp"
#include "io/face_list.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"
#include "io/vtk_numbers.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace rhizodont {
namespace {

/// How the numbers of an array are written. Bits are packed and texts have lengths of their own, so both stand apart.
struct ArrayType {
  enum class Kind { number, bit, text } kind = Kind::number;
  VtkNumber number = VtkNumber::float64;
};

std::optional<ArrayType> type_named(std::string_view name) {
  using enum VtkNumber;
  static const std::map<std::string_view, VtkNumber> numbers{{"char", int8},
                                                             {"signed_char", int8},
                                                             {"unsigned_char", uint8},
                                                             {"short", int16},
                                                             {"unsigned_short", uint16},
                                                             {"int", int32},
                                                             {"unsigned_int", uint32},
                                                             {"long", int64},
                                                             {"unsigned_long", uint64},
                                                             {"vtktypeint64", int64},
                                                             {"vtktypeuint64", uint64},
                                                             {"vtkidtype", int32},
                                                             {"float", float32},
                                                             {"double", float64}};
  const std::string word = lower_case(name);
  if (word == "bit") return ArrayType{ArrayType::Kind::bit, uint8};
  if (word == "string" || word == "utf8_string") return ArrayType{ArrayType::Kind::text, uint8};
  const auto place = numbers.find(word);
  if (place == numbers.end()) return std::nullopt;
  return ArrayType{ArrayType::Kind::number, place->second};
}

/// Names may hold spaces and more, as %20.
std::string decoded(std::string_view name) {
  std::string result;
  for (std::size_t k = 0; k < name.size(); ++k) {
    unsigned value = 0;
    if (name[k] == '%' && k + 2 < name.size() &&
        std::from_chars(name.data() + k + 1, name.data() + k + 3, value, 16).ptr == name.data() + k + 3) {
      result.push_back(static_cast<char>(value));
      k += 2;
    } else {
      result.push_back(name[k]);
    }
  }
  return result;
}

class VtkReader {
 public:
  explicit VtkReader(std::string_view bytes) : cursor_(bytes) {}

  MeshFile read() {
    cursor_.rest_of_line();  // the version, which other lines tell better
    cursor_.rest_of_line();  // a title
    const std::string_view encoding = cursor_.word().value_or("");
    if (!same_word(encoding, "ascii") && !same_word(encoding, "binary"))
      fail(fmt::format("'{:.30}' is no encoding of VTK files", encoding));
    binary_ = same_word(encoding, "binary");
    while (const auto keyword = cursor_.word()) {
      const std::int64_t line = cursor_.line();
      TextCursor words(cursor_.rest_of_line());
      if (read_structure(*keyword, words) || read_attribute(*keyword, words)) continue;
      if (!has_cells_ || cursor_.remaining() == 0)  // at the end it is a word that was cut off
        throw InputError(fmt::format("line {}: {} is not known in a VTK file", line, shown(*keyword)), {line});
      file_.notes.push_back(fmt::format("What stands from line {} on was passed over: {} is not known in a VTK file.",
                                        line, shown(*keyword)));
      break;
    }
    faces_.move_to(file_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("line {}: {}", cursor_.line(), what), {cursor_.line()});
  }

  // A word of the file for a message; bytes that lost their place are not shown.
  static std::string shown(std::string_view word) {
    const bool plain = std::all_of(word.begin(), word.end(), [](char c) { return c > ' ' && c < 127; });
    return plain ? fmt::format("'{:.30}'", word) : std::string("what stands there");
  }

  std::uint64_t count(TextCursor& words, const char* what) const {
    const auto value = parse_number<std::uint64_t>(words.word().value_or(""));
    if (!value) fail(fmt::format("the number of {} is missing", what));
    return *value;
  }

  // A header may lie: nothing is read, and no place made, for more than the rest of the file can hold.
  std::uint64_t with_room(std::uint64_t tuples, std::uint64_t components, std::size_t least_size) const {
    const std::uint64_t room = (cursor_.remaining() + 1) / least_size;
    if (components == 0 || tuples > room / components)
      fail(fmt::format("the file is damaged or cut off: it has no room for all of the data announced"));
    return tuples * components;
  }

  ArrayType type(TextCursor& words) const {
    const std::string_view name = words.word().value_or("");
    const auto found = type_named(name);
    if (!found) fail(fmt::format("{} is no type of number", shown(name)));
    return *found;
  }

  std::vector<double> values(const ArrayType& type, std::uint64_t tuples, std::uint64_t components) {
    if (type.kind == ArrayType::Kind::text) {
      for (std::uint64_t k = with_room(tuples, components, 1); k > 0; --k) pass_text();
      return {};
    }
    if (binary_ && type.kind == ArrayType::Kind::bit) {
      constexpr std::uint64_t in_byte = 8;
      if (components == 0 || tuples > in_byte * cursor_.remaining() / components) fail("the file is cut off");
      cursor_.bytes((tuples * components + in_byte - 1) / in_byte);
      return {};
    }
    if (binary_) {
      const std::size_t size = byte_size(type.number);
      const std::uint64_t number = with_room(tuples, components, size);
      if (number * size > cursor_.remaining()) fail("the file is cut off");
      return numbers_from(type.number, cursor_.bytes(number * size), std::endian::big);
    }
    std::vector<double> result(with_room(tuples, components, 2));
    for (double& value : result) {
      const auto word = cursor_.word();
      if (!word) fail("the file is cut off");
      const auto number = number_from(type.number, *word);
      if (!number) fail(fmt::format("{} is not a number", shown(*word)));
      value = *number;
    }
    return result;
  }

  void pass_text() {
    if (!binary_) {
      cursor_.rest_of_line();
      return;
    }
    // the two highest bits of the first byte say in how many bytes the length stands
    if (cursor_.remaining() == 0) fail("the file is cut off");
    std::uint64_t length = static_cast<unsigned char>(cursor_.bytes(1)[0]);
    const std::size_t more = std::array<std::size_t, 4>{7, 3, 1, 0}[length >> 6];
    length &= 0x3f;
    if (cursor_.remaining() < more) fail("the file is cut off");
    for (const char c : cursor_.bytes(more)) length = length << 8 | static_cast<unsigned char>(c);
    if (cursor_.remaining() < length) fail("the file is cut off");
    cursor_.bytes(length);
  }

  bool read_structure(std::string_view keyword, TextCursor& words) {
    if (same_word(keyword, "dataset")) {
      const std::string_view kind = words.word().value_or("");
      if (!same_word(kind, "polydata")) fail(fmt::format("the file holds {}, no surface (POLYDATA)", shown(kind)));
    } else if (same_word(keyword, "points")) {
      read_points(words);
    } else if (same_word(keyword, "polygons")) {
      strips_first_ |= strips_ > 0;
      read_cells(words, [&](std::span<const std::int32_t> corners) { faces_.add_polygon(corners); });
    } else if (same_word(keyword, "triangle_strips")) {
      read_cells(words, [&](std::span<const std::int32_t> corners) {
        faces_.add_strip(corners);
        ++strips_;
      });
    } else if (same_word(keyword, "vertices") || same_word(keyword, "lines")) {
      read_cells(words, [&](std::span<const std::int32_t>) { ++cells_before_; });
    } else if (same_word(keyword, "point_data")) {
      tuples_ = count(words, "points");
      values_of_ = ValuesOf::points;
    } else if (same_word(keyword, "cell_data")) {
      tuples_ = count(words, "cells");
      values_of_ = ValuesOf::cells;
    } else if (same_word(keyword, "metadata")) {
      while (cursor_.remaining() > 0 && cursor_.rest_of_line().find_first_not_of(" \t") != std::string_view::npos) {
      }
    } else {
      return false;
    }
    return true;
  }

  void read_points(TextCursor& words) {
    const std::uint64_t number = count(words, "points");
    const std::vector<double> coordinates = values(type(words), number, 3);
    if (coordinates.size() != 3 * number) fail("the points are no numbers");
    if (!file_.mesh.vertices.empty()) fail("there are points twice");
    for (std::size_t k = 0; k < coordinates.size(); k += 3)
      file_.mesh.vertices.emplace_back(coordinates[k], coordinates[k + 1], coordinates[k + 2]);
  }

  bool next_is(std::string_view keyword) const {
    TextCursor ahead = cursor_;
    return same_word(ahead.word().value_or(""), keyword);
  }

  std::vector<double> named_numbers(const char* name, std::uint64_t number) {
    if (!next_is(name)) fail(fmt::format("'{}' is missing", name));
    cursor_.word();
    TextCursor words(cursor_.rest_of_line());
    return values(type(words), number, 1);
  }

  // Up to version 4 each cell is its length and its corners; later all offsets and then all corners.
  template <class Take>
  void read_cells(TextCursor& words, const Take& take) {
    const std::uint64_t first = count(words, "cells"), second = count(words, "corners");
    has_cells_ = true;
    std::vector<std::int32_t> corners;
    std::int64_t cell = 0;
    const auto add = [&](const double* begin, const double* end) {
      corners.clear();
      for (; begin != end; ++begin) corners.push_back(vertex(*begin, cell));
      take(std::span<const std::int32_t>(corners));
      ++cell;
    };
    if (next_is("offsets")) {
      const std::vector<double> offsets = named_numbers("offsets", first);
      const std::vector<double> numbers = named_numbers("connectivity", second);
      for (std::size_t k = 1; k < offsets.size(); ++k) {
        if (!(offsets[k - 1] >= 0 && offsets[k] >= offsets[k - 1] && offsets[k] <= static_cast<double>(numbers.size())))
          fail_cell(cell, "lies outside the file's list of corners");
        add(numbers.data() + static_cast<std::size_t>(offsets[k - 1]),
            numbers.data() + static_cast<std::size_t>(offsets[k]));
      }
      return;
    }
    const std::vector<double> numbers = values({ArrayType::Kind::number, VtkNumber::int32}, second, 1);
    for (std::size_t k = 0; static_cast<std::uint64_t>(cell) < first;) {
      if (k >= numbers.size() || !(numbers[k] >= 0 && numbers[k] < static_cast<double>(numbers.size() - k)))
        fail_cell(cell, "lies outside the file's list of corners");
      const auto length = static_cast<std::size_t>(numbers[k]);
      add(numbers.data() + k + 1, numbers.data() + k + 1 + length);
      k += 1 + length;
    }
  }

  [[noreturn]] static void fail_cell(std::int64_t cell, const char* what) {
    throw InputError(fmt::format("polygon {} (counted from 0) {}", cell, what), {cell});
  }

  std::int32_t vertex(double number, std::int64_t cell) const {
    if (!(number >= 0 && number < static_cast<double>(file_.mesh.vertices.size())))
      fail_cell(cell, "refers to a vertex that does not exist");
    return static_cast<std::int32_t>(number);
  }

  bool read_attribute(std::string_view keyword, TextCursor& words) {
    if (same_word(keyword, "field")) {
      words.word();
      for (std::uint64_t k = count(words, "arrays"); k > 0; --k) read_field_array();
      return true;
    }
    if (same_word(keyword, "lookup_table")) {
      words.word();
      values(colour_type(), count(words, "colours"), 4);
      return true;
    }
    const std::string name = decoded(words.word().value_or(""));
    if (same_word(keyword, "scalars")) {
      const ArrayType of = type(words);
      const std::uint64_t components = parse_number<std::uint64_t>(words.word().value_or("")).value_or(1);
      if (next_is("lookup_table")) {
        cursor_.word();
        cursor_.rest_of_line();
      }
      take(name, of, tuples_, components);
    } else if (same_word(keyword, "color_scalars")) {
      take(name, colour_type(), tuples_, count(words, "components"), true);
    } else if (same_word(keyword, "texture_coordinates")) {
      const std::uint64_t components = count(words, "components");
      values(type(words), tuples_, components);
    } else {
      static const std::map<std::string_view, std::uint64_t> components{
          {"vectors", 3},    {"normals", 3},      {"tensors", 9},   {"tensors6", 6},
          {"global_ids", 1}, {"pedigree_ids", 1}, {"edge_flags", 1}};
      const auto place = components.find(lower_case(keyword));
      if (place == components.end()) return false;
      values(type(words), tuples_, place->second);
    }
    return true;
  }

  ArrayType colour_type() const { return {ArrayType::Kind::number, binary_ ? VtkNumber::uint8 : VtkNumber::float32}; }

  void read_field_array() {
    const auto word = cursor_.word();
    if (!word) fail("the file is cut off");
    TextCursor words(cursor_.rest_of_line());
    const std::uint64_t components = count(words, "components"), tuples = count(words, "values");
    if (components > 0 && tuples > 0) take(decoded(*word), type(words), tuples, components);
    // what is said about the array may follow it, before the next one
    while (next_is("metadata")) {
      cursor_.word();
      TextCursor rest(cursor_.rest_of_line());
      read_structure("metadata", rest);
    }
  }

  // Values beside the mesh are kept where they fit, and are no reason to refuse it where they do not.
  void take(const std::string& name, const ArrayType& of, std::uint64_t tuples, std::uint64_t components,
            bool called_colour = false) {
    std::vector<double> numbers = values(of, tuples, components);
    // bytes in threes or fours are colours too
    const bool is_colour = (components == 3 || components == 4) && (called_colour || of.number == VtkNumber::uint8);
    if (values_of_ == ValuesOf::file || numbers.empty() || of.kind != ArrayType::Kind::number ||
        (components != 1 && !is_colour))
      return;
    const bool of_points = values_of_ == ValuesOf::points;
    const std::size_t expected = of_points ? file_.mesh.vertices.size() : cells_before_ + faces_.face_count();
    if (tuples != expected) {
      const char* what = of_points ? "points" : "cells";
      file_.notes.push_back(
          fmt::format("Values of the {} were passed over: the array '{:.60}' has {} values for {} {}.", what, name,
                      tuples, expected, what));
      return;
    }
    if (!of_points) numbers = of_faces(std::move(numbers), components);
    if (is_colour && of_points)
      add_colours(file_, colours_of(numbers, components));
    else if (is_colour)
      put_face_colours(file_, faces_, colours_of(numbers, components));
    else if (of_points)
      file_.vertex_attributes[name] = {attribute_type(of.number), std::move(numbers)};
    else
      file_.triangle_attributes[name] = {attribute_type(of.number), faces_.of_triangles(numbers)};
  }

  // Cells are numbered by kind: points, lines, polygons, strips, whichever way the kinds stand in the file.
  std::vector<double> of_faces(std::vector<double> of_cells, std::uint64_t components) const {
    of_cells.erase(of_cells.begin(), of_cells.begin() + static_cast<std::ptrdiff_t>(cells_before_ * components));
    if (strips_first_)
      std::rotate(of_cells.begin(), of_cells.end() - static_cast<std::ptrdiff_t>(strips_ * components), of_cells.end());
    return of_cells;
  }

  TextCursor cursor_;
  bool binary_ = false;
  enum class ValuesOf { file, points, cells } values_of_ = ValuesOf::file;
  std::uint64_t tuples_ = 0, cells_before_ = 0, strips_ = 0;
  bool has_cells_ = false, strips_first_ = false;
  FaceList faces_;
  MeshFile file_;
};

}  // namespace

MeshFile read_vtk(std::string_view bytes) { return VtkReader(bytes).read(); }

}  // namespace rhizodont
