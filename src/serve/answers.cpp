// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/answers.hpp"

#include "report/json.hpp"

#include <cstddef>
#include <iterator>
#include <utility>

namespace rhizodont::serve {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::ptrdiff_t most_ids = 100;

const char* kind_of_status(int status) {
  switch (status) {
    case 403:
      return "foreign";
    case 404:
      return "not found";
    case 408:
      return "too slow";
    case 409:
      return "not now";
    case 413:
    case 414:
    case 431:
      return "too large";
    case 415:
      return "wrong type";
    case 500:
      return "fault of the program";
    case 503:
      return "busy";
    default:
      return "wrong usage";
  }
}

}  // namespace

Json error_json(const Error& error) {
  Json json = refusal_json(error);
  Json& ids = json["ids"];
  json["ids_in_all"] = ids.size();
  if (std::ssize(ids) > most_ids) ids.erase(ids.begin() + most_ids, ids.end());
  return {{"error", std::move(json)}};
}

int status_of(const Error& error) {
  switch (error.code()) {
    case ErrorCode::wrong_usage:
      return 400;
    case ErrorCode::unusable_input:
    case ErrorCode::no_result:
    case ErrorCode::partial:
      return 422;
    case ErrorCode::unwritable:
    case ErrorCode::internal:
      break;
  }
  return 500;
}

std::string refusal_body(int status, const std::string& sentence) {
  return Json{{"error", {{"kind", kind_of_status(status)}, {"sentence", sentence}}}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

std::string sentence_for_status(int status) {
  switch (status) {
    case 404:
      return "There is nothing at this address.";
    case 408:
      return "The request came too slowly.";
    case 413:
      return "The request is too large.";
    case 414:
      return "The address is too long.";
    case 416:
      return "Parts of answers are not served.";
    case 431:
      return "The request's head is too long.";
    case 500:
      return "A fault of the program.";
    default:
      return "The request cannot be understood.";
  }
}

}  // namespace rhizodont::serve
