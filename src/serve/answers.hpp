// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace rhizodont::serve {

/// A request that is not carried out, with the status to answer it by.
class Refusal : public std::runtime_error {
 public:
  Refusal(int status, const std::string& sentence) : std::runtime_error(sentence), status_(status) {}
  int status() const { return status_; }

 private:
  int status_;
};

/// {"error": {...}} with the library's sentence, its kind in the words of the report, and at most 100 of the ids
/// concerned; `ids_in_all` says how many there are.
nlohmann::ordered_json error_json(const Error& error);

/// 400 for wrong usage, 422 for input that cannot be used or gives no result, 500 for faults.
int status_of(const Error& error);

/// The body for a status without an error of the library.
std::string refusal_body(int status, const std::string& sentence);

/// What is said where nothing more is known than the status.
std::string sentence_for_status(int status);

}  // namespace rhizodont::serve
