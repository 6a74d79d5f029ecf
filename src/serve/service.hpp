// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/models.hpp"
#include "rhizodont/segment.hpp"
#include "serve/limits.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont::serve {

struct ServiceOptions {
  ServeLimits limits;
  /// What finds teeth in scans that nothing tells apart; null: such scans are refused.
  std::shared_ptr<const SegmentModels> finder;
  std::map<std::string, std::string> model_hashes;  ///< SHA-256 of the models' files by their names, for reports
  /// Gets a line of JSON for each request and job: time, route, status, duration. Neither names of files nor ids.
  std::function<void(const std::string&)> log;
};

/// The page and its API on 127.0.0.1. Requests for other hosts' names and from other origins are refused. Everything is
/// in memory alone, and forgotten after a while or with the service.
class Service {
 public:
  explicit Service(CompletionModels models, ServiceOptions options = {});
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  /// Stops, and waits for what is at work to reach its next stage.
  ~Service();

  /// Takes a port of 127.0.0.1 (0: any that is free) and returns it. Throws UsageError if it cannot be had.
  int bind(int port);

  /// Answers requests until `stop` is called from another thread. Precondition: bound.
  void run();
  void stop();

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

/// Method and path of each route, as docs/openapi.json has them ("/api/v1/jobs/{job}").
std::vector<std::pair<std::string, std::string>> service_routes();

}  // namespace rhizodont::serve
