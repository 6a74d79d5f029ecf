// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/metrics.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace rhizodont::serve {
namespace {

/// Bytes of the process in memory; 0 where the system does not say.
std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void gauge(std::string& text, const char* name, const char* help, double value) {
  fmt::format_to(std::back_inserter(text), "# HELP {0} {1}\n# TYPE {0} gauge\n{0} {2}\n", name, help, value);
}

void heading(std::string& text, const char* name, const char* help) {
  fmt::format_to(std::back_inserter(text), "# HELP {0} {1}\n# TYPE {0} counter\n", name, help);
}

}  // namespace

void Metrics::count_request(const std::string& route, int status, double seconds) {
  const std::scoped_lock lock(mutex_);
  Sum& sum = requests_[{route, status}];
  ++sum.count;
  sum.seconds += seconds;
}

void Metrics::count_job(const std::string& kind, const std::string& outcome, double seconds) {
  const std::scoped_lock lock(mutex_);
  Sum& sum = jobs_[{kind, outcome}];
  ++sum.count;
  sum.seconds += seconds;
}

std::string Metrics::text(const Now& now) const {
  std::string text;
  const auto out = [&] { return std::back_inserter(text); };
  const std::scoped_lock lock(mutex_);
  heading(text, "rhizodont_requests_total", "Requests answered, by route and status.");
  for (const auto& [key, sum] : requests_)
    fmt::format_to(out(), "rhizodont_requests_total{{route=\"{}\",status=\"{}\"}} {}\n", key.first, key.second,
                   sum.count);
  heading(text, "rhizodont_request_seconds_total", "Time for answering them, transfer not counted.");
  for (const auto& [key, sum] : requests_)
    fmt::format_to(out(), "rhizodont_request_seconds_total{{route=\"{}\",status=\"{}\"}} {}\n", key.first, key.second,
                   sum.seconds);
  heading(text, "rhizodont_jobs_total", "Jobs that ended, by kind and outcome.");
  for (const auto& [key, sum] : jobs_)
    fmt::format_to(out(), "rhizodont_jobs_total{{kind=\"{}\",outcome=\"{}\"}} {}\n", key.first, key.second, sum.count);
  heading(text, "rhizodont_job_seconds_total", "Time that they took.");
  for (const auto& [key, sum] : jobs_)
    fmt::format_to(out(), "rhizodont_job_seconds_total{{kind=\"{}\",outcome=\"{}\"}} {}\n", key.first, key.second,
                   sum.seconds);
  gauge(text, "rhizodont_scans_kept", "Scans in memory.", static_cast<double>(now.scans));
  gauge(text, "rhizodont_jobs_kept", "Jobs in memory.", static_cast<double>(now.jobs));
  gauge(text, "rhizodont_work_running", "Computations at work.", static_cast<double>(now.running));
  gauge(text, "rhizodont_work_waiting", "Computations that wait.", static_cast<double>(now.waiting));
  gauge(text, "rhizodont_event_streams", "Streams of events that are open.", static_cast<double>(now.event_streams));
  gauge(text, "rhizodont_resident_bytes", "Memory of the process.", static_cast<double>(resident_bytes()));
  gauge(text, "rhizodont_uptime_seconds", "Time since the start.", now.uptime_seconds);
  return text;
}

}  // namespace rhizodont::serve
