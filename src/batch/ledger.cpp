// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/ledger.hpp"

#include "base/held_signals.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::uint64_t random_number() {
  std::uint64_t number = 0;
  while (getrandom(&number, sizeof number, 0) != sizeof number) {
  }
  return number;
}

std::int64_t seconds_since_1970() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

LedgerFile read_ledger(const fs::path& path) {
  LedgerFile file;
  file.run = path.stem().string();
  const std::string text = read_file_bytes(path);
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const Json line = Json::parse(rest.substr(0, end), nullptr, false);
    if (end != std::string_view::npos && line.is_object())
      file.lines.push_back(line);
    else
      ++file.unreadable;
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return file;
}

}  // namespace

BatchLedger::BatchLedger(const fs::path& batch, const BatchShard& shard) {
  std::error_code failure;
  const fs::path folder = batch / "ledger";
  path_ = folder;
  fs::create_directories(folder, failure);
  if (failure) fail(failure.value());
  do {
    run_ = fmt::format("{}.{:016x}", shard.name(), random_number());
    path_ = folder / (run_ + ".jsonl");
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(errno);
}

BatchLedger::~BatchLedger() {
  if (descriptor_ >= 0) close(descriptor_);
}

void BatchLedger::fail(int error) const {
  throw OutputError(fmt::format("The ledger {} cannot be written: {}.", path_.string(), std::strerror(error)));
}

void BatchLedger::append(std::vector<Json> lines) {
  std::string text;
  const std::int64_t time = seconds_since_1970();
  for (Json& line : lines) {
    line["time"] = time;
    text += line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  const HeldSignals held;  // a full disk is to be told, not to end the program
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t count = write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(errno);
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  while (fsync(descriptor_) != 0) {
    if (errno == EINVAL || errno == ENOTSUP) break;  // a file system without
    if (errno != EINTR) fail(errno);
  }
}

std::vector<LedgerFile> read_ledgers(const fs::path& batch) {
  std::vector<fs::path> paths;
  std::error_code failure;
  for (fs::directory_iterator entry(batch / "ledger", failure), end; !failure && entry != end; entry.increment(failure))
    if (entry->path().extension() == ".jsonl") paths.push_back(entry->path());
  std::sort(paths.begin(), paths.end());
  std::vector<LedgerFile> files;
  for (const fs::path& path : paths) files.push_back(read_ledger(path));
  return files;
}

std::string text_in(const Json& line, const char* name) {
  const auto entry = line.find(name);
  return entry != line.end() && entry->is_string() ? entry->get<std::string>() : std::string();
}

double number_in(const Json& line, const char* name) {
  const auto entry = line.find(name);
  return entry != line.end() && entry->is_number() ? entry->get<double>() : 0;
}

}  // namespace rhizodont
