// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate_labels.hpp"

#include "command_line/output_checks.hpp"
#include "evaluation/segmentation_figures.hpp"
#include "io/scan_labels.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/io.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace rhizodont::command_line {
namespace {

std::vector<std::filesystem::path> labelled_scans(const std::filesystem::path& folder) {
  static const std::set<std::string> endings{".ply", ".stl", ".obj", ".off", ".vtp", ".vtk"};
  std::vector<std::filesystem::path> scans;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    std::filesystem::path labels = entry.path();
    labels.replace_extension(".json");
    if (endings.contains(entry.path().extension().string()) && std::filesystem::exists(labels))
      scans.push_back(entry.path());
  }
  if (scans.empty()) throw InputError(folder.string() + " has no scan with labels (SCAN.json) beside it.");
  std::sort(scans.begin(), scans.end());
  return scans;
}

std::vector<int> labels_in(const std::filesystem::path& json, const MeshFile& scan) {
  return labels_from_teeth3ds(read_file_bytes(json), scan).per_vertex;
}

/// What is wrong with a scan's teeth, in short.
std::string errors_of(const SegmentationFigures& figures) {
  std::string text;
  for (const FoundToothFigures& tooth : figures.teeth)
    if (!tooth.is_right())
      text += fmt::format(" {}{}", tooth.fdi,
                          tooth.is_found()            ? fmt::format("={}", tooth.most_like)
                          : tooth.most_overlap > 0.05 ? fmt::format("~{}({:.2f})", tooth.most_like, tooth.most_overlap)
                                                      : "-");
  for (const int extra : figures.extra) text += fmt::format(" +{}", extra);
  return text;
}

}  // namespace

void evaluate_labels(const std::filesystem::path& scans, const std::filesystem::path& found,
                     const OutputOptions& said) {
  std::vector<std::filesystem::path> inputs = files_below(scans);
  for (const std::filesystem::path& file : files_below(found)) inputs.push_back(file);
  require_safe_outputs(inputs, said.outputs());
  std::vector<SegmentationFigures> all;
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  if (said.wants_words())
    fmt::print("{:<28}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}  {}\n", "scan", "TSA", "TLA", "TIR", "strict", "faces", "IoU",
               "wrong: =taken for, ~in part, -not there, +extra");
  for (const std::filesystem::path& path : labelled_scans(scans)) {
    said.detail(path.string());
    const MeshFile scan = load_mesh(path);
    std::filesystem::path truth = path;
    truth.replace_extension(".json");
    const std::filesystem::path answer = found / truth.filename();
    const std::vector<int> labels =
        std::filesystem::exists(answer) ? labels_in(answer, scan) : std::vector<int>(scan.mesh.vertices.size(), 0);
    const SegmentationFigures f = segmentation_figures(scan.mesh, labels_in(truth, scan), labels);
    if (said.wants_words())
      fmt::print("{:<28}{:>8.4f}{:>8.4f}{:>8.4f}{:>8}{:>8.4f}{:>8.4f} {}\n", path.stem().string(), f.tsa, f.tla, f.tir,
                 fmt::format("{}/{}", f.right(), f.teeth.size()), f.faces_right, f.mean_overlap(), errors_of(f));
    all.push_back(f);
    figures.push_back(f);
    figures.back()["scan"] = path.stem().string();
  }
  const SegmentationSummary summary = summary_of(all);
  write_output_files(said.print_or_file({{"scans", figures}, {"summary", summary}}));
  if (said.wants_words()) fmt::print("{}", describe(summary));
}

}  // namespace rhizodont::command_line
