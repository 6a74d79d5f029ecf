// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>

namespace rhizodont::serve {

/// What one service takes on at most, so that no request, however made, costs more than the machine has.
struct ServeLimits {
  std::size_t upload_bytes = std::size_t{64} << 20;  ///< of a scan's file; packed files unpack to 1 GiB at most
  std::size_t json_bytes = std::size_t{16} << 10;    ///< of a request's JSON
  std::size_t labels_bytes = std::size_t{16} << 20;  ///< of a file of labels
  std::size_t header_bytes = std::size_t{32} << 10;
  std::size_t triangles = 1'000'000;  ///< of a scan
  std::size_t parallel_jobs = 2;      ///< computed at the same time
  std::size_t waiting_jobs = 8;       ///< further jobs are refused
  std::size_t kept_scans = 16;        ///< further ones take the place of the one that was not asked for the longest
  std::size_t kept_jobs = 16;         ///< likewise
  std::size_t remembered_arches = 3;  ///< scans whose teeth are kept as far as the next question about them needs it
  std::size_t connections = 64;       ///< at the same time; others wait
  std::size_t uploads = 4;            ///< at the same time; others are refused
  std::size_t event_streams = 24;     ///< at the same time; others are refused
  std::chrono::seconds job_time{300};
  std::chrono::seconds request_time{10};  ///< for a request's head; its body has 64 KiB more for each second more
  std::chrono::seconds answer_time{60};   ///< for taking an answer
  std::chrono::seconds stall_time{10};    ///< without a byte taken of an answer
  std::chrono::seconds events_time{50};   ///< for which events are sent; browsers then ask again by themselves
  std::chrono::seconds expiry{1800};      ///< without being asked for, after which scans and jobs are forgotten
};

}  // namespace rhizodont::serve
