// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "report/scan_input.hpp"
#include "rhizodont/arch.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/segment.hpp"
#include "serve/scan.hpp"
#include "teeth/correct_labels.hpp"

#include <nlohmann/json.hpp>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace rhizodont::serve {

enum class JobKind { tooth, arch };
enum class JobState { waiting, running, done, refused, cancelled };

const char* kind_name(JobKind kind);
const char* state_name(JobState state);

/// What is to be done with a scan.
struct JobRequest {
  JobKind kind = JobKind::tooth;
  CompleteOptions tooth;                     ///< of a tooth
  ArchOptions arch;                          ///< of an arch
  ScanLabelSource labels;                    ///< of an arch: what its numbers mean; names no file
  SegmentOptions found;                      ///< of an arch without labels: what is known of its teeth
  std::vector<LabelCorrection> corrections;  ///< of an arch: what a person says of its labels, one after the other
};

/// A tooth with what answers the next question about it.
struct ToothResult {
  CompletedTooth tooth;
  std::uint64_t revision = 0;  ///< counts the roots that were asked for
};

struct ArchResult {
  ScanInput input;        ///< as corrected
  bool searched = false;  ///< its teeth were searched for, for nothing told them apart
  CompletedArch arch;
};

/// Ends a computation from within its progress callback.
struct Cancelled {};

/// A piece of news, as it is sent.
struct JobEvent {
  std::string name;
  std::string data;  ///< JSON
};

/// One scan's way to a result. All functions may be called from several threads.
class Job {
 public:
  /// @param time  after which a computation is given up, at its next stage
  Job(std::shared_ptr<const Scan> scan, JobRequest request, std::chrono::seconds time);

  /// Does the work; to be called once. Throws nothing: what went wrong stands in `failure`.
  /// `finder`: for scans without labels; may be null.
  void run(const CompletionModels& models, const SegmentModels* finder);

  /// Another root for the same crown: the second half of the work alone. A newer call ends an older one (Refusal 409).
  /// What it throws (as `finish_tooth`) leaves the result as it was.
  std::shared_ptr<const ToothResult> steer(const RootSteering& steering, std::optional<double> transition);

  /// The tooth with the shortest or the longest likely root, as bytes to look at. Refusal (404) where there is no
  /// interval.
  std::string ghost(bool longest);

  void cancel();

  JobState state() const;
  bool has_ended() const;
  const Scan& scan() const { return *scan_; }
  const JobRequest& request() const { return request_; }
  std::shared_ptr<const ToothResult> tooth() const;  ///< null until it is done, and of an arch
  std::shared_ptr<const ArchResult> arch() const;    ///< likewise
  double seconds() const;                            ///< that the work took

  struct Failure {
    int status = 500;
    nlohmann::ordered_json body;
  };
  std::optional<Failure> failure() const;  ///< of a refused job

  /// Events from number `first` on; waits for one if there is none yet and the job has not ended.
  std::vector<JobEvent> events(std::size_t first, std::chrono::milliseconds wait) const;

 private:
  void run_tooth(const CompletionModels& models);
  void run_arch(const CompletionModels& models, const SegmentModels* finder);
  ScanInput read_labels(const SegmentModels* finder);
  void tell(std::string name, const nlohmann::ordered_json& data);
  void end(JobState state, std::optional<Failure> failure = {});
  ProgressCallback watching(std::chrono::steady_clock::time_point until, const std::atomic<bool>* superseded = nullptr);

  const std::shared_ptr<const Scan> scan_;
  const JobRequest request_;
  const std::chrono::seconds time_;

  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  JobState state_ = JobState::waiting;
  double seconds_ = 0;
  std::vector<JobEvent> events_;
  std::optional<Failure> failure_;
  std::optional<PreparedTooth> prepared_;
  std::optional<RootInterval> interval_;  // of the root that nobody steered
  std::string ghosts_[2];
  std::shared_ptr<const ToothResult> tooth_;
  std::shared_ptr<const ArchResult> arch_;
  std::shared_ptr<std::atomic<bool>> steering_;  // set to end the one at work
  std::uint64_t revision_ = 0;
};

}  // namespace rhizodont::serve
