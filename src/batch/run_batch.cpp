// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/run_batch.hpp"

#include "arch/arch_options.hpp"
#include "batch/case_folders.hpp"
#include "batch/complete_case.hpp"
#include "batch/ledger.hpp"
#include "pipeline/prepared_tooth.hpp"
#include "report/without_names.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/version.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <system_error>
#include <utility>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Thrown inside of a case when the run is to end.
struct Stopped {};

/// What earlier runs say of a case beyond its folder.
struct Remembered {
  std::size_t endings = 0;  ///< runs that began it and came to no end of it
  std::string fault;        ///< of the program, at the last try; empty if there was none
  double time = 0;          ///< of that
};

std::map<std::string, Remembered> remembered_cases(const fs::path& folder) {
  std::map<std::string, Remembered> remembered;
  for (const LedgerFile& file : read_ledgers(folder)) {
    std::string begun;
    for (const Json& line : file.lines) {
      const std::string event = text_in(line, "event"), key = text_in(line, "key");
      begun = event == "begun" ? key : event == "tooth" ? begun : "";
      if (event != "case" || key.empty()) continue;
      Remembered& one = remembered[key];
      if (number_in(line, "time") < one.time) continue;
      one.time = number_in(line, "time");
      const bool is_fault = number_in(line, "code") == static_cast<int>(ErrorCode::internal);
      one.fault = is_fault ? text_in(line, "reason") : std::string();
    }
    if (!begun.empty()) ++remembered[begun].endings;
  }
  return remembered;
}

class ShardRun {
 public:
  ShardRun(const BatchManifest& manifest, const BatchModels& models, const BatchOptions& options,
           const fs::path& folder, const BatchCallbacks& callbacks)
      : manifest_(manifest),
        models_(models),
        options_(options),
        folder_(folder),
        callbacks_(callbacks),
        remembered_(remembered_cases(folder)),
        ledger_(folder, options.shard) {}

  BatchResult run() {
    remove_unfinished(folder_, options_.shard.name());
    for (const BatchCase& one : manifest_.cases) result_.progress.cases += options_.shard.holds(one.place);
    write_beginning();
    try {
      for (const BatchCase& one : manifest_.cases)
        if (options_.shard.holds(one.place)) deal_with(one);
    } catch (const Stopped&) {
      result_.stopped = true;
    } catch (const OutputError&) {
      try {
        write_end("stopped");
      } catch (const OutputError&) {  // the first says why
      }
      throw;
    }
    write_end(result_.stopped ? "stopped" : "finished");
    std::error_code ignored;
    fs::remove(folder_ / "unfinished" / ledger_.run(), ignored);
    fs::remove(folder_ / "unfinished", ignored);  // if it is empty
    return result_;
  }

 private:
  void write_end(const char* event) {
    const Json line{{"event", event}};
    ledger_.append({line});
  }

  void write_beginning() {
    // Whatever gives the same keys is the same batch.
    std::string all = manifest_.sha256 + models_.completion_sha256 + models_.finder_sha256 + RHIZODONT_VERSION;
    BatchCase scan, crown;
    crown.is_crown = true;
    for (const BatchCase& kind : {scan, crown}) all += text_of_options(kind, options_.cases);
    const Json line{{"event", "run"},
                    {"ledger_version", ledger_version},
                    {"batch", sha256_of_bytes(all).substr(0, 32)},
                    {"program", RHIZODONT_VERSION},
                    {"shard", options_.shard.index + 1},
                    {"shards", options_.shard.count},
                    {"cases", result_.progress.cases},
                    {"cases_of_batch", manifest_.cases.size()}};
    ledger_.append({line});
  }

  void go_on() const {
    if (callbacks_.stop && callbacks_.stop()) throw Stopped();
  }

  void deal_with(const BatchCase& one) {
    go_on();
    CaseKey key;
    try {
      key = key_of_case(one, options_.cases, models_);
    } catch (const InputError& error) {
      BatchOutcome unreadable;
      unreadable.code = static_cast<int>(error.code());
      unreadable.reason = worded(one, error.what());
      return conclude(one, key, unreadable, false, 0);
    }
    const std::optional<BatchOutcome> before = find_case(folder_, key.key);
    if (before && (before->succeeded() || !options_.retry_failed)) return conclude(one, key, *before, true, 0);
    if (const auto past = remembered_.find(key.key); past != remembered_.end() && !options_.retry_failed && !before) {
      BatchOutcome fault;
      fault.code = static_cast<int>(ErrorCode::internal);
      fault.reason = past->second.fault;
      if (past->second.endings >= most_endings)
        fault.reason =
            fmt::format("The program came to its end {} times while it was at this case.", past->second.endings);
      if (!fault.reason.empty()) return conclude(one, key, fault, true, 0);
    }
    complete(one, key, before.has_value());
  }

  void complete(const BatchCase& one, const CaseKey& key, bool is_there) {
    const Json line{{"event", "begun"}, {"case", one.id}, {"key", key.key}};
    ledger_.append({line});
    const auto begin = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    BatchOutcome outcome;
    try {
      outcome = complete_case(one, key, models_, options_.cases, [this] { go_on(); });
      place_case(folder_, key.key, outcome, ledger_.run(), is_there);
    } catch (const OutputError&) {
      throw;
    } catch (const std::exception& fault) {  // the other cases may do
      outcome = {};
      outcome.code = static_cast<int>(ErrorCode::internal);
      outcome.reason = "A fault of the program: " + worded(one, fault.what());
    }
    conclude(one, key, outcome, false, seconds());
  }

  std::string worded(const BatchCase& one, const std::string& sentence) const {
    if (options_.cases.keep_names) return sentence;
    std::vector<fs::path> files{one.scan, fs::path(one.scan_as_given), one.labels.labels, one.labels.palette};
    return without_names(sentence, files);
  }

  /// Writes what became of a case into the ledger, and tells of it.
  void conclude(const BatchCase& one, const CaseKey& key, const BatchOutcome& outcome, bool from_before,
                double seconds) {
    std::vector<Json> lines;
    for (const ToothOutcome& tooth : outcome.teeth) {
      Json line{{"event", "tooth"}, {"case", one.id}, {"key", key.key}};
      line.update(tooth_outcome_json(tooth));
      lines.push_back(std::move(line));
    }
    Json line{{"event", "case"},
              {"case", one.id},
              {"key", key.key},
              {"code", outcome.code},
              {"reason", outcome.reason},
              {"teeth", outcome.teeth.size()},
              {"rooted", outcome.rooted()},
              {"from_before", from_before},
              {"seconds", seconds}};
    if (options_.cases.keep_names) line["scan"] = one.scan_as_given;
    lines.push_back(std::move(line));
    ledger_.append(std::move(lines));
    count(outcome, from_before, seconds);
    if (callbacks_.finished)
      callbacks_.finished(
          {one.id, outcome.code, outcome.reason, outcome.teeth.size(), outcome.rooted(), from_before, seconds},
          result_.progress);
  }

  void count(const BatchOutcome& outcome, bool from_before, double seconds) {
    BatchProgress& progress = result_.progress;
    if (outcome.succeeded())
      ++progress.done;
    else if (outcome.code == static_cast<int>(ErrorCode::partial))
      ++progress.partial;
    else
      ++progress.failed;
    if (from_before || seconds == 0) return;  // nothing that tells how long cases take
    ++completed_;
    seconds_ += seconds;
    progress.seconds_left =
        seconds_ / static_cast<double>(completed_) * static_cast<double>(progress.cases - progress.dealt_with());
  }

  const BatchManifest& manifest_;
  const BatchModels& models_;
  const BatchOptions& options_;
  const fs::path& folder_;
  const BatchCallbacks& callbacks_;
  std::map<std::string, Remembered> remembered_;
  BatchLedger ledger_;
  BatchResult result_;
  std::size_t completed_ = 0;  // in this run
  double seconds_ = 0;
};

/// Wrong options are to be told at once, not by each case.
void require_in_range(const BatchOptions& options) {
  require_options_in_range(options.cases.arch);
  require_options_in_range(options.cases.crown);
}

}  // namespace

BatchResult run_batch(const BatchManifest& manifest, const BatchModels& models, const BatchOptions& options,
                      const fs::path& folder, const BatchCallbacks& callbacks) {
  require_in_range(options);
  return with_threads(options.threads, [&] { return ShardRun(manifest, models, options, folder, callbacks).run(); });
}

}  // namespace rhizodont
