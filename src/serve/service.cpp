// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/service.hpp"

#include "rhizodont/error.hpp"
#include "serve/answers.hpp"
#include "serve/assets.hpp"
#include "serve/bounded_server.hpp"
#include "serve/routes.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <new>
#include <regex>
#include <thread>
#include <utility>

namespace rhizodont::serve {
namespace {

using Clock = std::chrono::steady_clock;
using HandlerResponse = httplib::Server::HandlerResponse;

constexpr const char* duration_header = "Server-Timing";  // browsers show it; the log reads it back

constexpr const char* no_page =
    "<!doctype html><html lang=en><title>Rhizodont</title><h1>Rhizodont</h1><p>This program was built without its "
    "page: npm or its packages could not be reached. Install npm (scripts/install_dependencies.sh), configure again "
    "(cmake -B build -DRHIZODONT_WEB=ON) and build; the API is at "
    "<a href=/api/v1/openapi.json>/api/v1</a>.</html>";

void refuse(httplib::Response& response, int status, const std::string& body) {
  response.content_provider_ = nullptr;
  response.content_length_ = 0;
  response.status = status;
  response.set_content(body, "application/json");
  if (status == 503) response.set_header("Retry-After", "1");
}

/// Runs what answers; whatever it throws becomes an answer.
template <class Answer>
void answering(httplib::Response& response, const Answer& answer) {
  const auto begun = Clock::now();
  try {
    answer();
  } catch (const Refusal& refusal) {
    refuse(response, refusal.status(), refusal_body(refusal.status(), refusal.what()));
  } catch (const Error& error) {
    refuse(response, status_of(error),
           error_json(error).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } catch (const std::bad_alloc&) {
    refuse(response, 503, refusal_body(503, "The machine's memory is not enough for this."));
  } catch (const std::exception&) {  // its words are no user's
    refuse(response, 500, refusal_body(500, sentence_for_status(500)));
  }
  const std::chrono::duration<double, std::milli> took = Clock::now() - begun;
  response.headers.erase(duration_header);
  response.set_header(duration_header, fmt::format("app;dur={:.1f}", took.count()));
}

double noted_milliseconds(const httplib::Response& response) {
  const std::string text = response.get_header_value(duration_header);
  const std::size_t at = text.find('=');
  return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + 1, nullptr);
}

void send_asset(const std::string& path, httplib::Response& response) {
  std::string name = path == "/" ? "index.html" : path.substr(1);
  const Asset* asset = name.starts_with("samples/") || name == "openapi.json" ? nullptr : find_asset(name);
  if (asset == nullptr && name != "index.html") throw Refusal(404, sentence_for_status(404));
  const std::string_view bytes = asset == nullptr ? std::string_view(no_page) : asset->bytes;
  response.status = 200;
  response.set_header("Cache-Control", "no-cache");
  response.set_content_provider(bytes.size(), media_type(name),
                                [bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(bytes.data() + offset, std::min(length, bytes.size() - offset));
                                });
}

bool is_of_api(const std::string& path) { return path.starts_with("/api/") || path == "/metrics"; }

}  // namespace

struct Service::Content {
  /// To tell for counting which route a path is of: paths hold ids.
  struct MatchedRoute {
    const Route* route = nullptr;
    std::regex pattern;
  };

  Content(CompletionModels models, ServiceOptions options)
      : state(std::move(models), options), server(state.options.limits) {
    for (const Route& route : routes()) patterns.push_back({&route, std::regex(route.pattern())});
    server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cross-Origin-Opener-Policy", "same-origin"},
                                {"X-Frame-Options", "DENY"},
                                {"Content-Security-Policy",
                                 "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
                                 "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"}});
    server.set_pre_routing_handler([this](const auto& request, auto& response) { return before(request, response); });
    server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
      if (response.body.empty() && !response.content_provider_)
        refuse(response, response.status, refusal_body(response.status, sentence_for_status(response.status)));
    });
    server.set_exception_handler([](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
      refuse(response, 500, refusal_body(500, sentence_for_status(500)));
    });
    server.set_logger([this](const auto& request, const auto& response) { note(request, response); });
    add_routes();
  }

  void add_routes() {
    for (const Route& route : routes()) {
      const auto answer = [this, &route](const httplib::Request& request, httplib::Response& response,
                                         const httplib::ContentReader* content) {
        answering(response, [&] {
          const std::string first = request.matches.size() > 1 ? request.matches[1].str() : "";
          const bool has_id =
              route.path.find("{scan}") != std::string::npos || route.path.find("{job}") != std::string::npos;
          response.set_header("Cache-Control", "no-store");
          route.answer(state, {request, response, content, has_id ? first : "",
                               has_id ? (request.matches.size() > 2 ? request.matches[2].str() : "") : first});
        });
      };
      if (route.method == "GET") {
        server.Get(route.pattern(), [answer](const httplib::Request& request, httplib::Response& response) {
          answer(request, response, nullptr);
        });
        continue;
      }
      const auto with_content = [answer](const httplib::Request& request, httplib::Response& response,
                                         const httplib::ContentReader& content) {
        answer(request, response, &content);
      };
      if (route.method == "POST") server.Post(route.pattern(), with_content);
      if (route.method == "DELETE") server.Delete(route.pattern(), with_content);
    }
  }

  const Route* route_of(const httplib::Request& request) const {
    constexpr std::size_t longest_path = 256;
    if (request.path.size() > longest_path) return nullptr;
    const std::string method = request.method == "HEAD" ? "GET" : request.method;
    for (const MatchedRoute& matched : patterns)
      if (matched.route->method == method && std::regex_match(request.path, matched.pattern)) return matched.route;
    return nullptr;
  }

  /// All that is not for a route of the API is answered here, before httplib reads a body that nobody wants.
  HandlerResponse before(const httplib::Request& request, httplib::Response& response) {
    bool is_for_route = false;
    answering(response, [&] {
      require_acceptable(request);
      if (is_of_api(request.path)) {
        is_for_route = route_of(request) != nullptr;
        if (!is_for_route) throw Refusal(404, sentence_for_status(404));
      } else if (request.method == "GET" || request.method == "HEAD") {
        send_asset(request.path, response);
      } else {
        throw Refusal(405, "Nothing can be sent here.");
      }
    });
    return is_for_route ? HandlerResponse::Unhandled : HandlerResponse::Handled;
  }

  void note(const httplib::Request& request, const httplib::Response& response) {
    const Route* route = route_of(request);
    const std::string name = route != nullptr ? route->path : is_of_api(request.path) ? "unknown" : "page";
    const double milliseconds = noted_milliseconds(response);
    state.metrics.count_request(name, response.status, milliseconds / 1000);
    if (!state.options.log) return;
    const nlohmann::ordered_json line{{"time", fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr)))},
                                      {"method", route != nullptr ? route->method : "-"},
                                      {"route", name},
                                      {"status", response.status},
                                      {"milliseconds", milliseconds}};
    state.options.log(line.dump());
  }

  ServiceState state;
  BoundedServer server;
  std::vector<MatchedRoute> patterns;
  std::atomic<bool> is_run = false, has_ended = false;
};

Service::Service(CompletionModels models, ServiceOptions options)
    : content_(std::make_unique<Content>(std::move(models), std::move(options))) {}

Service::~Service() { stop(); }

int Service::bind(int port) {
  httplib::Server& server = content_->server;
  if (port == 0)
    port = server.bind_to_any_port("127.0.0.1");
  else if (!server.bind_to_port("127.0.0.1", port))
    port = -1;
  if (port < 0)
    throw UsageError("The port cannot be had, perhaps because another program has it: choose another one (--port).");
  return port;
}

void Service::run() {
  content_->is_run = true;
  if (!content_->state.stopping) content_->server.listen_after_bind();
  content_->has_ended = true;
}

void Service::stop() {
  content_->state.stopping = true;
  content_->state.workers.stop();
  content_->state.jobs.for_each([](Job& job) { job.cancel(); });
  // httplib passes over a stop before it listens
  while (content_->is_run && !content_->has_ended && !content_->server.is_running())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  content_->server.stop();
}

std::vector<std::pair<std::string, std::string>> service_routes() {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Route& route : routes()) all.emplace_back(route.method, route.path);
  return all;
}

}  // namespace rhizodont::serve
