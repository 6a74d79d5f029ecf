// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/complete_case.hpp"

#include "report/without_names.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

/// Sentences on a case's files, without their names unless these may be told.
class Wording {
 public:
  Wording(const BatchCase& one, const CaseOptions& options) : keep_(options.keep_names) {
    if (keep_) return;
    files_ = {one.scan, fs::path(one.scan_as_given), one.labels.labels, one.labels.palette};
    for (const fs::path& file : files_of_case(one)) files_.push_back(file);
  }

  std::string operator()(const std::string& sentence) const {
    return keep_ ? sentence : without_names(sentence, files_);
  }

 private:
  bool keep_;
  std::vector<fs::path> files_;
};

std::optional<std::string> shown_name(const BatchCase& one, const CaseOptions& options) {
  return options.keep_names ? std::optional(one.scan.filename().string()) : std::nullopt;
}

ToothOutcome outcome_of(int fdi, const CompletionRecord& record, const std::string& format) {
  return {fdi,
          true,
          {},
          fmt::format("tooth_{}.{}", fdi, format),
          record.root.length_mm,
          record.crown.triangles,
          record.crown.kept_triangles};
}

void require_same(const std::string& sha256, const CaseKey& key) {
  if (sha256 != key.scan_sha256) throw InputError("The file changed while it was read.");
}

BatchOutcome complete_scan(const BatchCase& one, const CaseKey& key, const BatchModels& models,
                           const CaseOptions& options, const Wording& worded, const std::function<void()>& go_on) {
  ArchOptions arch_options = options.arch;
  arch_options.root_lengths = one.root_lengths;
  arch_options.tooth.threads = 0;  // the batch's own
  if (one.millimetres_per_unit) arch_options.tooth.millimetres_per_unit = *one.millimetres_per_unit;
  ScanLabelSource labels = one.labels;
  if (models.finder)
    labels.find = [&](const TriangleMesh& scan, const SegmentOptions& search) {
      go_on();
      return segment_scan(scan, *models.finder, search);
    };
  ScanInput input = read_scan(one.scan, labels, arch_options.tooth.millimetres_per_unit);
  require_same(input.sha256, key);
  for (std::string& note : input.notes) note = worded(note);
  CompletedArch arch = complete_arch(input.scan, models.completion, arch_options, [&](int, int, int) { go_on(); });
  const ArchFileOptions files{options.tooth_format, shown_name(one, options), options.labels_vtp, options.labels_vtk};
  refuse_what_no_file_holds(arch, files);
  BatchOutcome outcome;
  for (ToothOfArch& tooth : arch.teeth) {
    if (!tooth.tooth) {
      outcome.teeth.push_back({tooth.fdi, false, tooth.refusal, {}, 0, 0, 0});
      continue;
    }
    tooth.tooth->record.stages.clear();
    outcome.teeth.push_back(outcome_of(tooth.fdi, tooth.tooth->record, options.tooth_format));
  }
  outcome.files = arch_files(input, arch, arch_options, files, {});
  const std::size_t rooted = outcome.rooted();
  if (rooted == outcome.teeth.size()) return outcome;
  outcome.code = static_cast<int>(rooted == 0 ? ErrorCode::no_result : ErrorCode::partial);
  outcome.reason = fmt::format("{} of {} teeth have no root.", outcome.teeth.size() - rooted, outcome.teeth.size());
  return outcome;
}

BatchOutcome complete_crown(const BatchCase& one, const CaseKey& key, const CompletionModels& models,
                            const CaseOptions& options, const Wording& worded, const std::function<void()>& go_on) {
  CompleteOptions tooth_options = options.crown;
  tooth_options.threads = 0;
  tooth_options.fdi = one.fdi ? one.fdi : fdi_in_name(one.scan);
  if (one.root_length) tooth_options.steering.length_mm = one.root_length;
  if (one.millimetres_per_unit) tooth_options.millimetres_per_unit = *one.millimetres_per_unit;
  const ReportedInput input{key.scan_sha256, shown_name(one, options), {}};
  std::vector<std::string> notes;
  BatchOutcome outcome;
  const auto refuse = [&](const Error& error) {
    outcome.code = static_cast<int>(error.code());
    outcome.reason = error.what();
    outcome.teeth = {{tooth_options.fdi.value_or(0), false, error.what(), {}, 0, 0, 0}};
    outcome.files = {{"refusal.json", completion_refusal_report(error, tooth_options, input, notes)}};
    return outcome;
  };
  MeshFile crown;
  try {
    const std::string bytes = read_file_bytes(one.scan);
    require_same(sha256_of_bytes(bytes), key);
    crown = read_mesh(bytes, "crown" + ending_of(one.scan));
    if (!one.fdi && tooth_options.fdi)
      crown.notes.push_back(fmt::format("Tooth {}, taken from the file's name.", *tooth_options.fdi));
    for (std::string& note : crown.notes) note = worded(note);
    notes = crown.notes;
    if (!crown.coordinates_fit_float && holds_floats_only("tooth." + options.tooth_format))
      throw UsageError("The crown has coordinates with more digits than the format of the teeth can hold.");
    CompletedTooth tooth = complete_tooth(crown.mesh, models, tooth_options, [&](std::string_view) { go_on(); });
    tooth.record.stages.clear();
    const ToothOutcome made = outcome_of(tooth.record.fdi, tooth.record, options.tooth_format);
    require_format_holds(tooth, made.file);
    outcome.files.push_back({made.file, mesh_file_bytes(made.file, tooth_file(tooth, crown))});
    refer_to_file(tooth.record, crown, made.file);
    outcome.files.push_back({fmt::format("tooth_{}.json", made.fdi), completion_report(tooth, input)});
    outcome.teeth = {made};
    return outcome;
  } catch (const InputError& error) {
    const InputError numbered = in_terms_of_file(error, crown);
    return refuse(numbered.reworded(worded(numbered.what())));
  } catch (const NoResultError& error) {
    return refuse(in_terms_of_file(error, crown));
  } catch (const UsageError& error) {
    return refuse(error);
  }
}

}  // namespace

std::size_t BatchOutcome::rooted() const {
  return static_cast<std::size_t>(
      std::count_if(teeth.begin(), teeth.end(), [](const ToothOutcome& tooth) { return tooth.rooted; }));
}

BatchOutcome complete_case(const BatchCase& one, const CaseKey& key, const BatchModels& models,
                           const CaseOptions& options, const std::function<void()>& go_on) {
  const Wording worded(one, options);
  if (one.is_crown) return complete_crown(one, key, models.completion, options, worded, go_on);
  const auto refused = [&](const Error& error) {
    return BatchOutcome{static_cast<int>(error.code()), worded(error.what()), {}, {}};
  };
  try {
    return complete_scan(one, key, models, options, worded, go_on);
  } catch (const InputError& error) {
    return refused(error);
  } catch (const NoResultError& error) {
    return refused(error);
  } catch (const UsageError& error) {
    return refused(error);
  }
}

}  // namespace rhizodont
