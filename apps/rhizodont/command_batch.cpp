// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/manifest.hpp"
#include "batch/run_batch.hpp"
#include "batch/status.hpp"
#include "command_line/output_checks.hpp"
#include "command_line/output_options.hpp"
#include "command_line/terminal.hpp"
#include "commands.hpp"
#include "models_option.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/output_files.hpp"
#include "skirt_option.hpp"
#include "unit_option.hpp"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

namespace rhizodont::command_line {
namespace {

struct BatchCommand {
  std::string manifest, output, models, shard, skirt = "keep";
  BatchOptions options;
  OutputOptions said;
};

struct StatusCommand {
  std::string folder;
  OutputOptions said;
  bool by_case = false;
};

std::atomic<int> stop_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use no other");

/// The first signal asks for an orderly end; a second one of the same kind ends the program at once.
void heed_stop_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) continue;  // as nohup has it
    struct sigaction action {};
    action.sa_handler = [](int number) { stop_signal.store(number); };
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

std::optional<std::string> environment_variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

std::string left_text(const std::optional<double>& seconds) {
  return seconds ? fmt::format(", {} left", duration_text(*seconds)) : "";
}

std::string progress_text(const BatchProgress& progress) {
  std::string text = fmt::format("{} of {} cases", progress.dealt_with(), progress.cases);
  if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
  if (progress.partial > 0) text += fmt::format(", {} in part", progress.partial);
  return text + left_text(progress.seconds_left);
}

std::string case_text(const FinishedCase& one) {
  std::string text = fmt::format("case {}: ", one.id);
  text += one.teeth == 0 ? "no result" : fmt::format("{} of {} teeth have roots", one.rooted, one.teeth);
  text += one.from_before ? " (from before)" : fmt::format(" ({:.1f} s)", one.seconds);
  return one.teeth == one.rooted && one.teeth > 0 ? text : text + ": " + one.reason;
}

/// A line for each case in a log; on a terminal those that failed, and how far it is.
void say_finished(const FinishedCase& one, const BatchProgress& progress, bool is_verbose) {
  if (is_verbose || !is_terminal(stderr)) {
    fmt::print(stderr, "{}; {}\n", case_text(one), progress_text(progress));
    return;
  }
  fmt::print(stderr, "\r\033[K");
  if (one.code != 0) fmt::print(stderr, "{}\n", case_text(one));
  if (progress.dealt_with() < progress.cases) fmt::print(stderr, "{}", progress_text(progress));
  std::fflush(stderr);
}

BatchManifest load_manifest(const std::string& file) {
  try {
    return read_manifest(read_file_bytes(file), std::filesystem::path(file).parent_path());
  } catch (const InputError& error) {
    throw error.reworded(std::string("The manifest: ") + error.what());
  }
}

nlohmann::ordered_json figures_of(const BatchShard& shard, const BatchResult& result) {
  const BatchProgress& progress = result.progress;
  return {{"shard", shard.index + 1}, {"shards", shard.count},       {"cases", progress.cases},
          {"done", progress.done},    {"in_part", progress.partial}, {"failed", progress.failed},
          {"stopped", result.stopped}};
}

void run(BatchCommand& command) {
  if (command.manifest.empty()) throw UsageError("A batch needs a manifest: rhizodont batch MANIFEST.csv -o FOLDER.");
  if (command.output.empty()) throw UsageError("A batch needs a folder for its results (-o FOLDER).");
  require_folder_name(command.output, "results");
  BatchOptions& options = command.options;
  options.shard = command.shard.empty() ? shard_of_environment(environment_variable) : read_shard(command.shard);
  options.cases.crown.skirt = skirt_threshold(command.skirt);
  if (options.threads < 0) throw UsageError("--threads takes 0 or more.");
  options.cases.crown.e = options.cases.arch.tooth.e;
  options.cases.crown.millimetres_per_unit = options.cases.arch.tooth.millimetres_per_unit;
  const BatchManifest manifest = load_manifest(command.manifest);
  const std::filesystem::path models = models_folder(command.models, command.said);
  std::vector<std::filesystem::path> inputs = model_files(models);
  inputs.emplace_back(command.manifest);
  require_safe_outputs(inputs, command.said.outputs());
  const BatchModels loaded = load_batch_models(models);
  heed_stop_signals();
  BatchCallbacks callbacks;
  callbacks.stop = [] { return stop_signal.load() != 0; };
  if (!command.said.is_quiet())
    callbacks.finished = [verbose = command.said.is_verbose()](const FinishedCase& one, const BatchProgress& so_far) {
      say_finished(one, so_far, verbose);
    };
  const BatchResult result = run_batch(manifest, loaded, options, command.output, callbacks);
  const BatchProgress& progress = result.progress;
  write_output_files(command.said.print_or_file(figures_of(options.shard, result)));
  if (command.said.wants_words())
    fmt::print("shard {} of {}: {} of {} cases done, {} in part, {} failed{}\n", options.shard.index + 1,
               options.shard.count, progress.done, progress.cases, progress.partial, progress.failed,
               result.stopped ? "; stopped, the same command goes on" : "");
  if (result.stopped) {
    std::fflush(stdout);
    std::signal(stop_signal.load(), SIG_DFL);
    std::raise(stop_signal.load());
  }
  if (progress.failed + progress.partial > 0) exit_with(static_cast<int>(ErrorCode::partial));
}

void print_status(const BatchStatus& status, bool by_case) {
  fmt::print("{} cases: {} done, {} in part, {} failed, {} running, {} remaining{}\n", status.cases, status.done,
             status.partial, status.failed, status.running, status.remaining(), left_text(status.seconds_left));
  fmt::print("{} of {} teeth have roots\n", status.rooted, status.teeth);
  for (const ShardStatus& shard : status.shards) {
    fmt::print("shard {} of {}: {} of {} cases", shard.shard, shard.shards, shard.dealt_with, shard.cases);
    if (shard.state == RunState::ended) fmt::print(", ended\n");
    if (shard.state == RunState::silent)
      fmt::print(", silent for {}: was it killed?\n", duration_text(shard.seconds_since_last_line));
    if (shard.state == RunState::running)
      fmt::print("{}{}\n", shard.at.empty() ? ", running" : ", at case " + shard.at, left_text(shard.seconds_left));
  }
  constexpr std::size_t most_reasons = 20;
  for (std::size_t i = 0; i < status.reasons.size() && i < most_reasons; ++i)
    fmt::print("{} x {}\n", status.reasons[i].second, status.reasons[i].first);
  if (status.reasons.size() > most_reasons)
    fmt::print("and {} more reasons (--json)\n", status.reasons.size() - most_reasons);
  if (!by_case) return;
  for (const CaseStatus& one : status.by_case)
    fmt::print("case {}: {} of {} teeth, {}{}\n", one.id, one.rooted, one.teeth,
               one.key.empty() ? "no folder" : "cases/" + one.key, one.reason.empty() ? "" : ": " + one.reason);
}

void run_status(const StatusCommand& command) {
  const std::vector<std::filesystem::path> outputs = command.said.outputs();
  require_safe_outputs(files_below(std::filesystem::path(command.folder) / "ledger"), outputs);
  const double now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  const BatchStatus status = batch_status(command.folder, now);
  write_output_files(command.said.print_or_file(batch_status_json(status)));
  if (command.said.wants_words()) print_status(status, command.by_case);
}

void add_status_command(CLI::App& batch) {
  auto command = std::make_shared<StatusCommand>();
  CLI::App* status = batch.add_subcommand("status", "Where a batch stands, also while shards run");
  status->add_option("FOLDER", command->folder, "The batch's folder")->required();
  status->add_flag("--cases", command->by_case, "A line for each case, with the folder of its results");
  command->said.add_with_figures_to(*status);
  status->callback([command] { run_status(*command); });
}

void add_completion_options(CLI::App& batch, const std::shared_ptr<BatchCommand>& command) {
  CaseOptions& cases = command->options.cases;
  batch.add_option("--e", cases.arch.tooth.e, "Side of the lattice in mm, 0.2 to 2; new edges are about half of it")
      ->capture_default_str();
  batch.add_option("--output-format", cases.tooth_format, "Format of the teeth")
      ->check(CLI::IsMember({"ply", "stl", "obj", "glb"}))
      ->capture_default_str();
  add_unit_option(batch, cases.arch.tooth.millimetres_per_unit,
                  "Unit of files for which the manifest says none: mm, cm, m, um, in");
  CLI::Option* resolve =
      batch.add_flag("--resolve-collisions", cases.arch.resolve_collisions,
                     "Of arches: turn, bend or shorten roots that come too near to other teeth, by the least change");
  batch.add_option("--clearance", cases.arch.clearance_mm, "What they are to keep, mm, 0 to 3")
      ->needs(resolve)
      ->capture_default_str();
  batch.add_flag("--labels-vtp", cases.labels_vtp,
                 "Of arches: write the labels as labels.vtp, too (cells, FDI numbers)");
  batch.add_flag("--labels-vtk", cases.labels_vtk,
                 "Of arches: write the labels as labels.vtk, too (points, Universal_ID, 33 is gum)");
  batch
      .add_option("--skirt", command->skirt,
                  "Gum and webs around single crowns: keep, auto (drop), or drop below this CONFIDENCE of being tooth")
      ->type_name("TEXT:{keep,auto,...}")
      ->capture_default_str();
  batch.add_flag("--repair", cases.crown.repair, "Mend defective single crowns first; arches always are");
}

}  // namespace

void add_batch_command(CLI::App& app) {
  auto command = std::make_shared<BatchCommand>();
  CLI::App* batch = app.add_subcommand("batch", "Arches and crowns of many patients, in shards that can be stopped");
  // Not required, for `batch status` has none of them.
  batch->add_option("MANIFEST", command->manifest, "Table of cases (CSV): scan,labels,fdi,root_lengths,unit,id");
  batch->add_option("-o,--output", command->output, "Folder for results and ledger; all shards have the same");
  batch->add_option("--shard", command->shard,
                    "Part of the batch, 1/4 to 4/4; by default that of the Slurm array or indexed Kubernetes job");
  batch->add_flag("--retry-failed", command->options.retry_failed, "Do cases again that failed before");
  batch->add_flag("--keep-names", command->options.cases.keep_names,
                  "Names of files may stand in reports, ledger and messages; by default none does");
  add_completion_options(*batch, command);
  batch->add_option("--threads", command->options.threads, "At most so many threads; 0 = all")->capture_default_str();
  add_models_option(*batch, command->models);
  command->said.add_with_figures_to(*batch);
  add_status_command(*batch);
  batch->callback([command, batch] {
    if (batch->get_subcommands().empty()) run(*command);
  });
}

}  // namespace rhizodont::command_line
