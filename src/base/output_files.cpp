// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/output_files.hpp"

#include "base/held_signals.hpp"
#include "base/output_places.hpp"
#include "base/staged_file.hpp"
#include "rhizodont/error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <ctime>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

/// Folders made for outputs; gone again, if nothing else came into them, unless they are kept.
class MadeFolders {
 public:
  MadeFolders() = default;
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;
  ~MadeFolders() {
    for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) rmdir(folder->c_str());
  }

  void make(const OutputPlace& place) {
    for (const fs::path& folder : place.missing_folders) {
      if (mkdir(folder.c_str(), 0777) == 0)
        made_.push_back(folder);
      else if (errno != EEXIST)  // another output's folder may be the same
        throw_unwritable(place, errno);
    }
  }

  void keep() { made_.clear(); }

 private:
  std::vector<fs::path> made_;
};

/// A descriptor that is closed at the end.
struct Descriptor {
  explicit Descriptor(int given) : number(given) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  int number;
};

constexpr int patience_ms = 50;  // between two looks at the signals

/// A pipe is opened once somebody reads it; until then a signal can end the waiting.
int open_stream(const OutputPlace& place) {
  if (place.descriptor) return fcntl(*place.descriptor, F_DUPFD_CLOEXEC, 0);
  while (true) {
    if (HeldSignals::noted()) throw_unwritable(place, EINTR);
    const int descriptor = open(place.target.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor >= 0 || (errno != EINTR && !(errno == ENXIO && S_ISFIFO(place.there->st_mode)))) return descriptor;
    const timespec pause{0, patience_ms * 1'000'000L};
    nanosleep(&pause, nullptr);
  }
}

void write_stream(const OutputPlace& place, std::string_view bytes) {
  const Descriptor stream(open_stream(place));
  if (stream.number < 0) throw_unwritable(place, errno);
  while (!bytes.empty()) {
    if (HeldSignals::noted()) throw_unwritable(place, EINTR);
    pollfd ready{stream.number, POLLOUT, 0};
    if (poll(&ready, 1, patience_ms) <= 0) continue;
    // No more than what a pipe that is ready takes without waiting.
    const ssize_t count = write(stream.number, bytes.data(), std::min<std::size_t>(bytes.size(), PIPE_BUF));
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) throw_unwritable(place, errno);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// Takes back what was moved; says so where even that fails.
void take_back(std::vector<StagedFile>& moved) {
  std::string left;
  for (auto file = moved.rbegin(); file != moved.rend(); ++file)
    if (!file->take_back()) left += (left.empty() ? "" : ", and ") + file->what_is_left(errno);
  if (!left.empty())
    throw OutputError("The results cannot be written, and not all could be put back as it was: " + left + ".");
}

}  // namespace

void write_output_files(const std::vector<OutputFile>& files) {
  const HeldSignals held;
  MadeFolders folders;
  std::vector<StagedFile> staged;
  std::vector<std::pair<OutputPlace, std::string_view>> streams;
  for (const OutputFile& file : files) {
    OutputPlace place = find_output_place(file.path);
    if (!place.is_regular_file()) {
      streams.emplace_back(std::move(place), file.bytes);
      continue;
    }
    folders.make(place);
    staged.emplace_back(std::move(place)).write(file.bytes);
  }
  // What went into a pipe cannot be taken back, but its failure still can keep all else as it was.
  for (const auto& [place, bytes] : streams) write_stream(place, bytes);
  if (HeldSignals::noted()) throw OutputError("The program was stopped before its results were written.");
  try {
    for (StagedFile& file : staged) file.move_into_place(&file == &staged.back());
  } catch (...) {
    take_back(staged);
    throw;
  }
  for (StagedFile& file : staged) file.keep();
  folders.keep();
}

}  // namespace rhizodont
