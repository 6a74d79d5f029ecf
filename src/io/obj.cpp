// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: vertices, their colours, and faces; texture coordinates, normals, groups and materials are passed
// over.
#include "io/colours.hpp"
#include "io/cursors.hpp"
#include "io/face_list.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"

#include <fmt/core.h>

#include <iterator>

namespace rhizodont {
namespace {

class ObjReader {
 public:
  explicit ObjReader(std::string_view text) : cursor_(text) {}

  MeshFile read() {
    while (cursor_.remaining() > 0) {
      line_ = cursor_.line();
      TextCursor words(logical_line());
      const std::string_view keyword = words.word().value_or("");
      if (keyword == "v")
        read_vertex(words);
      else if (keyword == "f")
        read_face(words);
      else if (keyword == "#MRGB")
        has_painted_colours_ = true;
      else if (keyword == "vt" || keyword == "mtllib")
        (keyword == "vt" ? has_texture_places_ : has_materials_) = true;
    }
    require_vertices_exist();
    add_colours(file_, colours_);
    if (has_painted_colours_) file_.notes.push_back("The colours painted on the vertices (#MRGB) are not read.");
    if (has_texture_places_ && has_materials_) file_.notes.emplace_back(texture_note);
    faces_.move_to(file_);
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("line {}: {}", line_, what), {line_});
  }

  // A line that ends in a backslash goes on in the next one.
  std::string_view logical_line() {
    std::string_view line = cursor_.rest_of_line();
    if (line.empty() || line.back() != '\\') return line;
    joined_.clear();
    while (!line.empty() && line.back() == '\\') {
      joined_ += line.substr(0, line.size() - 1);
      joined_ += ' ';
      line = cursor_.rest_of_line();
    }
    return joined_ += line;
  }

  void read_vertex(TextCursor& words) {
    file_.mesh.vertices.push_back(read_coordinates(words, [&](const std::string& sentence) { fail(sentence); }));
    // "v x y z w" has a weight, "v x y z r g b" a colour
    std::array<double, 3> colour{};
    std::size_t found = 0;
    while (found < 3) {
      const auto value = parse_number<double>(words.word().value_or(""));
      if (!value) break;
      colour[found++] = *value;
    }
    if (found == 3) colours_.push_back(colour);
  }

  void read_face(TextCursor& words) {
    polygon_.clear();
    while (const auto word = words.word()) {
      if (word->front() == '#') break;
      const auto number = parse_number<std::int64_t>(word->substr(0, word->find('/')));
      if (!number) fail(fmt::format("'{:.30}' is not a vertex of a face", *word));
      // counted from 1, or backwards from the last vertex so far
      const auto count = static_cast<std::int64_t>(file_.mesh.vertices.size());
      const std::int64_t index = *number > 0 ? *number - 1 : count + *number;
      if (*number == 0 || index < 0) fail(fmt::format("vertex {} does not exist", *number));
      largest_ = std::max(largest_, std::pair(index, line_));
      polygon_.push_back(to_index(index));
    }
    if (polygon_.size() < 3) fail("a face needs three vertices");
    faces_.add_polygon(polygon_);
  }

  // Faces may stand before their vertices, so this can only be told at the end.
  void require_vertices_exist() {
    if (largest_.first < static_cast<std::int64_t>(file_.mesh.vertices.size())) return;
    line_ = largest_.second;
    fail(fmt::format("vertex {} does not exist, there are {}", largest_.first + 1, file_.mesh.vertices.size()));
  }

  TextCursor cursor_;
  std::int64_t line_ = 1;
  std::string joined_;
  std::vector<std::int32_t> polygon_;
  std::pair<std::int64_t, std::int64_t> largest_{-1, 0};  // vertex of a face, line
  std::vector<std::array<double, 3>> colours_;
  bool has_painted_colours_ = false, has_texture_places_ = false, has_materials_ = false;
  FaceList faces_;
  MeshFile file_;
};

}  // namespace

MeshFile read_obj(std::string_view bytes) { return ObjReader(bytes).read(); }

std::string write_obj(const MeshFile& file) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (const std::string& comment : file.comments) fmt::format_to(out, "# {}\n", comment);
  // The shortest digits that give the same double again, also for a number that is a float: readers then find the same
  // bits whether they keep it as float or as double.
  for (const Point& p : file.mesh.vertices) fmt::format_to(out, "v {} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : file.mesh.triangles) fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
  return text;
}

}  // namespace rhizodont
