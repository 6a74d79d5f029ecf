// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/zip.hpp"

#include <zip.h>

#include <memory>
#include <stdexcept>

namespace rhizodont::serve {
namespace {

constexpr zip_uint16_t fixed_time = 0, fixed_date = (0 << 9) | (1 << 5) | 1;  // 1980-01-01, where ZIP's dates begin

[[noreturn]] void fail(zip_t* archive) {
  const std::string reason = zip_strerror(archive);
  zip_discard(archive);
  throw std::runtime_error("the ZIP archive cannot be made: " + reason);
}

}  // namespace

std::string zip_bytes(const std::vector<OutputFile>& files) {
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, decltype(&zip_source_free)> memory(
      zip_source_buffer_create(nullptr, 0, 0, &error), &zip_source_free);
  if (!memory) throw std::runtime_error("the ZIP archive cannot be made: no memory");
  zip_t* archive = zip_open_from_source(memory.get(), ZIP_TRUNCATE, &error);
  if (archive == nullptr) throw std::runtime_error("the ZIP archive cannot be made: it cannot be opened");
  zip_source_keep(memory.get());  // the archive gives its own hold back when it is closed
  for (const OutputFile& file : files) {
    zip_source_t* content = zip_source_buffer(archive, file.bytes.data(), file.bytes.size(), 0);
    if (content == nullptr) fail(archive);
    const zip_int64_t place = zip_file_add(archive, file.path.filename().c_str(), content, ZIP_FL_ENC_UTF_8);
    if (place < 0) {
      zip_source_free(content);
      fail(archive);
    }
    zip_file_set_dostime(archive, static_cast<zip_uint64_t>(place), fixed_time, fixed_date, 0);
    zip_set_file_compression(archive, static_cast<zip_uint64_t>(place), ZIP_CM_DEFLATE, 1);
  }
  if (zip_close(archive) != 0) fail(archive);
  zip_stat_t stat;
  zip_stat_init(&stat);
  std::string bytes;
  if (zip_source_stat(memory.get(), &stat) != 0 || zip_source_open(memory.get()) != 0)
    throw std::runtime_error("the ZIP archive cannot be read back");
  bytes.resize(stat.size);
  const zip_int64_t count = zip_source_read(memory.get(), bytes.data(), bytes.size());
  zip_source_close(memory.get());
  if (count != static_cast<zip_int64_t>(bytes.size())) throw std::runtime_error("the ZIP archive cannot be read back");
  return bytes;
}

}  // namespace rhizodont::serve
