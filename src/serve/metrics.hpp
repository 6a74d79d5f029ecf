// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace rhizodont::serve {

/// What a service has done, counted.
class Metrics {
 public:
  /// @param route  as the description of the API has it; empty for none
  void count_request(const std::string& route, int status, double seconds);
  void count_job(const std::string& kind, const std::string& outcome, double seconds);

  /// Numbers that are read when they are asked for.
  struct Now {
    std::size_t scans = 0, jobs = 0, running = 0, waiting = 0, event_streams = 0;
    double uptime_seconds = 0;
  };

  /// Text for Prometheus (exposition format 0.0.4).
  std::string text(const Now& now) const;

 private:
  struct Sum {
    std::uint64_t count = 0;
    double seconds = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, int>, Sum> requests_;
  std::map<std::pair<std::string, std::string>, Sum> jobs_;
};

}  // namespace rhizodont::serve
