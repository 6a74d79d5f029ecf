// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Bodies of the service's requests. What is refused becomes an answer in JSON.
#include "fuzz/targets.hpp"
#include "rhizodont/error.hpp"
#include "serve/answers.hpp"
#include "serve/requests.hpp"

namespace rhizodont::test {
namespace {

bool read_body(const std::function<void()>& reader) {
  return is_taken([&] {
    try {
      reader();
    } catch (const Error& error) {
      const std::string body = serve::error_json(error).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      require_rule(nlohmann::json::accept(body), "an answer that is no JSON");
      require_rule(serve::status_of(error) == 400, "another answer than 400");
      throw;
    }
  });
}

}  // namespace

bool fuzz_job(std::string_view bytes) {
  return read_body([&] {
    const serve::SentJob job = serve::read_sent_job(bytes);
    require_rule(!job.scan.empty(), "a job without a scan");
  });
}

bool fuzz_steering(std::string_view bytes) {
  return read_body([&] { serve::read_sent_steering(bytes); });
}

}  // namespace rhizodont::test
