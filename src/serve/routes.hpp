// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/models.hpp"
#include "serve/arch_work.hpp"
#include "serve/job.hpp"
#include "serve/metrics.hpp"
#include "serve/scan.hpp"
#include "serve/service.hpp"
#include "serve/store.hpp"
#include "serve/workers.hpp"

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace rhizodont::serve {

/// What the routes work on.
struct ServiceState {
  ServiceState(CompletionModels the_models, const ServiceOptions& the_options);

  CompletionModels models;
  ServiceOptions options;
  Store<Scan> scans;
  Store<Job> jobs;
  FewShelves shelves;
  Metrics metrics;
  std::atomic<std::size_t> uploads = 0, event_streams = 0;
  std::atomic<bool> stopping = false;
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  Workers workers;  ///< last: its threads use the others
};

struct Call {
  const httplib::Request& request;
  httplib::Response& response;
  const httplib::ContentReader* content;  ///< null where a request has none
  std::string id, name;                   ///< of the path, where its template has them
};

struct Route {
  std::string method;
  std::string path;  ///< template: "/api/v1/jobs/{job}/files/{name}"
  std::function<void(ServiceState&, const Call&)> answer;

  /// The route's path as a regular expression; ids and names have few characters, no dots in a row and no slashes.
  std::string pattern() const;
};

/// All routes of the API.
const std::vector<Route>& routes();

/// Why a request is refused whatever it asks for: host, origin, form. Nothing if it may go on.
/// Throws Refusal.
void require_acceptable(const httplib::Request& request);

}  // namespace rhizodont::serve
