// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The figures of "Completing Dental Models While Preserving Crown Geometry and Meshing Topology", tables 3 and 5, on
// the validation teeth, and the time of each stage and step. usage: bench_fusion DATA_FOLDER MODELS_FOLDER [REPEATS=5]

#include "base/peak_memory.hpp"
#include "common/bench_teeth.hpp"
#include "common/timing.hpp"
#include "rhizodont/complete.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace rhizodont;

struct Row {
  int fdi = 0;
  CompletedTooth tooth;         // its record has the shortest time of each stage and step
  double geometry_seconds = 0;  // shortest in one run
  double whole_seconds = 0;     // likewise, with the networks
};

void take_shortest(const std::vector<StageRecord>& run, std::vector<StageRecord>& best) {
  for (std::size_t i = 0; i < best.size(); ++i) best[i].seconds = std::min(best[i].seconds, run[i].seconds);
}

Row complete_often(const BenchTooth& input, const CompletionModels& models, int repeats) {
  CompleteOptions options;
  options.fdi = input.fdi;
  Row row;
  row.fdi = input.fdi;
  for (int i = 0; i < repeats; ++i) {
    CompletedTooth tooth = complete_tooth(input.crown, models, options);
    double geometry = 0, whole = 0;
    for (const StageRecord& stage : tooth.record.stages) {
      whole += stage.seconds;
      if (stage.name != "completion network") geometry += stage.seconds;
    }
    row.geometry_seconds = i == 0 ? geometry : std::min(row.geometry_seconds, geometry);
    row.whole_seconds = i == 0 ? whole : std::min(row.whole_seconds, whole);
    if (i > 0) {
      take_shortest(row.tooth.record.stages, tooth.record.stages);
      take_shortest(row.tooth.record.joining.steps, tooth.record.joining.steps);
    }
    row.tooth = std::move(tooth);
  }
  return row;
}

void print_quality(const std::vector<Row>& rows) {
  fmt::print(
      "## New triangles (table 5 of the paper has all triangles of the tooth beside; here: not the crown's)\n\n");
  fmt::print(
      "| | tooth | Q avg | Q min | theta avg | theta min | % < 30 | theta min, no crown vertex | theta min, border | "
      "triangles | promise 3 |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const NewTriangleFigures& f = row.tooth.record.promises.new_triangles;
    const QualityFigures all = f.all.value_or(QualityFigures{});
    fmt::print("| Rhizodont | {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {} | {} |\n", row.fdi,
               all.q_avg, all.q_min, all.theta_avg, all.theta_min, all.percent_below_30,
               f.inner.value_or(QualityFigures{}).theta_min, f.at_border.value_or(QualityFigures{}).theta_min,
               all.triangles, f.holds() ? "kept" : "not kept");
  }
  struct PaperRow {
    const char* method;
    int tooth;
    double q_avg, q_min, theta_avg, theta_min, below_30;
  };
  constexpr std::array<PaperRow, 14> paper{{{"IPSR (paper)", 11, 0.60, 1.60e-4, 32.23, 5.37e-3, 39.62},
                                            {"paper", 11, 0.84, 8.75e-2, 48.67, 4.47, 2.82},
                                            {"IPSR (paper)", 12, 0.61, 7.25e-5, 32.07, 5.06e-3, 40.01},
                                            {"paper", 12, 0.85, 1.02e-2, 48.83, 0.58, 2.82},
                                            {"IPSR (paper)", 13, 0.61, 6.42e-4, 32.43, 1.61e-2, 38.70},
                                            {"paper", 13, 0.84, 6.27e-2, 48.37, 3.75, 3.10},
                                            {"IPSR (paper)", 14, 0.60, 1.53e-4, 31.98, 1.66e-2, 40.27},
                                            {"paper", 14, 0.85, 3.43e-2, 49.04, 1.94, 2.60},
                                            {"IPSR (paper)", 15, 0.60, 2.32e-4, 32.12, 1.34e-2, 39.49},
                                            {"paper", 15, 0.85, 4.66e-2, 48.82, 2.61, 2.87},
                                            {"IPSR (paper)", 16, 0.61, 2.57e-5, 32.58, 1.04e-2, 38.26},
                                            {"paper", 16, 0.85, 1.67e-2, 48.90, 1.04, 2.80},
                                            {"IPSR (paper)", 17, 0.61, 7.25e-6, 32.38, 6.01e-3, 38.77},
                                            {"paper", 17, 0.85, 1.83e-3, 48.97, 1.12, 3.09}}};
  for (const PaperRow& p : paper)
    fmt::print("| {} | {} | {:.2f} | {:.2g} | {:.2f} | {:.3g} | {:.2f} | | | | |\n", p.method, p.tooth, p.q_avg,
               p.q_min, p.theta_avg, p.theta_min, p.below_30);
}

void print_deviation(const std::vector<Row>& rows) {
  fmt::print(
      "\n## Crown vertices by their distance from the result, mm (table 3), and triangles of the crown in the "
      "dual\n\n");
  fmt::print(
      "| | tooth | total | to 1e-3 | to 1e-2 | to 1e-1 | over | triangles from the dual | brought back |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows) {
    const CompletionRecord& r = row.tooth.record;
    const auto bins = r.promises.crown.deviation.value_or(CrownDeviation{}).bins;
    fmt::print("| Rhizodont | {} | {} | {} | {} | {} | {} | {:.2f} % | {} |\n", row.fdi, r.promises.crown.vertices,
               bins[0], bins[1], bins[2], bins[3], 100.0 * r.joining.crown_triangles_direct / r.crown.kept_triangles,
               r.joining.crown_triangles_restored);
  }
  constexpr std::array<std::array<int, 5>, 7> paper{{{11, 1828, 1435, 393, 0},
                                                     {12, 1455, 1116, 328, 11},
                                                     {13, 1522, 1235, 287, 0},
                                                     {14, 1907, 1598, 309, 0},
                                                     {15, 2116, 1759, 354, 3},
                                                     {16, 2091, 1693, 392, 6},
                                                     {17, 2080, 1763, 315, 2}}};
  for (const auto& p : paper) fmt::print("| paper | {} | {} | {} | {} | {} | | | |\n", p[0], p[1], p[2], p[3], p[4]);
}

void print_seconds(const std::string& title, const std::vector<Row>& rows,
                   const std::vector<StageRecord>& (*steps_of)(const CompletionRecord&)) {
  fmt::print("\n## {}\n\n| tooth |", title);
  const std::size_t columns = steps_of(rows.front().tooth.record).size();
  for (const StageRecord& stage : steps_of(rows.front().tooth.record)) fmt::print(" {} |", stage.name);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < columns; ++i) fmt::print("---|");
  for (const Row& row : rows) {
    fmt::print("\n| {} |", row.fdi);
    for (const StageRecord& stage : steps_of(row.tooth.record)) fmt::print(" {:.3f} |", stage.seconds);
  }
  fmt::print("\n");
}

void print_sums(const std::vector<Row>& rows) {
  fmt::print("\n## Seconds of whole runs, and peak memory\n\n| tooth | geometry | with the network |\n|---|---|---|\n");
  for (const Row& row : rows)
    fmt::print("| {} | {:.3f} | {:.3f} |\n", row.fdi, row.geometry_seconds, row.whole_seconds);
  fmt::print("\nPeak memory of the process, networks loaded: {:.0f} MB.\n", peak_memory_mb());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: bench_fusion DATA_FOLDER MODELS_FOLDER [REPEATS=5]\n");
    return 2;
  }
  try {
    const int repeats = argc > 3 ? std::max(1, std::atoi(argv[3])) : 5;
    const CompletionModels models = CompletionModels::load(argv[2]);
    std::vector<Row> rows;
    for (const BenchTooth& tooth : load_validation_teeth(argv[1]))
      rows.push_back(complete_often(tooth, models, repeats));
    print_quality(rows);
    print_deviation(rows);
    const std::string best = fmt::format(", best of {}", repeats);
    print_seconds(
        "Seconds by stage" + best, rows, [](const CompletionRecord& record) -> const auto& { return record.stages; });
    print_seconds(
        "Seconds of the steps of joining" + best, rows,
        [](const CompletionRecord& record) -> const auto& { return record.joining.steps; });
    print_sums(rows);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
