// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/temporary_folder.hpp"
#include "io/formats.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <string>

namespace rhizodont::test {

/// Numbers as bytes, for files made by hand.
class Bytes {
 public:
  explicit Bytes(std::string text = {}, std::endian order = std::endian::little)
      : bytes_(std::move(text)), order_(order) {}
  template <class T>
  Bytes& add(T value) {
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  Bytes& add_text(const std::string& text) {
    bytes_ += text;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
  std::endian order_;
};

/// Loads the bytes under the given name and expects an InputError whose sentence holds `words`.
inline void expect_refused(const std::string& name, const std::string& bytes, const std::string& words) {
  const TemporaryFolder folder;
  try {
    load_mesh(folder.write(name, bytes));
    FAIL() << name << ": accepted, expected: " << words;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what() << "\nshould hold: " << words;
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos)
        << "the file's name is missing: " << error.what();
  }
}

inline MeshFile load_bytes(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  return load_mesh(folder.write(name, bytes));
}

/// What `load_mesh` does once it has the bytes, for tests that try very many.
inline MeshFile parse(MeshFile (*reader)(std::string_view), const std::string& bytes) {
  MeshFile file = reader(bytes);
  finish_reading(file);
  return file;
}

/// Whether one of the reader's notes holds these words.
inline bool notes_hold(const MeshFile& file, const std::string& words) {
  return std::any_of(file.notes.begin(), file.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// Equal bits, with -0 and +0 told apart.
inline bool same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), [](const Point& p, const Point& q) {
           return std::equal(p.data(), p.data() + 3, q.data(), [](double x, double y) {
             return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
           });
         });
}

}  // namespace rhizodont::test
