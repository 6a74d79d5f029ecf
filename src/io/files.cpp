// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/attribute_types.hpp"
#include "io/formats.hpp"
#include "mesh/float_bits.hpp"
#include "mesh/mesh_checks.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
  return extension;
}

using Writer = std::string (*)(const MeshFile&);

template <class Function>
Function function_for(const fs::path& path, const std::map<std::string, Function>& known, const char* verb) {
  const auto place = known.find(lower_extension(path));
  if (place != known.end()) return place->second;
  std::string names;
  for (const auto& [name, function] : known) names += (names.empty() ? "" : ", ") + name;
  throw UsageError(fmt::format("{}: only files named {} can be {}", path.string(), names, verb));
}

Writer writer_for(const fs::path& path) {
  static const std::map<std::string, Writer> writers{
      {".ply", write_ply}, {".stl", write_stl}, {".obj", write_obj}, {".glb", write_glb}};
  return function_for(path, writers, "written");
}

bool holds_exactly(const VertexAttribute& attribute) {
  return with_attribute_type(attribute.type, [&](auto kind) {
    using Number = decltype(kind);
    if constexpr (std::is_floating_point_v<Number>) return true;
    return std::all_of(attribute.values.begin(), attribute.values.end(), [](double x) {
      return x == std::floor(x) && x >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
             x <= static_cast<double>(std::numeric_limits<Number>::max());
    });
  });
}

// A file descriptor that is closed, and its file removed unless it was kept.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) {
    static std::atomic<unsigned> counter{0};
    for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
      path_ = target.parent_path() / fmt::format(".{}.{}.{}.tmp", target.filename().string(), getpid(), counter++);
      descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail(target);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (descriptor_ >= 0) close(descriptor_);
    if (!moved_) unlink(path_.c_str());
  }

  void write_and_move(const std::string& bytes, const fs::path& target) {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t count = write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(target);
      done += static_cast<std::size_t>(count);
    }
    if (fsync(descriptor_) != 0 && errno != EINVAL) fail(target);
    const int descriptor = std::exchange(descriptor_, -1);
    if (close(descriptor) != 0 || std::rename(path_.c_str(), target.c_str()) != 0) fail(target);
    moved_ = true;
  }

  [[noreturn]] static void fail(const fs::path& target) {
    throw InputError(fmt::format("{}: the file cannot be written: {}", target.string(), std::strerror(errno)));
  }

 private:
  fs::path path_;
  int descriptor_ = -1;
  bool moved_ = false;
};

/// The file that a path leads to, over links. Throws InputError for a folder.
fs::path target_behind(const fs::path& path) {
  fs::path target = path;
  std::error_code ignored;
  if (fs::is_symlink(target, ignored) && fs::exists(target, ignored)) target = fs::canonical(target);
  if (fs::is_directory(target, ignored))
    throw InputError(fmt::format("{}: this is a folder, not a file", path.string()));
  return target;
}

bool is_pipe_or_device(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_regular_file(path, ignored);
}

}  // namespace

bool coordinates_fit_float(const TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const Point& p) { return is_float(p.x()) && is_float(p.y()) && is_float(p.z()); });
}

void require_writable(const MeshFile& file) {
  if (file.mesh.triangles.empty()) throw InputError("a mesh without triangles is not written");
  require_valid_indices(file.mesh);
  require_finite(file.mesh.vertices);
  for (const auto& [name, attribute] : file.vertex_attributes) {
    if (attribute.values.size() != file.mesh.vertices.size())
      throw InputError(fmt::format("the attribute '{}' has {} values for {} vertices", name, attribute.values.size(),
                                   file.mesh.vertices.size()));
    if (!holds_exactly(attribute))
      throw InputError(fmt::format("the attribute '{}' has values that its type of number cannot hold", name));
    if (name.empty() || name.find_first_of(" \t\r\n") != std::string::npos)
      throw InputError(fmt::format("'{}' is no name for an attribute", name));
  }
  for (const std::string& comment : file.comments)
    if (comment.find_first_of("\r\n") != std::string::npos) throw InputError("a comment in a file is one line");
}

void require_savable(const std::filesystem::path& path) {
  writer_for(path);
  require_writable_place(path);
}

void save_mesh(const std::filesystem::path& path, const MeshFile& file) {
  const Writer writer = writer_for(path);
  require_writable(file);
  write_file_atomically(path, writer(file));
}

void require_writable_place(const std::filesystem::path& path) {
  const fs::path target = target_behind(path);
  if (!is_pipe_or_device(target)) TemporaryFile{target};
}

void write_file_atomically(const std::filesystem::path& path, const std::string& bytes) {
  const fs::path target = target_behind(path);
  if (is_pipe_or_device(target)) {
    // It must not be replaced by a file.
    std::ofstream stream(target, std::ios::binary);
    if (!stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush()) TemporaryFile::fail(target);
    return;
  }
  TemporaryFile(target).write_and_move(bytes, target);
}

}  // namespace rhizodont
