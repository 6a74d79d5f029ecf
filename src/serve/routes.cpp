// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/routes.hpp"

#include "rhizodont/error.hpp"
#include "rhizodont/root_steering.hpp"
#include "rhizodont/tooth_file.hpp"
#include "rhizodont/version.hpp"
#include "serve/answers.hpp"
#include "serve/assets.hpp"
#include "serve/requests.hpp"
#include "serve/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <future>
#include <optional>
#include <regex>
#include <utility>

namespace rhizodont::serve {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* octets = "application/octet-stream";

/// With a provider: httplib packs other bodies anew for every request, at brotli's slowest.
void send(httplib::Response& response, std::string bytes, const char* type, int status = 200) {
  response.status = status;
  const auto kept = std::make_shared<const std::string>(std::move(bytes));
  response.set_content_provider(
      kept->size(), type, [kept](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(kept->data() + offset, std::min<std::size_t>(length, kept->size() - offset));
      });
}

void send(httplib::Response& response, const Json& json, int status = 200) {
  send(response, json.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json", status);
}

std::string read_body(const Call& call, std::size_t most) {
  const auto too_large = [&] {
    return Refusal(413, fmt::format("What was sent is larger than the {} KiB that are taken here.", most >> 10));
  };
  const std::string length = call.request.get_header_value("Content-Length");
  if (!length.empty() && (length.size() > 12 || std::strtoull(length.c_str(), nullptr, 10) > most)) throw too_large();
  std::string body;
  bool is_too_large = false;
  const bool is_complete = (*call.content)([&](const char* bytes, std::size_t size) {
    is_too_large = body.size() + size > most;
    if (!is_too_large) body.append(bytes, size);
    return !is_too_large;
  });
  if (is_too_large) throw too_large();
  if (!is_complete) throw Refusal(400, "The request ended before all of it was there.");
  return body;
}

void require_type(const Call& call, const std::string& type) {
  const std::string sent = call.request.get_header_value("Content-Type");
  if (sent != type && !sent.starts_with(type + ";"))
    throw Refusal(415, fmt::format("This takes {} (Content-Type).", type));
}

std::string read_json(const Call& call, std::size_t most) {
  require_type(call, "application/json");
  return read_body(call, most);
}

std::shared_ptr<Job> job_of(ServiceState& state, const Call& call) {
  std::shared_ptr<Job> job = state.jobs.find(call.id);
  if (!job) throw Refusal(404, "There is no such job; results are forgotten after a while.");
  return job;
}

/// Counts one more of what may be there so often only at the same time.
class Place {
 public:
  Place(std::atomic<std::size_t>& taken, std::size_t most, const char* sentence) : taken_(taken) {
    if (taken_.fetch_add(1) >= most) {
      taken_.fetch_sub(1);
      throw Refusal(503, sentence);
    }
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  ~Place() { taken_.fetch_sub(1); }

 private:
  std::atomic<std::size_t>& taken_;
};

constexpr const char* too_busy = "Too much is being computed already; try again in a moment.";

/// Computes on one of the workers and waits.
template <class Work>
auto compute(ServiceState& state, Work work) {
  using Result = decltype(work());
  const auto task = std::make_shared<std::packaged_task<Result()>>(std::move(work));
  std::future<Result> result = task->get_future();
  if (!state.workers.add([task] { (*task)(); }, true)) throw Refusal(503, too_busy);
  try {
    return result.get();
  } catch (const std::future_error&) {  // the service is ending
    throw Refusal(503, too_busy);
  }
}

void about(ServiceState& state, const Call& call) {
  const ServeLimits& limits = state.options.limits;
  send(call.response,
       {{"program", {{"name", "rhizodont"}, {"version", RHIZODONT_VERSION}}},
        {"notice", "A predicted root is not the patient's anatomy. For research and visualisation only."},
        {"limits",
         {{"upload_bytes", limits.upload_bytes},
          {"triangles", limits.triangles},
          {"parallel_jobs", limits.parallel_jobs},
          {"waiting_jobs", limits.waiting_jobs},
          {"job_seconds", limits.job_time.count()},
          {"kept_seconds", limits.expiry.count()}}},
        {"steering",
         {{"root_length_mm", {shortest_root_mm, longest_root_mm}},
          {"tip_degrees", {-30, 30}},
          {"torque_degrees", {-30, 30}},
          {"bend_degrees", {-45, 45}}}},
        {"e_mm", {0.2, 2}}});
}

void description(ServiceState&, const Call& call) {
  send(call.response, std::string(find_asset("openapi.json")->bytes), "application/json");
}

constexpr std::string_view samples_folder = "samples/";

void list_samples(ServiceState&, const Call& call) {
  Json list = Json::array();
  for (const Asset& asset : service_assets())
    if (asset.name.starts_with(samples_folder)) {
      const std::string name(asset.name.substr(samples_folder.size()));
      const auto fdi = fdi_in_name(name);
      list.push_back({{"name", name},
                      {"kind", kind_name(name.starts_with("scan") ? JobKind::arch : JobKind::tooth)},
                      {"fdi", fdi ? Json(*fdi) : Json(nullptr)},
                      {"skirt", name.starts_with("skirt")}});
    }
  send(call.response, {{"samples", list}});
}

void send_sample(ServiceState&, const Call& call) {
  const Asset* asset = find_asset(std::string(samples_folder) + call.name);
  if (asset == nullptr) throw Refusal(404, sentence_for_status(404));
  send(call.response, std::string(asset->bytes), octets);
}

void take_scan(ServiceState& state, const Call& call) {
  const ServeLimits& limits = state.options.limits;
  const Place place(state.uploads, limits.uploads, "Too many scans are being sent already; try again in a moment.");
  require_type(call, octets);
  const std::string bytes = read_body(call, limits.upload_bytes);
  auto scan = std::make_shared<Scan>(read_sent_scan(bytes, call.request.get_param_value("name"), limits));
  const std::string id = random_id();
  Json json{{"scan", id},
            {"sha256", scan->sha256},
            {"vertices", scan->file.mesh.vertices.size()},
            {"triangles", scan->file.mesh.triangles.size()},
            {"fdi_in_name", scan->fdi_in_name ? Json(*scan->fdi_in_name) : Json(nullptr)},
            {"has_labels", scan->has_label_array},
            {"kind", kind_name(scan->looks_like_arch ? JobKind::arch : JobKind::tooth)},
            {"notes", scan->file.notes}};
  state.scans.add(id, std::move(scan));
  send(call.response, json, 201);
}

void take_labels(ServiceState& state, const Call& call) {
  const std::shared_ptr<Scan> scan = state.scans.find(call.id);
  if (!scan) throw Refusal(404, "There is no such scan; scans are forgotten after a while.");
  const Place place(state.uploads, state.options.limits.uploads,
                    "Too many scans are being sent already; try again in a moment.");
  std::string labels = read_json(call, state.options.limits.labels_bytes);
  require_flat_json(labels);
  auto labelled = std::make_shared<Scan>(*scan);  // jobs at work go on with the scan as it was
  labelled->labels = std::move(labels);
  labelled->shelf = std::make_shared<ArchShelf>();
  const std::string id = random_id();
  state.scans.add(id, std::move(labelled));
  send(call.response, {{"scan", id}}, 201);
}

void forget_scan(ServiceState& state, const Call& call) {
  if (!state.scans.take(call.id)) throw Refusal(404, "There is no such scan; scans are forgotten after a while.");
  call.response.status = 204;
}

void start_job(ServiceState& state, const Call& call) {
  SentJob sent = read_sent_job(read_json(call, state.options.limits.json_bytes));
  std::shared_ptr<const Scan> scan = state.scans.find(sent.scan);
  if (!scan) throw Refusal(404, "There is no such scan; scans are forgotten after a while.");
  if (sent.request.kind == JobKind::arch) state.shelves.use(scan->shelf);
  auto job = std::make_shared<Job>(std::move(scan), std::move(sent.request), state.options.limits.job_time);
  const std::string id = random_id();
  if (!state.jobs.add(id, job)) throw Refusal(503, too_busy);
  const auto work = [job, &state] {
    job->run(state.models, state.options.finder.get());
    if (job->seconds() > 0)
      state.metrics.count_job(kind_name(job->request().kind), state_name(job->state()), job->seconds());
  };
  if (!state.workers.add(work)) {
    job->cancel();
    state.jobs.take(id);
    throw Refusal(503, too_busy);
  }
  send(call.response, {{"job", id}}, 202);
}

void tell_job(ServiceState& state, const Call& call) { send(call.response, job_json(call.id, *job_of(state, call))); }

void cancel_job(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = job_of(state, call);
  job->cancel();
  send(call.response, {{"job", call.id}, {"state", state_name(job->state())}}, 202);
}

void forget_job(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = state.jobs.take(call.id);
  if (!job) throw Refusal(404, "There is no such job; results are forgotten after a while.");
  job->cancel();
  call.response.status = 204;
}

void steer_job(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = job_of(state, call);
  const SentSteering sent = read_sent_steering(read_json(call, state.options.limits.json_bytes));
  const auto result = compute(state, [job, sent] { return job->steer(sent.steering, sent.transition); });
  send(call.response, {{"job", call.id}, {"revision", result->revision}, {"tooth", tooth_summary(result->tooth)}});
}

void send_view(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = job_of(state, call);
  const std::string name = call.name;
  const bool is_ghost = name == "shortest" || name == "longest";
  send(call.response, is_ghost ? compute(state, [job, name] { return view_of(*job, name); }) : view_of(*job, name),
       octets);
}

void send_file(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = job_of(state, call);
  send(call.response, file_of(*job, call.name, state.options.model_hashes), media_type(call.name));
  call.response.set_header("Content-Disposition",
                           fmt::format("attachment; filename=\"{}\"", saved_name(*job, call.name)));
}

/// Events of a job as they come, from the one after the last that the client has.
void send_events(ServiceState& state, const Call& call) {
  const std::shared_ptr<Job> job = job_of(state, call);
  const auto place = std::make_shared<Place>(state.event_streams, state.options.limits.event_streams,
                                             "Too many pages follow jobs already.");
  const std::string last = call.request.get_header_value("Last-Event-ID");
  const auto next = std::make_shared<std::size_t>(last.empty() ? 0 : std::strtoull(last.c_str(), nullptr, 10) + 1);
  const auto until = std::chrono::steady_clock::now() + state.options.limits.events_time;
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_chunked_content_provider(
      "text/event-stream", [job, place, next, until, &state](std::size_t, httplib::DataSink& sink) {
        const auto events = job->events(*next, std::chrono::milliseconds(500));
        if (!sink.is_writable()) return false;
        std::string text = *next == 0 ? "retry: 300\n\n" : events.empty() ? ":\n\n" : "";
        for (const JobEvent& event : events)
          text += fmt::format("id: {}\nevent: {}\ndata: {}\n\n", (*next)++, event.name, event.data);
        if (!sink.write(text.data(), text.size())) return false;
        if ((job->has_ended() && job->events(*next, {}).empty()) || state.stopping ||
            std::chrono::steady_clock::now() > until)
          sink.done();
        return true;
      });
}

void send_metrics(ServiceState& state, const Call& call) {
  state.scans.expire();
  state.jobs.expire();
  const std::chrono::duration<double> uptime = std::chrono::steady_clock::now() - state.started;
  send(call.response,
       state.metrics.text({state.scans.size(), state.jobs.size(), state.workers.running(), state.workers.waiting(),
                           state.event_streams, uptime.count()}),
       "text/plain; version=0.0.4");
}

}  // namespace

ServiceState::ServiceState(CompletionModels the_models, const ServiceOptions& the_options)
    : models(std::move(the_models)),
      options(the_options),
      scans(options.limits.kept_scans, options.limits.expiry),
      jobs(options.limits.kept_jobs, options.limits.expiry, [](const Job& job) { return job.has_ended(); }),
      shelves(options.limits.remembered_arches),
      workers(options.limits.parallel_jobs, options.limits.waiting_jobs) {}

std::string Route::pattern() const {
  static const std::regex id("\\{(scan|job)\\}"), name("\\{name\\}"), dot("\\.");
  const std::string plain = std::regex_replace(path, dot, "\\.");
  return std::regex_replace(std::regex_replace(plain, id, "([0-9a-f]{32})"), name,
                            "([A-Za-z0-9_-]{1,40}(?:\\.[a-z0-9]{1,8}){0,2})");
}

const std::vector<Route>& routes() {
  static const std::vector<Route> all{
      {"GET", "/api/v1/about", about},
      {"GET", "/api/v1/openapi.json", description},
      {"GET", "/api/v1/samples", list_samples},
      {"GET", "/api/v1/samples/{name}", send_sample},
      {"POST", "/api/v1/scans", take_scan},
      {"POST", "/api/v1/scans/{scan}/labels", take_labels},
      {"DELETE", "/api/v1/scans/{scan}", forget_scan},
      {"POST", "/api/v1/jobs", start_job},
      {"GET", "/api/v1/jobs/{job}", tell_job},
      {"DELETE", "/api/v1/jobs/{job}", forget_job},
      {"GET", "/api/v1/jobs/{job}/events", send_events},
      {"POST", "/api/v1/jobs/{job}/cancel", cancel_job},
      {"POST", "/api/v1/jobs/{job}/steering", steer_job},
      {"GET", "/api/v1/jobs/{job}/views/{name}", send_view},
      {"GET", "/api/v1/jobs/{job}/files/{name}", send_file},
      {"GET", "/metrics", send_metrics},
  };
  return all;
}

void require_acceptable(const httplib::Request& request) {
  const std::string host = request.get_header_value("Host");
  const std::string name = host.substr(0, host.starts_with('[') ? host.find(']') + 1 : host.find(':'));
  if (request.get_header_value_count("Host") != 1 || (name != "127.0.0.1" && name != "localhost" && name != "[::1]"))
    throw Refusal(403, "This service answers to 127.0.0.1 and localhost alone.");
  if (request.has_header("Origin") && request.get_header_value("Origin") != "http://" + host)
    throw Refusal(403, "Other pages may not use this service.");
  if (const std::string site = request.get_header_value("Sec-Fetch-Site"); site == "cross-site" || site == "same-site")
    throw Refusal(403, "Other pages may not use this service.");
  if (request.has_header("Range")) throw Refusal(416, sentence_for_status(416));
  const bool has_body = request.method == "POST" || request.method == "PUT" || request.method == "PATCH";
  if (has_body && !request.has_header("Content-Length") && request.get_header_value("Transfer-Encoding") != "chunked")
    throw Refusal(411, "The request does not say how long it is (Content-Length).");
}

}  // namespace rhizodont::serve
