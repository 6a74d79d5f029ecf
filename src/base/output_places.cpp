// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/output_places.hpp"

#include "base/held_signals.hpp"
#include "base/staged_file.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <tuple>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? std::optional(status) : std::nullopt;
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// The number of the own open file that a path such as /proc/self/fd/1 stands for.
std::optional<int> own_descriptor(const fs::path& path) {
  std::error_code failure;
  const fs::path own = fs::canonical("/proc/self/fd", failure);
  if (failure || fs::canonical(folder_of(path), failure) != own || failure) return std::nullopt;
  const std::string name = path.filename().string();
  int number = -1;
  const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (wrong != std::errc() || end != name.data() + name.size() || number < 0) return std::nullopt;
  return number;
}

struct LinkEnd {
  fs::path path;
  bool over_links = false;
  std::optional<int> descriptor;
};

/// Where a path leads over links, also where the last one leads to nothing. Nothing for a circle of links.
std::optional<LinkEnd> end_of_links(fs::path path) {
  constexpr int most_links = 40;  // as the kernel
  for (int links = 0; links < most_links; ++links) {
    if (const auto descriptor = own_descriptor(path)) return LinkEnd{path, links > 0, descriptor};
    std::error_code failure;
    if (!fs::is_symlink(fs::symlink_status(path, failure))) return LinkEnd{path, links > 0, {}};
    const fs::path next = fs::read_symlink(path, failure);
    if (failure) return LinkEnd{path, links > 0, {}};
    path = next.is_absolute() ? next : folder_of(path) / next;
  }
  return std::nullopt;
}

std::vector<fs::path> missing_folders(fs::path folder) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  while (!folder.empty() && !fs::exists(fs::symlink_status(folder, ignored))) {
    if (folder.has_filename() && folder.filename() != ".") missing.push_back(folder);
    folder = folder.parent_path();
  }
  std::reverse(missing.begin(), missing.end());
  return missing;
}

/// A path as the user knows it: the program's own streams by what they are called.
std::string shown(const fs::path& path) {
  const auto end = end_of_links(path);
  if (end && end->descriptor == STDIN_FILENO) return "standard input";
  if (end && end->descriptor == STDOUT_FILENO) return "standard output";
  return path.string();
}

[[noreturn]] void refuse(const fs::path& given, const std::string& why) {
  throw OutputError(fmt::format("{} cannot be written: {}. What was there before is unchanged.", given.string(), why));
}

/// What a name stands for: a file that is there by device and number, one that is not there yet by its place.
using Identity = std::tuple<dev_t, ino_t, std::string>;

/// Equal for two names exactly if writing the one would change the other. Nothing for devices, which keep nothing.
std::optional<Identity> identity_of(const fs::path& path) {
  const auto of_file = [](const struct stat& there) {
    return S_ISCHR(there.st_mode) ? std::nullopt : std::optional(Identity{there.st_dev, there.st_ino, {}});
  };
  if (const auto there = status_of(path)) return of_file(*there);
  const auto end = end_of_links(path);
  const fs::path place = fs::absolute(end ? end->path : path);
  std::error_code failure;
  fs::path canonical = fs::weakly_canonical(place, failure);
  if (failure) canonical = place.lexically_normal();
  // new/../file is there once the folder `new` is made
  if (const auto there = status_of(canonical)) return of_file(*there);
  return Identity{0, 0, canonical.string()};
}

}  // namespace

OutputPlace find_output_place(const fs::path& path) {
  if (path.empty()) throw UsageError("A file to be written has no name.");
  OutputPlace place;
  place.given = place.target = path;
  const auto end = end_of_links(path);
  if (!end) throw_unwritable(place, ELOOP);
  place.target = end->path;
  place.descriptor = end->descriptor;
  place.there = status_of(path);
  if (place.descriptor) return place;
  if (!place.target.has_filename() || (place.there && S_ISDIR(place.there->st_mode))) throw_unwritable(place, EISDIR);
  if (place.there && S_ISBLK(place.there->st_mode)) refuse(path, "this is a whole disk, not a file");
  if (place.there && S_ISREG(place.there->st_mode)) {
    const int denied = euidaccess(place.target.c_str(), W_OK) != 0 ? errno : 0;
    if (denied == EROFS) throw_unwritable(place, EROFS);
    // Who protects a file from writing means it, also where root could replace it.
    if (denied != 0 || (place.there->st_mode & 0222) == 0) refuse(path, "the file that is there is write-protected");
  }
  place.missing_folders = missing_folders(place.target.parent_path());
  if (!place.missing_folders.empty() && end->over_links)
    refuse(path, fmt::format("the link leads into the folder {}, which is not there", folder_of(end->path).string()));
  return place;
}

std::string why_unwritable(const OutputPlace& place, int error) {
  const std::string folder = folder_of(place.target).string();
  switch (error) {
    case ENOSPC:
      return "there is no room left on the disk";
    case EDQUOT:
      return "your share of the disk is used up";
    case EROFS:
      return fmt::format("the disk of the folder {} can only be read", folder);
    case EACCES:
    case EPERM:
      return fmt::format("you have no right to write there (folder {})", folder);
    case ENOENT:
      return fmt::format("there is no folder {}", folder);
    case ENOTDIR:
      return fmt::format("a part of the folder's name {} is a file", folder);
    case EEXIST:
      return "a file of this name has appeared there meanwhile";
    case EISDIR:
      return "this is a folder, not a file";
    case EFBIG:
      return "it is larger than a file may become here";
    case EPIPE:
      return "nobody reads the other end of the pipe";
    case ENAMETOOLONG:
      return "the name is longer than the disk allows";
    case ELOOP:
      return "its links lead in a circle";
    case EINTR:
      return "the program was stopped";
    case EIO:
      return "the disk reports a fault";
    case EBADF:
      return "it is not open";
    default:
      return std::strerror(error);
  }
}

void throw_unwritable(const OutputPlace& place, int error) { refuse(place.given, why_unwritable(place, error)); }

void require_writable_place(const fs::path& path) {
  OutputPlace place = find_output_place(path);
  if (!place.is_regular_file()) return;
  if (!place.missing_folders.empty()) {  // then it is enough that the first of them could be made
    place.target = place.missing_folders.front();
    place.there.reset();
  }
  const HeldSignals held;  // one that comes now ends the program once the file made for the trial is gone
  StagedFile{place};
}

void require_separate_files(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  std::map<Identity, fs::path> read, written;
  for (const fs::path& input : inputs) {
    const auto there = status_of(input);
    if (there && S_ISSOCK(there->st_mode)) continue;  // its two directions are separate
    if (const auto identity = identity_of(input)) read.emplace(*identity, input);
  }
  for (const fs::path& output : outputs) {
    const auto identity = identity_of(output);
    if (!identity) continue;
    if (const auto same = read.find(*identity); same != read.end())
      throw UsageError(
          fmt::format("{} would be written over {}, which is read: it is the same file. Give the result another name.",
                      shown(output), shown(same->second)));
    const auto [same, is_new] = written.emplace(*identity, output);
    if (!is_new && is_standard_output(output) && is_standard_output(same->second))
      throw UsageError("Standard output takes one result only: give the others a file.");
    if (!is_new)
      throw UsageError(fmt::format("{} and {} are the same file: each result needs a name of its own.",
                                   shown(same->second), shown(output)));
  }
}

bool is_stream(const fs::path& path) {
  const auto end = end_of_links(path);
  const auto there = status_of(path);
  return end && (end->descriptor || (there && !S_ISREG(there->st_mode) && !S_ISDIR(there->st_mode)));
}

bool is_standard_output(const fs::path& path) {
  const auto end = end_of_links(path);
  return end && end->descriptor == STDOUT_FILENO;
}

}  // namespace rhizodont
