// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Geomview OFF and its relatives with colours, normals or texture coordinates after the three coordinates.
#include "io/colours.hpp"
#include "io/cursors.hpp"
#include "io/face_list.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"

#include <fmt/core.h>

namespace rhizodont {
namespace {

class OffReader {
 public:
  explicit OffReader(std::string_view text) : cursor_(text) {}

  MeshFile read() {
    TextCursor counts = read_header();
    const std::int64_t vertex_count = count(counts, "vertices"), face_count = count(counts, "faces");
    // A vertex takes at least "0 0 0\n", a face "3 0 1 2\n": a header cannot make us allocate more than the file's own
    // size.
    require_room(vertex_count, 6, "vertices");
    file_.mesh.vertices.reserve(static_cast<std::size_t>(vertex_count));
    for (std::int64_t v = 0; v < vertex_count; ++v) read_vertex(v, vertex_count);
    require_room(face_count, 2, "faces");
    faces_.reserve(static_cast<std::size_t>(face_count));
    for (std::int64_t f = 0; f < face_count; ++f) read_face(f, face_count);
    read_faces_unannounced(face_count);
    add_colours(file_, colours_);
    if (has_face_colours_) file_.notes.emplace_back(triangle_colours_note);
    faces_.move_to(file_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("line {}: {}", line_, what), {line_});
  }

  // The next line that holds anything but a comment; nothing at the end of the file.
  std::optional<std::string_view> content_line() {
    while (cursor_.remaining() > 0) {
      line_ = cursor_.line();
      std::string_view line = cursor_.rest_of_line();
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(" \t\r\v\f") != std::string_view::npos) return line;
    }
    return std::nullopt;
  }

  // Returns the words of the line with the counts, which may be the header's own line, the header's own word
  // ("OFF492"), or all that there is of a header.
  TextCursor read_header() {
    const std::string_view first = content_line().value_or("");
    TextCursor words(first);
    const std::string_view keyword = words.word().value_or("");
    const std::size_t name = keyword.find_first_of("oO");
    if (name == std::string_view::npos && parse_number<std::int64_t>(keyword)) return TextCursor(first);
    const std::string_view from_name = keyword.substr(std::min(name, keyword.size()));
    if (!same_word(from_name.substr(0, 3), "off"))
      throw InputError("this is no OFF file: it does not begin with 'OFF'");
    const std::string_view prefix = keyword.substr(0, name);
    has_colours_ = same_word(prefix, "c");
    const std::string_view glued = from_name.substr(3);
    if (prefix == "n" && glued.empty()) {  // the number of coordinates stands before the counts
      TextCursor dimension = these_or_next_line(words);
      if (dimension.word() != "3") fail("only three-dimensional OFF files are read");
      return these_or_next_line(dimension);
    }
    if (prefix.find_first_of("4n") != std::string_view::npos) fail("only three-dimensional OFF files are read");
    if (!glued.empty()) return TextCursor(first.substr(static_cast<std::size_t>(glued.data() - first.data())));
    TextCursor rest = words;
    const auto second = rest.word();
    if (second && *second == "BINARY") fail("binary OFF files are not read; save it as text or as PLY");
    return these_or_next_line(words);
  }

  TextCursor these_or_next_line(TextCursor words) {
    if (TextCursor ahead = words; ahead.word()) return words;
    const auto line = content_line();
    if (!line) fail("the file ends within its header");
    return TextCursor(*line);
  }

  std::int64_t count(TextCursor& words, const char* what) const {
    const auto value = parse_number<std::int64_t>(words.word().value_or(""));
    if (!value || *value < 0) fail(fmt::format("the number of {} is missing", what));
    return *value;
  }

  void require_room(std::int64_t announced, std::size_t least_size, const char* what) const {
    const std::size_t room = (cursor_.remaining() + 1) / least_size;
    if (static_cast<std::uint64_t>(announced) > room)
      throw InputError(fmt::format("the file is damaged or cut off: it announces {} {} and has room for at most {}",
                                   announced, what, room));
  }

  TextCursor record(std::int64_t index, std::int64_t total, const char* what) {
    const auto line = content_line();
    if (!line)
      throw InputError(
          fmt::format("the file is cut off: it ends before {} {} of {} (counted from 0)", what, index, total), {index});
    return TextCursor(*line);
  }

  void read_vertex(std::int64_t index, std::int64_t total) {
    TextCursor words = record(index, total, "vertex");
    file_.mesh.vertices.push_back(read_coordinates(words, [&](const std::string& sentence) { fail(sentence); }));
    if (!has_colours_) return;
    std::array<double, 3> colour{};
    for (double& part : colour) {
      const auto value = parse_number<double>(words.word().value_or(""));
      if (!value) return;
      part = *value;
    }
    colours_.push_back(colour);
  }

  /// Counts are sometimes wrong: what follows is read, as long as it is faces.
  void read_faces_unannounced(std::int64_t announced) {
    std::int64_t more = 0;
    try {
      for (auto line = content_line(); line; line = content_line(), ++more) read_face(TextCursor(*line));
    } catch (const InputError&) {
      file_.notes.push_back(
          fmt::format("What follows the file's faces, from line {} on, is no face and was passed over.", line_));
    }
    if (more > 0)
      file_.notes.push_back(
          fmt::format("The file announces {} faces and holds {}: all were read.", announced, announced + more));
  }

  void read_face(std::int64_t index, std::int64_t total) { read_face(record(index, total, "face")); }

  void read_face(TextCursor words) {
    std::int64_t corners = count(words, "a face's vertices");
    polygon_.clear();
    for (; corners > 0; --corners) {
      const auto word = words.word();
      if (!word) fail("a face has fewer vertices than it announces");
      const auto v = parse_number<std::int64_t>(*word);
      if (!v) fail(fmt::format("'{:.30}' is not a vertex of a face", *word));
      if (*v < 0 || *v >= static_cast<std::int64_t>(file_.mesh.vertices.size()))
        fail(fmt::format("vertex {} does not exist", *v));
      polygon_.push_back(to_index(*v));
    }
    has_face_colours_ |= words.word().has_value();
    faces_.add_polygon(polygon_);
  }

  TextCursor cursor_;
  std::int64_t line_ = 1;
  std::vector<std::int32_t> polygon_;
  bool has_colours_ = false, has_face_colours_ = false;
  std::vector<std::array<double, 3>> colours_;
  FaceList faces_;
  MeshFile file_;
};

}  // namespace

MeshFile read_off(std::string_view bytes) { return OffReader(bytes).read(); }

}  // namespace rhizodont
