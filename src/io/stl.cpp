// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// STL as written by scanners and CAD programs: 80 bytes of anything, a count, 50 bytes per triangle; or text.
#include "io/cursors.hpp"
#include "io/formats.hpp"
#include "mesh/geometry.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <unordered_map>

namespace rhizodont {
namespace {

constexpr std::size_t header_size = 84, record_size = 50;

// Numbers corners by first appearance; corners with equal coordinates are one vertex.
class Welder {
 public:
  explicit Welder(std::size_t triangle_count) { numbers_.reserve(triangle_count / 2 + 16); }

  std::int32_t number(const std::array<float, 3>& corner, TriangleMesh& mesh) {
    Key key{};
    for (std::size_t i = 0; i < 3; ++i) key[i] = std::bit_cast<std::uint32_t>(corner[i] + 0.0F);  // -0 becomes +0
    const auto [place, fresh] = numbers_.try_emplace(key, static_cast<std::int32_t>(mesh.vertices.size()));
    if (fresh) mesh.vertices.emplace_back(corner[0], corner[1], corner[2]);
    return place->second;
  }

 private:
  using Key = std::array<std::uint32_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 0;
      for (const std::uint32_t part : key) {
        h = (h ^ part) * 0x9e3779b97f4a7c15ULL;
        h ^= h >> 29;
      }
      return h;
    }
  };
  std::unordered_map<Key, std::int32_t, Hash> numbers_;
};

void require_finite_corner(const std::array<float, 3>& corner, std::int64_t triangle) {
  for (const float x : corner)
    if (!std::isfinite(x))
      throw InputError(
          fmt::format("triangle {} (counted from 0) has a coordinate that is not a finite number", triangle),
          {triangle});
}

MeshFile read_binary(std::string_view bytes, std::size_t count) {
  MeshFile file;
  file.mesh.triangles.reserve(count);
  Welder welder(count);
  ByteCursor cursor(bytes, std::endian::little);
  cursor.skip(header_size);
  for (std::size_t t = 0; t < count; ++t) {
    cursor.skip(12);
    Triangle& triangle = file.mesh.triangles.emplace_back();
    for (std::int32_t& v : triangle) {
      std::array<float, 3> corner{};
      for (float& x : corner) x = cursor.read<float>();
      require_finite_corner(corner, static_cast<std::int64_t>(t));
      v = welder.number(corner, file.mesh);
    }
    cursor.skip(2);
  }
  return file;
}

bool same_word(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + ('a' - 'A') : a) == b; });
}

class AsciiReader {
 public:
  explicit AsciiReader(std::string_view text) : cursor_(text), welder_(text.size() / 200) {}

  MeshFile read() {
    while (const auto word = cursor_.word()) {
      if (same_word(*word, "solid") || same_word(*word, "endsolid"))
        cursor_.rest_of_line();  // a name, of any number of words
      else if (same_word(*word, "facet"))
        read_facet();
      else
        fail(*word, "facet");
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
    throw InputError(fmt::format("line {}: '{}' is expected, '{:.30}' was found", cursor_.line(), expected, found),
                     {cursor_.line()});
  }

  std::string_view next_word() {
    const auto word = cursor_.word();
    if (!word)
      throw InputError(fmt::format("line {}: the file ends in the middle of a triangle", cursor_.line()),
                       {cursor_.line()});
    return *word;
  }

  void expect(std::string_view expected) {
    const std::string_view word = next_word();
    if (!same_word(word, expected)) fail(word, expected);
  }

  void read_facet() {
    expect("normal");
    for (int i = 0; i < 3; ++i) next_word();  // not used: many files hold zeros or "nan" here
    expect("outer");
    expect("loop");
    Triangle triangle{};
    for (std::int32_t& v : triangle) {
      expect("vertex");
      v = welder_.number(read_corner(), file_.mesh);
    }
    expect("endloop");
    expect("endfacet");
    file_.mesh.triangles.push_back(triangle);
  }

  std::array<float, 3> read_corner() {
    std::array<float, 3> corner{};
    for (float& x : corner) {
      const std::string_view word = next_word();
      const auto value = parse_number<float>(word);
      if (!value) fail(word, "a number");
      if (!std::isfinite(*value))
        throw InputError(fmt::format("line {}: a coordinate is not a finite number", cursor_.line()), {cursor_.line()});
      x = *value;
    }
    return corner;
  }

  TextCursor cursor_;
  Welder welder_;
  MeshFile file_;
};

// Many binary files begin with "solid" too: text has no zero bytes and goes on with a keyword.
bool looks_like_text(std::string_view bytes) {
  TextCursor cursor(bytes);
  const auto first = cursor.word();
  if (!first || !same_word(*first, "solid")) return false;
  const std::string_view start = bytes.substr(0, 4096);
  if (start.find('\0') != std::string_view::npos) return false;
  cursor.rest_of_line();
  const auto keyword = cursor.word();
  return !keyword || same_word(*keyword, "facet") || same_word(*keyword, "endsolid");
}

template <class T>
void append(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

}  // namespace

MeshFile read_stl(std::string_view bytes) {
  std::size_t count = 0;
  if (bytes.size() >= header_size) {
    ByteCursor cursor(bytes, std::endian::little);
    cursor.skip(80);
    count = cursor.read<std::uint32_t>();
    if (bytes.size() == header_size + record_size * count) return read_binary(bytes, count);
  }
  if (looks_like_text(bytes)) return AsciiReader(bytes).read();
  if (bytes.size() < header_size) throw InputError("the file is too short for an STL file: it is damaged or cut off");
  const std::size_t present = (bytes.size() - header_size) / record_size;
  throw InputError(
      fmt::format("the file is damaged or cut off: it announces {} triangles and has room for {}", count, present));
}

std::string write_stl(const MeshFile& file) {
  const TriangleMesh& mesh = file.mesh;
  if (!coordinates_fit_float(mesh))
    throw UsageError(
        "STL files hold single precision only, and this mesh has coordinates that need double; use PLY or OBJ");
  std::string bytes = "Rhizodont, millimetres";
  bytes.resize(80, ' ');
  bytes.reserve(header_size + record_size * mesh.triangles.size());
  append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3f normal = triangle_normal(mesh, t).cast<float>();
    for (int i = 0; i < 3; ++i) append(bytes, normal[i]);
    for (const std::int32_t v : mesh.triangles[t])
      for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(mesh.vertices[static_cast<std::size_t>(v)][i]));
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace rhizodont
