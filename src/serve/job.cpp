// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/job.hpp"

#include "io/scan_labels.hpp"
#include "report/view_mesh.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/tooth_file.hpp"
#include "serve/answers.hpp"

#include <fmt/format.h>

#include <new>
#include <set>
#include <utility>

namespace rhizodont::serve {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

Job::Failure failure_of(const Error& error) { return {status_of(error), error_json(error)}; }

Job::Failure failure_of(int status, const std::string& sentence) {
  return {status, Json::parse(refusal_body(status, sentence))};
}

/// Runs a tooth's work with its errors in the terms of the file.
template <class Work>
auto in_terms_of(const Scan& scan, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw in_terms_of_file(error, scan.file);
  } catch (const NoResultError& error) {
    throw in_terms_of_file(error, scan.file);
  }
}

LabelQuestion question_of(const JobRequest& request) {
  const ScanLabelSource& labels = request.labels;
  return {labels.array,
          labels.numbers,
          labels.jaw,
          labels.first_is_patients_right,
          request.arch.tooth.millimetres_per_unit,
          request.found.missing,
          request.found.teeth};
}

/// What is known of a scan, for as long as a job needs it.
struct KeptWork {
  explicit KeptWork(ArchShelf& from) : shelf(from), work(from.take()) {}
  KeptWork(const KeptWork&) = delete;
  KeptWork& operator=(const KeptWork&) = delete;
  ~KeptWork() { shelf.put(std::move(work)); }

  ArchShelf& shelf;
  ArchWork work;
};

/// Corrects the labels as a person wishes; what the search said of teeth that changed no longer holds.
void correct(ScanInput& input, const JobRequest& request) {
  if (request.corrections.empty()) return;
  const std::vector<int> before = input.scan.fdi;
  CorrectedLabels corrected =
      correct_labels(input.scan.mesh, before, request.corrections, request.arch.tooth.millimetres_per_unit);
  std::set<int> changed;
  for (std::size_t v = 0; v < before.size(); ++v)
    if (before[v] != corrected.fdi[v]) changed.insert({before[v], corrected.fdi[v]});
  std::erase_if(input.found, [&](const FoundTooth& tooth) { return changed.contains(tooth.fdi); });
  input.scan.fdi = std::move(corrected.fdi);
  input.notes.insert(input.notes.end(), corrected.notes.begin(), corrected.notes.end());
}

}  // namespace

const char* kind_name(JobKind kind) { return kind == JobKind::tooth ? "tooth" : "arch"; }

const char* state_name(JobState state) {
  constexpr const char* names[] = {"waiting", "running", "done", "refused", "cancelled"};
  return names[static_cast<std::size_t>(state)];
}

Job::Job(std::shared_ptr<const Scan> scan, JobRequest request, std::chrono::seconds time)
    : scan_(std::move(scan)), request_(std::move(request)), time_(time) {}

void Job::run(const CompletionModels& models, const SegmentModels* finder) {
  const auto begun = Clock::now();
  {
    const std::scoped_lock lock(mutex_);
    if (state_ != JobState::waiting) return;  // cancelled before it began
    state_ = JobState::running;
  }
  tell("state", {{"state", state_name(JobState::running)}});
  const auto note_time = [&] {
    const std::scoped_lock lock(mutex_);
    seconds_ = std::chrono::duration<double>(Clock::now() - begun).count();
  };
  const auto end_with = [&](JobState state, std::optional<Failure> failure = {}) {
    note_time();
    end(state, std::move(failure));
  };
  try {
    if (request_.kind == JobKind::tooth) {
      run_tooth(models);
    } else {
      run_arch(models, finder);
    }
    end_with(JobState::done);
  } catch (const Cancelled&) {
    end_with(JobState::cancelled);
  } catch (const Refusal& refusal) {
    end_with(JobState::refused, failure_of(refusal.status(), refusal.what()));
  } catch (const Error& error) {
    end_with(JobState::refused, failure_of(error));
  } catch (const std::bad_alloc&) {
    end_with(JobState::refused, failure_of(500, "The machine's memory is not enough for this."));
  } catch (const std::exception&) {  // its words are no user's
    end_with(JobState::refused, failure_of(500, sentence_for_status(500)));
  }
}

void Job::run_tooth(const CompletionModels& models) {
  const auto until = Clock::now() + time_;
  CompleteOptions options = request_.tooth;
  if (!options.fdi) options.fdi = scan_->fdi_in_name;
  in_terms_of(*scan_, [&] {
    PreparedTooth prepared = prepare_tooth(scan_->file.mesh, models, options, watching(until));
    auto result = std::make_shared<ToothResult>();
    result->tooth = finish_tooth(prepared, options.steering, options.transition, watching(until));
    const std::scoped_lock lock(mutex_);
    interval_ = result->tooth.record.root.interval;
    prepared_.emplace(std::move(prepared));
    tooth_ = std::move(result);
  });
}

ScanInput Job::read_labels(const SegmentModels* finder) {
  tell("stage", {{"stage", "labels"}});
  ScanLabelSource labels = request_.labels;
  if (finder != nullptr)
    labels.find = [&](const TriangleMesh& mesh, const SegmentOptions& search) {
      tell("stage", {{"stage", "search"}});
      SegmentOptions options = request_.found;
      options.millimetres_per_unit = search.millimetres_per_unit;
      options.jaw = search.jaw;
      options.threads = request_.arch.tooth.threads;
      return segment_scan(mesh, *finder, options);
    };
  return scan_of_file(scan_->file, scan_->sha256, scan_->labels, labels, request_.arch.tooth.millimetres_per_unit);
}

void Job::run_arch(const CompletionModels& models, const SegmentModels* finder) {
  const auto until = Clock::now() + time_;
  const LabelQuestion question = question_of(request_);
  KeptWork kept(*scan_->shelf);
  ArchWork& work = kept.work;
  if (!work.input || work.question != question) {
    work.input = std::make_shared<const ScanInput>(read_labels(finder));
    work.question = question;
  }
  auto result = std::make_shared<ArchResult>();
  result->input = *work.input;
  result->searched = !work.input->found.empty();
  correct(result->input, request_);
  const ProgressCallback watch = watching(until);
  watch("teeth");
  const ArchProgress progress = [&](int done, int teeth, int fdi) {
    tell("tooth", {{"done", done}, {"teeth", teeth}, {"fdi", fdi}});
    if (cancelled_) throw Cancelled{};
    if (Clock::now() > until) watch("teeth");  // says so
  };
  result->arch = complete_arch(result->input.scan, models, request_.arch, progress, work.memory);
  const std::scoped_lock lock(mutex_);
  arch_ = std::move(result);
}

ProgressCallback Job::watching(Clock::time_point until, const std::atomic<bool>* superseded) {
  return [this, until, superseded](std::string_view stage) {
    if (cancelled_) throw Cancelled{};
    if (superseded != nullptr && *superseded) throw Refusal(409, "A newer root was asked for.");
    if (Clock::now() > until)
      throw Refusal(503,
                    fmt::format("This takes longer than the {} s that this service gives to one job.", time_.count()));
    if (superseded == nullptr) tell("stage", {{"stage", std::string(stage)}});
  };
}

std::shared_ptr<const ToothResult> Job::steer(const RootSteering& steering, std::optional<double> transition) {
  const auto mine = std::make_shared<std::atomic<bool>>(false);
  std::optional<PreparedTooth> prepared;
  std::uint64_t revision = 0;
  {
    const std::scoped_lock lock(mutex_);
    if (!prepared_) throw Refusal(409, "There is no tooth yet whose root could be changed.");
    if (steering_) *steering_ = true;
    steering_ = mine;
    prepared = prepared_;
    revision = ++revision_;
  }
  auto result = std::make_shared<ToothResult>();
  result->revision = revision;
  result->tooth = in_terms_of(*scan_, [&] {
    return finish_tooth(*prepared, steering, transition, watching(Clock::now() + time_, mine.get()));
  });
  const std::scoped_lock lock(mutex_);
  if (*mine) throw Refusal(409, "A newer root was asked for.");
  tooth_ = result;
  if (!interval_) interval_ = result->tooth.record.root.interval;
  return result;
}

std::string Job::ghost(bool longest) {
  std::optional<PreparedTooth> prepared;
  RootSteering steering;
  {
    const std::scoped_lock lock(mutex_);
    if (!ghosts_[longest].empty()) return ghosts_[longest];
    if (!prepared_ || !interval_) throw Refusal(404, "No interval of the root's length is known of this tooth.");
    prepared = prepared_;
    steering.length_mm = longest ? interval_->length_high_mm : interval_->length_low_mm;
  }
  const std::atomic<bool> never = false;
  const CompletedTooth tooth = in_terms_of(
      *scan_, [&] { return finish_tooth(*prepared, steering, {}, watching(Clock::now() + time_, &never)); });
  std::string bytes = tooth_view(tooth, {}, middle_of(scan_->file.mesh));
  const std::scoped_lock lock(mutex_);
  ghosts_[longest] = bytes;
  return bytes;
}

void Job::cancel() {
  cancelled_ = true;
  {
    const std::scoped_lock lock(mutex_);
    if (state_ != JobState::waiting) return;  // it ends at its next stage, or has ended
  }
  end(JobState::cancelled);
}

void Job::tell(std::string name, const Json& data) {
  {
    const std::scoped_lock lock(mutex_);
    events_.push_back({std::move(name), data.dump(-1, ' ', false, Json::error_handler_t::replace)});
  }
  changed_.notify_all();
}

void Job::end(JobState state, std::optional<Failure> failure) {
  {
    const std::scoped_lock lock(mutex_);
    if (state_ != JobState::waiting && state_ != JobState::running) return;
    state_ = state;
    failure_ = std::move(failure);
    events_.push_back({"end", Json{{"state", state_name(state)}}.dump()});
  }
  changed_.notify_all();
}

JobState Job::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

bool Job::has_ended() const {
  const JobState now = state();
  return now != JobState::waiting && now != JobState::running;
}

std::shared_ptr<const ToothResult> Job::tooth() const {
  const std::scoped_lock lock(mutex_);
  return tooth_;
}

std::shared_ptr<const ArchResult> Job::arch() const {
  const std::scoped_lock lock(mutex_);
  return arch_;
}

double Job::seconds() const {
  const std::scoped_lock lock(mutex_);
  return seconds_;
}

std::optional<Job::Failure> Job::failure() const {
  const std::scoped_lock lock(mutex_);
  return failure_;
}

std::vector<JobEvent> Job::events(std::size_t first, std::chrono::milliseconds wait) const {
  std::unique_lock lock(mutex_);
  const auto has_ended_now = [this] { return state_ != JobState::waiting && state_ != JobState::running; };
  changed_.wait_for(lock, wait, [&] { return events_.size() > first || has_ended_now(); });
  if (first >= events_.size()) return {};
  return {events_.begin() + static_cast<std::ptrdiff_t>(first), events_.end()};
}

}  // namespace rhizodont::serve
