// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/output_places.hpp"

#include <sys/types.h>

#include <string>
#include <string_view>

namespace rhizodont {

/// A file that is written beside its place, without a name where the file system can do that, and then moved there.
/// Until it is kept, its end takes everything back. Functions throw OutputError unless they are noexcept.
class StagedFile {
 public:
  /// Makes the file; the folder must be there.
  explicit StagedFile(OutputPlace place);
  StagedFile(StagedFile&&) noexcept;
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  StagedFile& operator=(StagedFile&&) = delete;
  ~StagedFile();

  /// Puts the bytes on the disk, with mode and owner of the file that is to be replaced.
  void write(std::string_view bytes);

  /// Puts the file into place. What stood there is kept aside for `take_back`, unless this is the last of all moves:
  /// then nothing can fail any more, and the older file is replaced in one step.
  void move_into_place(bool is_last_move);

  /// The older file stands there again. False, with errno, if that failed.
  bool take_back() noexcept;

  /// After a failed `take_back`: what is left where, and why. `error`: of errno.
  std::string what_is_left(int error) const;

  /// The older file, if it was kept aside, is given up.
  void keep() noexcept;

 private:
  enum class State { staged, created, replaced_last, replaced, done };

  [[noreturn]] void fail(int error) const;
  mode_t mode() const;  // never wider than the older file's, also before it has its owner
  void open_named();
  void give_name();
  bool create();
  void replace();
  std::string set_older_aside() const;

  OutputPlace place_;
  std::string name_;     // in the folder
  int folder_ = -1;      // open
  int descriptor_ = -1;  // open
  std::string aside_;    // hidden name beside the place: of this file before the move, of the older one after it
  State state_ = State::staged;
  bool older_is_aside_ = false;  // and could not be put back
};

}  // namespace rhizodont
