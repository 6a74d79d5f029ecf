// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "doctor/machine.hpp"

#include <CGAL/version.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <openssl/crypto.h>
#include <sched.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>
#include <zlib.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>

namespace rhizodont::doctor {
namespace {

constexpr double bytes_per_mb = 1024 * 1024;

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Nothing where the file is missing or says "max".
std::optional<double> number_in_file(const fs::path& path) {
  const std::string text = text_of_file(path);
  double number = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc() && end != text.data() ? std::optional(number) : std::nullopt;
}

/// The control group (version 2) that this process is in and those around it: the limits of all of them count.
std::vector<fs::path> control_groups(const fs::path& root) {
  std::istringstream lines(text_of_file(root / "proc/self/cgroup"));
  fs::path own;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("0::/")) own = line.substr(4);
  // A group outside of what the container may see: all that can be read is the outermost one.
  if (std::find(own.begin(), own.end(), "..") != own.end()) own.clear();
  const fs::path outermost = root / "sys/fs/cgroup";
  std::vector<fs::path> groups;
  for (; !own.empty(); own = own.parent_path()) groups.push_back(outermost / own);
  groups.push_back(outermost);
  return groups;
}

/// What a group holds and could not give back: files that were not used of late are let go when memory is wanted.
double held_bytes(const fs::path& group) {
  const double held = number_in_file(group / "memory.current").value_or(0);
  std::istringstream lines(text_of_file(group / "memory.stat"));
  double bytes = 0;
  for (std::string name; lines >> name >> bytes;)
    if (name == "inactive_file") return std::max(held - bytes, 0.0);
  return held;
}

int allowed_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

}  // namespace

std::optional<double> meminfo_mb(std::string_view meminfo, std::string_view name) {
  while (!meminfo.empty()) {
    const std::size_t end = std::min(meminfo.find('\n'), meminfo.size());
    std::string_view line = meminfo.substr(0, end);
    meminfo.remove_prefix(std::min(end + 1, meminfo.size()));
    if (!line.starts_with(name) || line.substr(name.size()).empty() || line[name.size()] != ':') continue;
    line.remove_prefix(name.size() + 1);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    double kib = 0;
    const auto [stop, failure] = std::from_chars(line.data(), line.data() + line.size(), kib);
    if (failure == std::errc()) return kib / 1024;
  }
  return std::nullopt;
}

Machine this_machine(const fs::path& root) {
  Machine machine;
  machine.processors = allowed_processors();
  machine.threads = tbb::this_task_arena::max_concurrency();
  const std::string meminfo = text_of_file(root / "proc/meminfo");
  machine.memory_mb = meminfo_mb(meminfo, "MemTotal").value_or(0);
  machine.free_memory_mb = meminfo_mb(meminfo, "MemAvailable").value_or(0);
  for (const fs::path& group : control_groups(root)) {
    const std::optional<double> most = number_in_file(group / "memory.max");
    if (!most) continue;
    machine.memory_mb = std::min(machine.memory_mb, *most / bytes_per_mb);
    machine.free_memory_mb = std::clamp((*most - held_bytes(group)) / bytes_per_mb, 0.0, machine.free_memory_mb);
  }
#if defined(__x86_64__)
  machine.has_fused_multiply_add = __builtin_cpu_supports("fma") != 0;
#endif
  return machine;
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"g++", __VERSION__},
          {"glibc", gnu_get_libc_version()},
          {"oneTBB", TBB_runtime_version()},
          {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"CGAL", CGAL_VERSION_STR},
          {"OpenSSL", OpenSSL_version(OPENSSL_VERSION_STRING)},
          {"zlib", zlibVersion()},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)}};
}

}  // namespace rhizodont::doctor
