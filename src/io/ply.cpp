// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// PLY: G. Turk, "The PLY Polygon File Format", 1994; type names of both generations ("uchar" and "uint8").
#include "io/append_bytes.hpp"
#include "io/attribute_types.hpp"
#include "io/cursors.hpp"
#include "io/face_list.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

namespace rhizodont {
namespace {

struct Property {
  std::string name;
  AttributeType type = AttributeType::float32;  // of the number, or of a list's entries
  std::optional<AttributeType> count_type;      // set for a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::vector<std::string> comments;
  std::size_t size = 0;  // bytes
  std::int64_t line_count = 0;
};

std::optional<AttributeType> type_from_name(std::string_view name) {
  using enum AttributeType;
  static const std::map<std::string_view, AttributeType> types{
      {"char", int8},     {"int8", int8},       {"uchar", uint8},    {"uint8", uint8},
      {"short", int16},   {"int16", int16},     {"ushort", uint16},  {"uint16", uint16},
      {"int", int32},     {"int32", int32},     {"uint", uint32},    {"uint32", uint32},
      {"float", float32}, {"float32", float32}, {"double", float64}, {"float64", float64}};
  const auto place = types.find(name);
  if (place == types.end()) return std::nullopt;
  return place->second;
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : bytes_(bytes) {}

  Header read() {
    if (next_line() != "ply") throw InputError("this is no PLY file: it does not begin with 'ply'");
    bool has_format = false;
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
      TextCursor words(line);
      const std::string_view keyword = words.word().value_or("");
      if (keyword == "format") {
        read_format(words);
        has_format = true;
      } else if (keyword == "comment") {
        std::string_view text = words.rest_of_line();
        if (!text.empty()) text.remove_prefix(1);
        header_.comments.emplace_back(text);
      } else if (keyword == "element") {
        read_element(words);
      } else if (keyword == "property") {
        read_property(words);
      } else if (!keyword.empty() && keyword != "obj_info") {
        fail(fmt::format("'{:.30}' is not known in a PLY header", keyword));
      }
    }
    if (!has_format) fail("the header does not say the file's format");
    header_.size = place_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("line {}: {}", header_.line_count, what), {header_.line_count});
  }

  // Lines end as the first one does: after a header with CR alone, a body may begin with the byte of LF.
  std::string_view next_line() {
    if (header_.line_count == 0) {
      const std::size_t first_end = std::min(bytes_.find_first_of("\r\n"), bytes_.size());
      if (bytes_.substr(first_end, 1) == "\r" && bytes_.substr(first_end, 2) != "\r\n") line_end_ = '\r';
    }
    const std::size_t end = bytes_.find(line_end_, place_);
    ++header_.line_count;
    if (end == std::string_view::npos) fail("the file ends within its header");
    std::string_view line = bytes_.substr(place_, end - place_);
    place_ = end + 1;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }

  void read_format(TextCursor& words) {
    const std::string_view name = words.word().value_or("");
    if (name == "ascii")
      header_.encoding = Encoding::ascii;
    else if (name == "binary_little_endian")
      header_.encoding = Encoding::little_endian;
    else if (name == "binary_big_endian")
      header_.encoding = Encoding::big_endian;
    else
      fail(fmt::format("'{:.30}' is no format of PLY files", name));
  }

  void read_element(TextCursor& words) {
    Element element;
    element.name = words.word().value_or("");
    const auto count = parse_number<std::uint64_t>(words.word().value_or(""));
    if (element.name.empty() || !count) fail("an element needs a name and a count");
    element.count = *count;
    if (std::any_of(header_.elements.begin(), header_.elements.end(),
                    [&](const Element& e) { return e.name == element.name; }))
      fail(fmt::format("the element '{:.30}' is there twice", element.name));
    header_.elements.push_back(std::move(element));
  }

  void read_property(TextCursor& words) {
    if (header_.elements.empty()) fail("a property stands before the first element");
    const auto type_of = [&](std::string_view name) {
      const auto type = type_from_name(name);
      if (!type) fail(fmt::format("'{:.30}' is no type of number", name));
      return *type;
    };
    Property property;
    std::string_view word = words.word().value_or("");
    if (word == "list") {
      property.count_type = type_of(words.word().value_or(""));
      if (*property.count_type >= AttributeType::float32) fail("the length of a list must be an integer");
      word = words.word().value_or("");
    }
    property.type = type_of(word);
    property.name = words.word().value_or("");
    if (property.name.empty()) fail("a property needs a name");
    std::vector<Property>& properties = header_.elements.back().properties;
    if (std::any_of(properties.begin(), properties.end(), [&](const Property& p) { return p.name == property.name; }))
      fail(fmt::format("the property '{:.30}' is there twice", property.name));
    properties.push_back(std::move(property));
  }

  std::string_view bytes_;
  std::size_t place_ = 0;
  char line_end_ = '\n';
  Header header_;
};

// The numbers of the body, whatever their encoding. `next` returns nothing if the body ends first.
class Body {
  template <class Number>
  double parse(std::string_view word) const {
    if constexpr (std::is_floating_point_v<Number>) {
      if (const auto value = parse_number<Number>(word)) return static_cast<double>(*value);
    } else if (const auto value = parse_number<double>(word)) {
      // some programs write "3.0" for an integer
      if (*value == std::floor(*value) && *value >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
          *value <= static_cast<double>(std::numeric_limits<Number>::max()))
        return *value;
    }
    throw InputError(fmt::format("line {}: '{:.30}' is not a number of the announced type", words_.line(), word),
                     {words_.line()});
  }

 public:
  Body(std::string_view bytes, const Header& header)
      : ascii_(header.encoding == Encoding::ascii),
        words_(bytes, header.line_count + 1),
        numbers_(bytes, header.encoding == Encoding::big_endian ? std::endian::big : std::endian::little) {}

  bool is_ascii() const { return ascii_; }
  std::int64_t line() const { return words_.line(); }
  std::size_t remaining() const { return ascii_ ? words_.remaining() : numbers_.remaining(); }

  // How much is left, but for blanks and zeros at the end of a text.
  std::size_t unread() const {
    if (!ascii_) return numbers_.remaining();
    TextCursor rest = words_;
    const std::string_view text = rest.bytes(rest.remaining());
    const auto last = text.find_last_not_of(std::string_view(" \t\r\n\v\f\0\x1a", 8));
    return last == std::string_view::npos ? 0 : last + 1;
  }

  // Least number of bytes that a number takes (a digit and a space).
  std::size_t least_size(AttributeType type) const { return ascii_ ? 2 : byte_size(type); }

  std::optional<double> next(AttributeType type) {
    return with_attribute_type(type, [&](auto kind) -> std::optional<double> {
      using Number = decltype(kind);
      if (!ascii_) {
        if (numbers_.remaining() < sizeof(Number)) return std::nullopt;
        return static_cast<double>(numbers_.read<Number>());
      }
      const auto word = words_.word();
      if (!word) return std::nullopt;
      return parse<Number>(*word);
    });
  }

 private:
  bool ascii_;
  TextCursor words_;
  ByteCursor numbers_;
};

class BodyReader {
 public:
  BodyReader(std::string_view bytes, Header header)
      : header_(std::move(header)), body_(bytes.substr(header_.size), header_) {}

  MeshFile read() {
    file_.comments = header_.comments;
    if (std::any_of(header_.comments.begin(), header_.comments.end(),
                    [](const std::string& comment) { return comment.starts_with("TextureFile"); }))
      file_.notes.emplace_back(texture_note);
    for (const Element& element : header_.elements) {
      require_room(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        begin_face_attributes(element);
        read_corner_lists(element, [&](std::uint64_t) { faces_.add_polygon(corners_); });
        faces_with_attributes_ = faces_.face_count();
      } else if (element.name == "tristrips") {
        read_corner_lists(element, [&](std::uint64_t index) { add_strips(index); });
      } else {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) skip_record(element, i);
      }
    }
    if (const std::size_t rest = body_.unread(); rest > 0)
      file_.notes.push_back(
          fmt::format("After all that its header announces the file goes on for {} bytes, which were passed over: if "
                      "the crown is not "
                      "whole, the file is damaged.",
                      rest));
    give_face_attributes();
    faces_.move_to(file_);
    return std::move(file_);
  }

 private:
  // A header may lie: nothing is allocated for more elements than the rest of the file could hold.
  void require_room(const Element& element) const {
    std::uint64_t least = 0;
    for (const Property& property : element.properties)
      least += body_.least_size(property.count_type.value_or(property.type));
    if (least == 0 || element.count == 0) return;
    // the last number of an ASCII file needs no space after it
    const std::uint64_t room = (body_.remaining() + 1) / least;
    if (element.count > room)
      throw InputError(
          fmt::format("the file is damaged or cut off: it announces {} elements '{:.30}' and has room for at most {}",
                      element.count, element.name, room));
  }

  [[noreturn]] void fail_end(const Element& element, std::uint64_t index) const {
    throw InputError(
        fmt::format("the file is cut off: it ends in element {} of the {} '{:.30}' announced (counted from 0)", index,
                    element.count, element.name),
        {static_cast<std::int64_t>(index)});
  }

  double next(AttributeType type, const Element& element, std::uint64_t index) {
    const auto value = body_.next(type);
    if (!value) fail_end(element, index);
    return *value;
  }

  std::uint64_t list_length(const Property& property, const Element& element, std::uint64_t index) {
    const double count = next(*property.count_type, element, index);
    if (count < 0)
      throw InputError(fmt::format("element {} '{:.30}' has a list of negative length", index, element.name),
                       {static_cast<std::int64_t>(index)});
    if (count * static_cast<double>(body_.least_size(property.type)) > static_cast<double>(body_.remaining() + 1))
      fail_end(element, index);
    return static_cast<std::uint64_t>(count);
  }

  void skip_list(const Property& property, const Element& element, std::uint64_t index) {
    for (std::uint64_t k = list_length(property, element, index); k > 0; --k) next(property.type, element, index);
  }

  void skip_record(const Element& element, std::uint64_t index) {
    for (const Property& property : element.properties) {
      if (property.count_type)
        skip_list(property, element, index);
      else
        next(property.type, element, index);
    }
  }

  void read_vertices(const Element& element) {
    std::vector<double*> targets;
    Point point = Point::Zero();
    int coordinates = 0;
    std::vector<std::pair<std::size_t, VertexAttribute*>> attributes;
    std::vector<double> record(element.properties.size());
    std::array<std::size_t, 3> xyz{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      const std::size_t axis =
          property.name.size() == 1 ? std::string_view("xyz").find(property.name) : std::string_view::npos;
      if (property.count_type) continue;
      if (axis != std::string_view::npos) {
        xyz[axis] = p;
        coordinates |= 1 << axis;
      } else {
        VertexAttribute& attribute = file_.vertex_attributes[property.name];
        attribute = {property.type, {}};
        attribute.values.reserve(element.count);
        attributes.emplace_back(p, &attribute);
      }
    }
    if (coordinates != 7) throw InputError("the file's vertices have no x, y and z");
    file_.mesh.vertices.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < record.size(); ++p) {
        if (element.properties[p].count_type)
          skip_list(element.properties[p], element, i);
        else
          record[p] = next(element.properties[p].type, element, i);
      }
      point = {record[xyz[0]], record[xyz[1]], record[xyz[2]]};
      file_.mesh.vertices.push_back(point);
      for (const auto& [p, attribute] : attributes) attribute->values.push_back(record[p]);
    }
  }

  template <class Take>
  void read_corner_lists(const Element& element, const Take& take) {
    const bool has_corners = std::any_of(element.properties.begin(), element.properties.end(), is_corner_list);
    if (!has_corners && element.count > 0)
      throw InputError("the file's faces have no list of vertices" + instead(element));
    std::vector<std::vector<double>*> targets;  // per property, null where its values are not kept
    for (const Property& property : element.properties) {
      const auto place = property.count_type ? face_attributes_.end() : face_attributes_.find(property.name);
      targets.push_back(element.name != "face" || place == face_attributes_.end() ? nullptr : &place->second.values);
    }
    faces_.reserve(faces_.size() + element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < targets.size(); ++p) {
        const Property& property = element.properties[p];
        if (property.count_type && !is_corner_list(property)) {
          skip_list(property, element, i);
          continue;
        }
        if (!property.count_type) {
          const double value = next(property.type, element, i);
          if (targets[p] != nullptr) targets[p]->push_back(value);
          continue;
        }
        corners_.clear();
        for (std::uint64_t k = list_length(property, element, i); k > 0; --k)
          // -1 divides strips; what is no vertex stays none
          corners_.push_back(static_cast<std::int32_t>(
              std::clamp(next(property.type, element, i), -2.0, static_cast<double>(INT32_MAX))));
        take(i);
      }
    }
  }

  // One list holds any number of strips; -1 ends a strip.
  void add_strips(std::uint64_t index) {
    for (auto begin = corners_.begin(); begin != corners_.end();) {
      const auto end = std::find(begin, corners_.end(), -1);
      for (auto v = begin; v != end; ++v)
        if (static_cast<std::size_t>(*v) >= file_.mesh.vertices.size())
          throw InputError(fmt::format("strip {} (counted from 0) refers to a vertex that does not exist", index),
                           {static_cast<std::int64_t>(index)});
      faces_.add_strip({begin, end});
      begin = end == corners_.end() ? end : end + 1;
    }
  }

  void begin_face_attributes(const Element& element) {
    for (const Property& p : element.properties) {
      if (p.count_type) continue;
      face_attributes_[p.name] = {p.type, {}};
      face_attributes_[p.name].values.reserve(element.count);
    }
  }

  // Triangles of strips have no values; then none has.
  void give_face_attributes() {
    if (face_attributes_.empty()) return;
    if (faces_with_attributes_ != faces_.face_count()) {
      file_.notes.emplace_back("Values of the faces were passed over: the strips beside them have none.");
      return;
    }
    if (face_attributes_.contains("red") || face_attributes_.contains("diffuse_red"))
      file_.notes.emplace_back(triangle_colours_kept_note);
    for (auto& [name, attribute] : face_attributes_)
      file_.triangle_attributes[name] = {attribute.type, faces_.of_triangles(attribute.values)};
  }

  // What the faces have in place of a list of vertices.
  static std::string instead(const Element& element) {
    for (const Property& p : element.properties) {
      if (!p.count_type) continue;
      if (p.type >= AttributeType::float32 && is_corner_name(p.name))
        return fmt::format(": '{}' holds decimal numbers, not whole ones", p.name);
      return fmt::format(" (vertex_indices or vertex_index): their list is named '{:.30}'", p.name);
    }
    return {};
  }

  static bool is_corner_name(const std::string& name) { return name == "vertex_indices" || name == "vertex_index"; }

  static bool is_corner_list(const Property& property) {
    return property.count_type && property.type < AttributeType::float32 && is_corner_name(property.name);
  }

  Header header_;
  Body body_;
  std::vector<std::int32_t> corners_;
  std::map<std::string, VertexAttribute> face_attributes_;  // values per face of the file
  std::size_t faces_with_attributes_ = 0;
  FaceList faces_;
  MeshFile file_;
};

const char* name_of(AttributeType type) {
  static constexpr std::array names{"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  return names[static_cast<std::size_t>(type)];
}

void append(std::string& bytes, AttributeType type, double value) {
  with_attribute_type(type, [&](auto kind) { append_bytes(bytes, static_cast<decltype(kind)>(value)); });
}

}  // namespace

MeshFile read_ply(std::string_view bytes) { return BodyReader(bytes, HeaderReader(bytes).read()).read(); }

std::string write_ply(const MeshFile& file) {
  const TriangleMesh& mesh = file.mesh;
  const AttributeType real = coordinates_fit_float(mesh) ? AttributeType::float32 : AttributeType::float64;
  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : file.comments) bytes += "comment " + comment + "\n";
  bytes += fmt::format("element vertex {}\n", mesh.vertices.size());
  for (const char axis : {'x', 'y', 'z'}) bytes += fmt::format("property {} {}\n", name_of(real), axis);
  for (const auto& [name, attribute] : file.vertex_attributes)
    bytes += fmt::format("property {} {}\n", name_of(attribute.type), name);
  bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.triangles.size());
  for (const auto& [name, attribute] : file.triangle_attributes)
    bytes += fmt::format("property {} {}\n", name_of(attribute.type), name);
  bytes += "end_header\n";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    for (int i = 0; i < 3; ++i) append(bytes, real, mesh.vertices[v][i]);
    for (const auto& [name, attribute] : file.vertex_attributes) append(bytes, attribute.type, attribute.values[v]);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    append(bytes, AttributeType::uint8, 3);
    for (const std::int32_t v : mesh.triangles[t]) append(bytes, AttributeType::int32, v);
    for (const auto& [name, attribute] : file.triangle_attributes) append(bytes, attribute.type, attribute.values[t]);
  }
  return bytes;
}

}  // namespace rhizodont
