// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Reports, which `check --report` reads for what it excuses.
#include "fuzz/targets.hpp"
#include "rhizodont/report.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace rhizodont::test {
namespace {

/// Bytes that have a name, in memory.
class NamedBytes {
 public:
  explicit NamedBytes(std::string_view bytes) : file_(memfd_create("report", MFD_CLOEXEC)) {
    if (file_ < 0) throw std::system_error(errno, std::generic_category());
    if (write(file_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
      close(file_);
      throw std::system_error(errno, std::generic_category());
    }
  }
  NamedBytes(const NamedBytes&) = delete;
  NamedBytes& operator=(const NamedBytes&) = delete;
  ~NamedBytes() { close(file_); }

  std::string name() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

}  // namespace

bool fuzz_report(std::string_view bytes) {
  const NamedBytes file(bytes);
  bool taken = false;
  for (const std::vector<int>& file_vertices : {std::vector<int>{}, {0, 2, 3, 5}}) {
    ExcusedByReport excused;
    if (!is_taken([&] { excused = excused_by_report(file.name(), "ab", file_vertices); })) continue;
    for (const RepairStep& step : excused.repairs)
      require_rule(step.merged_into.empty() || step.merged_into.size() == step.vertices.size(),
                   "merged vertices without those that they were merged into");
    allowing_for(excused);
    taken = true;
  }
  return taken;
}

}  // namespace rhizodont::test
