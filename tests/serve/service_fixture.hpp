// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/models.hpp"
#include "serve/service.hpp"

#include <gtest/gtest.h>
#include <httplib.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

// A service on a free port, asked over HTTP.
namespace rhizodont::test {

using Json = nlohmann::json;

inline std::string sample_bytes(const std::string& name) {
  std::ifstream file(std::filesystem::path(RHIZODONT_SOURCE_DIR) / "samples" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RunningService {
 public:
  explicit RunningService(const serve::ServeLimits& limits = {}) {
    serve::ServiceOptions options;
    options.limits = limits;
    options.log = [this](const std::string& line) {
      const std::scoped_lock lock(mutex_);
      log_ += line + "\n";
    };
    service_ = std::make_unique<serve::Service>(CompletionModels::load(default_models_folder()), options);
    port_ = service_->bind(0);
    thread_ = std::thread([this] { service_->run(); });
  }
  RunningService(const RunningService&) = delete;
  RunningService& operator=(const RunningService&) = delete;
  ~RunningService() {
    service_->stop();
    thread_.join();
  }

  int port() const { return port_; }
  std::string log() const {
    const std::scoped_lock lock(mutex_);
    return log_;
  }

  std::unique_ptr<httplib::Client> client() const {
    auto made = std::make_unique<httplib::Client>("127.0.0.1", port_);
    made->set_read_timeout(60, 0);
    return made;
  }

 private:
  mutable std::mutex mutex_;
  std::string log_;
  std::unique_ptr<serve::Service> service_;
  int port_ = 0;
  std::thread thread_;
};

class ServiceTest : public ::testing::Test {
 protected:
  httplib::Result get(const std::string& path, const httplib::Headers& headers = {}) const {
    return service.client()->Get(path, headers);
  }
  httplib::Result post(const std::string& path, const std::string& body, const char* type = "application/json",
                       const httplib::Headers& headers = {}) const {
    return service.client()->Post(path, headers, body, type);
  }

  /// The JSON of an answer with this status; null, with a failure noted, for another one.
  static Json json_of(const httplib::Result& result, int status) {
    if (!result) {
      ADD_FAILURE() << "no answer: " << httplib::to_string(result.error());
      return {};
    }
    EXPECT_EQ(result->status, status) << result->body.substr(0, 400);
    return Json::parse(result->body, nullptr, false);
  }
  static void expect_refusal(const httplib::Result& result, int status, const std::string& words) {
    const Json json = json_of(result, status);
    ASSERT_TRUE(json.is_object() && json.contains("error")) << (result ? result->body : "");
    const std::string sentence = json["error"]["sentence"];
    EXPECT_NE(sentence.find(words), std::string::npos) << sentence << "\nshould hold: " << words;
  }

  std::string send(const std::string& bytes, const std::string& name) const {
    return json_of(post("/api/v1/scans?name=" + name, bytes, "application/octet-stream"), 201)["scan"];
  }
  std::string start(const Json& request) const { return json_of(post("/api/v1/jobs", request.dump()), 202)["job"]; }
  std::string start_sample(const std::string& name, const Json& options) const {
    return start({{"scan", send(sample_bytes(name), name)}, {"options", options}});
  }

  /// Reads a job's events to their end.
  std::string events(const std::string& job, const httplib::Headers& headers = {}) const {
    std::string text;
    service.client()->Get("/api/v1/jobs/" + job + "/events", headers, [&](const char* bytes, std::size_t size) {
      text.append(bytes, size);
      return true;
    });
    return text;
  }
  Json ended(const std::string& job) const {
    events(job);
    return json_of(get("/api/v1/jobs/" + job), 200);
  }

  RunningService service;
};

}  // namespace rhizodont::test
