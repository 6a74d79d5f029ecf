// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/status.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rhizodont {
namespace {

using Json = nlohmann::ordered_json;

constexpr double longest_silence_s = 15 * 60;

std::size_t count_in(const Json& line, const char* name) {
  return static_cast<std::size_t>(std::max(0.0, number_in(line, name)));
}

/// A run of the batch that was started last.
struct Run {
  const LedgerFile* file = nullptr;
  const Json* beginning = nullptr;
};

std::vector<Run> runs_of_latest_batch(const std::vector<LedgerFile>& files) {
  std::vector<Run> runs;
  for (const LedgerFile& file : files)
    if (!file.lines.empty() && text_in(file.lines.front(), "event") == "run")
      runs.push_back({&file, &file.lines.front()});
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return number_in(*a.beginning, "time") < number_in(*b.beginning, "time");
  });
  if (runs.empty()) return runs;
  const std::string latest = text_in(*runs.back().beginning, "batch");
  std::erase_if(runs, [&](const Run& run) { return text_in(*run.beginning, "batch") != latest; });
  return runs;
}

ShardStatus shard_status(const Run& run, double now) {
  ShardStatus status;
  status.shard = count_in(*run.beginning, "shard");
  status.shards = count_in(*run.beginning, "shards");
  status.cases = count_in(*run.beginning, "cases");
  double seconds = 0;
  std::size_t completed = 0;
  bool ended = false;
  for (const Json& line : run.file->lines) {
    const std::string event = text_in(line, "event");
    if (event == "begun") status.at = text_in(line, "case");
    if (event == "finished" || event == "stopped") ended = true;
    if (event != "case") continue;
    status.at.clear();
    ++status.dealt_with;
    const auto before = line.find("from_before");
    if ((before != line.end() && before->is_boolean() && before->get<bool>()) || number_in(line, "seconds") == 0)
      continue;
    ++completed;
    seconds += number_in(line, "seconds");
  }
  status.seconds_since_last_line = std::max(0.0, now - number_in(run.file->lines.back(), "time"));
  status.state = ended                                                ? RunState::ended
                 : status.seconds_since_last_line > longest_silence_s ? RunState::silent
                                                                      : RunState::running;
  if (ended) status.at.clear();
  if (status.state == RunState::running && completed > 0)
    status.seconds_left = seconds / static_cast<double>(completed) *
                          static_cast<double>(status.cases - std::min(status.cases, status.dealt_with));
  return status;
}

CaseStatus case_status(const Json& line) {
  return {text_in(line, "case"),
          text_in(line, "key"),
          text_in(line, "reason"),
          text_in(line, "scan"),
          static_cast<int>(number_in(line, "code")),
          count_in(line, "teeth"),
          count_in(line, "rooted"),
          number_in(line, "time")};
}

/// A case's latest line, with the reasons of the teeth before it.
struct Latest {
  CaseStatus status;
  std::vector<std::string> teeth;
};

std::map<std::string, Latest> latest_of_cases(const std::vector<Run>& runs) {
  std::map<std::string, Latest> cases;
  for (const Run& run : runs) {
    std::vector<std::string> reasons;
    for (const Json& line : run.file->lines) {
      const std::string event = text_in(line, "event");
      if (event == "tooth" && !text_in(line, "reason").empty()) reasons.push_back(text_in(line, "reason"));
      if (event != "case") continue;
      const CaseStatus status = case_status(line);
      const auto [place, is_new] = cases.try_emplace(status.id);
      // Of two lines in one second, that of success.
      if (is_new ||
          std::pair(status.time, -status.code) >= std::pair(place->second.status.time, -place->second.status.code))
        place->second = {status, std::move(reasons)};
      reasons.clear();
    }
  }
  return cases;
}

bool comes_first(const CaseStatus& a, const CaseStatus& b) {
  const auto order = [](const std::string& id) {
    const bool is_number = !id.empty() && id.find_first_not_of("0123456789") == std::string::npos;
    return std::tuple(!is_number, is_number ? id.size() : 0, id);
  };
  return order(a.id) < order(b.id);
}

void count_cases(const std::map<std::string, Latest>& cases, BatchStatus& status) {
  std::map<std::string, std::size_t> reasons;
  for (const auto& [id, latest] : cases) {
    const CaseStatus& one = latest.status;
    const bool is_partial = one.code == static_cast<int>(ErrorCode::partial);
    ++(one.code == 0 ? status.done : is_partial ? status.partial : status.failed);
    status.teeth += one.teeth;
    status.rooted += one.rooted;
    if (latest.teeth.empty() && one.code != 0) ++reasons[one.reason];
    for (const std::string& reason : latest.teeth) ++reasons[reason];
    status.by_case.push_back(one);
  }
  std::sort(status.by_case.begin(), status.by_case.end(), comes_first);
  status.reasons.assign(reasons.begin(), reasons.end());
  std::stable_sort(status.reasons.begin(), status.reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
}

const char* state_name(RunState state) {
  switch (state) {
    case RunState::running:
      return "running";
    case RunState::silent:
      return "silent";
    case RunState::ended:
      break;
  }
  return "ended";
}

Json seconds_or_null(const std::optional<double>& seconds) {
  return seconds ? Json(std::round(*seconds)) : Json(nullptr);
}

}  // namespace

BatchStatus batch_status(const std::filesystem::path& batch, double now) {
  const std::vector<LedgerFile> files = read_ledgers(batch);
  const std::vector<Run> runs = runs_of_latest_batch(files);
  if (runs.empty()) throw InputError("This folder has no ledger of a batch: it is not the output of one.");
  BatchStatus status;
  status.cases = count_in(*runs.back().beginning, "cases_of_batch");
  count_cases(latest_of_cases(runs), status);
  std::map<std::pair<std::size_t, std::size_t>, ShardStatus> latest;
  for (const Run& run : runs) {
    const ShardStatus shard = shard_status(run, now);
    latest[{shard.shards, shard.shard}] = shard;
  }
  for (const auto& [place, shard] : latest) {
    status.shards.push_back(shard);
    if (shard.state != RunState::running) continue;
    status.running += !shard.at.empty();
    if (shard.seconds_left) status.seconds_left = std::max(status.seconds_left.value_or(0), *shard.seconds_left);
  }
  return status;
}

Json batch_status_json(const BatchStatus& status) {
  Json shards = Json::array(), reasons = Json::array(), cases = Json::array();
  for (const ShardStatus& shard : status.shards)
    shards.push_back({{"shard", shard.shard},
                      {"shards", shard.shards},
                      {"state", state_name(shard.state)},
                      {"cases", shard.cases},
                      {"dealt_with", shard.dealt_with},
                      {"at_case", shard.at.empty() ? Json(nullptr) : Json(shard.at)},
                      {"seconds_since_last_line", std::round(shard.seconds_since_last_line)},
                      {"seconds_left", seconds_or_null(shard.seconds_left)}});
  for (const auto& [reason, count] : status.reasons) reasons.push_back({{"reason", reason}, {"count", count}});
  for (const CaseStatus& one : status.by_case) {
    cases.push_back({{"case", one.id},
                     {"code", one.code},
                     {"reason", one.reason},
                     {"teeth", one.teeth},
                     {"rooted", one.rooted},
                     {"folder", one.key.empty() ? Json(nullptr) : Json("cases/" + one.key)}});
    if (!one.scan.empty()) cases.back()["scan"] = one.scan;
  }
  return {
      {"cases", status.cases},   {"done", status.done},       {"partial", status.partial},
      {"failed", status.failed}, {"running", status.running}, {"remaining", status.remaining()},
      {"teeth", status.teeth},   {"rooted", status.rooted},   {"seconds_left", seconds_or_null(status.seconds_left)},
      {"reasons", reasons},      {"shards", shards},          {"by_case", cases}};
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  constexpr long long minute = 60, hour = 3600;
  if (whole >= hour) return fmt::format("{} h {} min", whole / hour, whole % hour / minute);
  if (whole >= 2 * minute) return fmt::format("{} min", whole / minute);
  return fmt::format("{} s", whole);
}

}  // namespace rhizodont
