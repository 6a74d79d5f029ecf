// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/staged_file.hpp"

#include "base/held_signals.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace rhizodont {
namespace {

/// Short, so that it is possible beside any name; hidden; of nobody else.
std::string hidden_name() {
  std::uint64_t number = 0;
  while (getrandom(&number, sizeof number, 0) != sizeof number) {
  }
  return fmt::format(".rhizodont-{:016x}", number);
}

std::string path_of_descriptor(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

}  // namespace

StagedFile::StagedFile(OutputPlace place) : place_(std::move(place)), name_(place_.target.filename().string()) {
  const auto folder = place_.target.has_parent_path() ? place_.target.parent_path() : std::filesystem::path(".");
  folder_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0 && errno == EACCES) folder_ = open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) fail(errno);
  // A name that the disk does not take is to be found out before the work; O_TMPFILE would not see it.
  struct stat ignored {};
  if (fstatat(folder_, name_.c_str(), &ignored, AT_SYMLINK_NOFOLLOW) != 0 && errno == ENAMETOOLONG) {
    close(std::exchange(folder_, -1));
    fail(ENAMETOOLONG);
  }
  descriptor_ = openat(folder_, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, mode());
  if (descriptor_ >= 0 && access(path_of_descriptor(descriptor_).c_str(), F_OK) == 0) return;
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));  // without /proc it could not get a name
  open_named();
}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : place_(std::move(other.place_)),
      name_(std::move(other.name_)),
      folder_(std::exchange(other.folder_, -1)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      aside_(std::exchange(other.aside_, {})),
      state_(std::exchange(other.state_, State::done)) {}

StagedFile::~StagedFile() {
  if (state_ != State::done) take_back();
  if (descriptor_ >= 0) close(descriptor_);
  if (folder_ >= 0) close(folder_);
}

void StagedFile::fail(int error) const { throw_unwritable(place_, error); }

mode_t StagedFile::mode() const { return place_.there ? place_.there->st_mode & 0777 : 0666; }

void StagedFile::open_named() {
  do {
    aside_ = hidden_name();
    descriptor_ = openat(folder_, aside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode());
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ >= 0) return;
  const int error = errno;
  close(std::exchange(folder_, -1));  // the destructor does not run
  fail(error);
}

void StagedFile::write(std::string_view bytes) {
  constexpr std::size_t at_once = 1 << 20;  // between two looks at the signals
  while (!bytes.empty()) {
    if (HeldSignals::noted()) fail(EINTR);
    const ssize_t count = ::write(descriptor_, bytes.data(), std::min(bytes.size(), at_once));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  if (place_.there) {
    // Only who may give files away can keep another's; the group alone is often possible.
    if (fchown(descriptor_, place_.there->st_uid, place_.there->st_gid) != 0 &&
        fchown(descriptor_, static_cast<uid_t>(-1), place_.there->st_gid) != 0)
      errno = 0;
    if (fchmod(descriptor_, place_.there->st_mode & 07777) != 0 && errno != EPERM) fail(errno);
  }
  while (fsync(descriptor_) != 0) {
    if (errno == EINVAL || errno == ENOTSUP) break;  // a file system without
    if (errno != EINTR) fail(errno);
  }
}

void StagedFile::give_name() {
  if (!aside_.empty()) return;
  const std::string source = path_of_descriptor(descriptor_);
  std::string name;
  do {
    name = hidden_name();
    if (linkat(AT_FDCWD, source.c_str(), folder_, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      aside_ = name;
      return;
    }
  } while (errno == EEXIST);
  fail(errno);
}

bool StagedFile::create() {
  if (aside_.empty()) {
    const std::string source = path_of_descriptor(descriptor_);
    if (linkat(AT_FDCWD, source.c_str(), folder_, name_.c_str(), AT_SYMLINK_FOLLOW) != 0) return false;
  } else if (renameat2(folder_, aside_.c_str(), folder_, name_.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno != EINVAL && errno != ENOSYS) return false;
    // A file system that cannot promise not to replace: the file was not there a moment ago.
    if (faccessat(folder_, name_.c_str(), F_OK, AT_SYMLINK_NOFOLLOW) == 0) {
      errno = EEXIST;
      return false;
    }
    if (renameat(folder_, aside_.c_str(), folder_, name_.c_str()) != 0) return false;
  }
  aside_.clear();
  state_ = State::created;
  return true;
}

std::string StagedFile::set_older_aside() const {
  std::string name = hidden_name();
  if (linkat(folder_, name_.c_str(), folder_, name.c_str(), 0) != 0 &&
      renameat(folder_, name_.c_str(), folder_, name.c_str()) != 0)
    fail(errno);
  return name;
}

void StagedFile::replace() {
  if (renameat2(folder_, aside_.c_str(), folder_, name_.c_str(), RENAME_EXCHANGE) == 0) {
    state_ = State::replaced;  // and the older file has this one's hidden name
    return;
  }
  if (errno != EINVAL && errno != ENOSYS) fail(errno);
  const std::string older = set_older_aside();
  if (renameat(folder_, aside_.c_str(), folder_, name_.c_str()) != 0) {
    const int error = errno;
    renameat(folder_, older.c_str(), folder_, name_.c_str());
    unlinkat(folder_, older.c_str(), 0);  // two names of one file are not renamed
    fail(error);
  }
  aside_ = older;
  state_ = State::replaced;
}

void StagedFile::move_into_place(bool is_last_move) {
  if (!place_.there) {
    if (!create()) fail(errno);
    return;
  }
  give_name();
  if (!is_last_move) return replace();
  if (renameat(folder_, aside_.c_str(), folder_, name_.c_str()) != 0) fail(errno);
  aside_.clear();
  state_ = State::replaced_last;
}

bool StagedFile::take_back() noexcept {
  const State state = std::exchange(state_, State::done);
  if (state == State::staged) return aside_.empty() || unlinkat(folder_, aside_.c_str(), 0) == 0;
  if (state == State::created) return unlinkat(folder_, name_.c_str(), 0) == 0;
  if (state != State::replaced) return true;
  older_is_aside_ = renameat(folder_, aside_.c_str(), folder_, name_.c_str()) != 0;
  return !older_is_aside_;
}

std::string StagedFile::what_is_left(int error) const {
  const std::string why = why_unwritable(place_, error);
  if (!older_is_aside_)
    return fmt::format("{} is incomplete and could not be taken away ({})", place_.given.string(), why);
  return fmt::format("what stood at {} is now {} ({})", place_.given.string(),
                     (place_.target.parent_path() / aside_).string(), why);
}

void StagedFile::keep() noexcept {
  if (state_ == State::replaced) unlinkat(folder_, aside_.c_str(), 0);
  state_ = State::done;
  fsync(folder_);  // the new name; a folder that cannot be synchronised is not worth a failure
}

}  // namespace rhizodont
