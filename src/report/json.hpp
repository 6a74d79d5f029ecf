// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/check.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/measure.hpp"
#include "rhizodont/segment.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <functional>
#include <map>
#include <string>

namespace rhizodont {

/// The coordinates as a list.
nlohmann::ordered_json numbers(const Eigen::Vector3d& v);
/// A report's text: indented, with an end of line. Names need not be UTF-8; what is not is shown by a replacement
/// character.
std::string text_of(const nlohmann::ordered_json& json);
/// Why something was refused, as the report's "refused" has it: exit code, kind, sentence, and the ids concerned.
nlohmann::ordered_json refusal_json(const Error& error);

/// A value as a sentence quotes it: in one line of plain letters, of a long one the beginning.
std::string shown(const nlohmann::ordered_json& json);

/// What is to be done with the value of each name.
using JsonTakers = std::map<std::string, std::function<void(const nlohmann::ordered_json&)>>;
/// Hands each member of an object to what takes it. Throws UsageError where it is no object, for a name that nothing
/// takes ("SUBJECT VERB no ..."), and where a taker throws nlohmann::json::exception.
void take_members(const nlohmann::ordered_json& json, const std::string& subject, const char* verb,
                  const JsonTakers& takers);

// For `nlohmann::ordered_json(value)`. Lengths in mm, angles in degrees.
void to_json(nlohmann::ordered_json& json, const CompleteOptions& options);
void to_json(nlohmann::ordered_json& json, const QualityFigures& figures);
void to_json(nlohmann::ordered_json& json, const CheckReport& report);
void to_json(nlohmann::ordered_json& json, const MeshMeasures& measures);
void to_json(nlohmann::ordered_json& json, const FoundTooth& tooth);

// Back again, for `json.get<T>()`. Throw nlohmann::json::exception for what is missing or of another kind.
void from_json(const nlohmann::ordered_json& json, QualityFigures& figures);
void from_json(const nlohmann::ordered_json& json, CheckReport& report);
void from_json(const nlohmann::ordered_json& json, MeshMeasures& measures);

}  // namespace rhizodont
