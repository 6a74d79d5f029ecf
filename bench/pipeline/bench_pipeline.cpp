// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// How the time of `complete_tooth` grows with the crown's vertices and with 1 / e^2.
// usage: bench_pipeline [CSV] [VERTICES ...]. Processor seconds are printed beside wall-clock seconds, since other work
// on the machine does not change them.

#include "base/peak_memory.hpp"
#include "common/hostile_crowns.hpp"
#include "common/timing.hpp"
#include "rhizodont/complete.hpp"
#include "rhizodont/error.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace rhizodont {
namespace {

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Measurement {
  double size = 0;  // vertices, or 1 / e^2
  double wall = 0, processor = 0;
  std::vector<StageRecord> stages;
};

/// The quickest of some runs.
Measurement measure(const TriangleMesh& crown, const CompletionModels& models, double e, double size, int repeats) {
  CompleteOptions options;
  options.fdi = 36;
  options.e = e;
  Measurement best;
  for (int i = 0; i < repeats; ++i) {
    const double before = processor_seconds();
    Measurement now;
    now.stages = complete_tooth(crown, models, options).record.stages;
    now.processor = processor_seconds() - before;
    now.size = size;
    for (const StageRecord& s : now.stages) now.wall += s.seconds;
    if (i == 0 || now.processor < best.processor) best = now;
  }
  return best;
}

/// t = constant + slope * size with the least squared relative errors.
struct Line {
  double constant = 0, slope = 0, largest_deviation = 0;
};

Line fit_line(const std::vector<Measurement>& all) {
  double s = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
  for (const Measurement& m : all) {
    const double w = 1 / (m.processor * m.processor);
    s += w, sx += w * m.size, sxx += w * m.size * m.size, sy += w * m.processor, sxy += w * m.size * m.processor;
  }
  Line line;
  line.slope = (s * sxy - sx * sy) / (s * sxx - sx * sx);
  line.constant = (sy - line.slope * sx) / s;
  for (const Measurement& m : all)
    line.largest_deviation =
        std::max(line.largest_deviation, std::abs(m.processor / (line.constant + line.slope * m.size) - 1));
  return line;
}

void print_table(const char* title, const char* first_column, const std::vector<Measurement>& all) {
  fmt::print("\n{}\n\n| {} |", title, first_column);
  for (const StageRecord& s : all.front().stages) fmt::print(" {} |", s.name);
  fmt::print(" wall, s | processor, s |\n|---|");
  for (std::size_t i = 0; i < all.front().stages.size() + 2; ++i) fmt::print("---|");
  std::vector<double> sizes, seconds;
  for (const Measurement& m : all) {
    fmt::print("\n| {:.6g} |", m.size);
    for (const StageRecord& s : m.stages) fmt::print(" {:.2f} |", s.seconds);
    fmt::print(" {:.2f} | {:.2f} |", m.wall, m.processor);
    sizes.push_back(m.size);
    seconds.push_back(m.processor);
  }
  const Line line = fit_line(all);
  const LinearGrowth through_origin = fit_linear_growth(sizes, seconds);
  fmt::print(
      "\n\nProcessor seconds = {:.3f} + {:.4g} x size, largest deviation {:.1f} %; through the origin alone {:.4g} x "
      "size, {:.1f} %.\n",
      line.constant, line.slope, 100 * line.largest_deviation, through_origin.seconds_per_unit,
      100 * through_origin.largest_deviation);
}

void write_rows(std::FILE* file, const char* what, const std::vector<Measurement>& all) {
  for (const Measurement& m : all) fmt::print(file, "{},{:.9g},{:.4f},{:.4f}\n", what, m.size, m.wall, m.processor);
}

void run(const std::vector<std::string>& arguments) {
  const std::filesystem::path source = RHIZODONT_SOURCE_DIR;
  const CompletionModels models = CompletionModels::load(source / "models");
  const TriangleMesh molar = load_mesh(source / "samples/crown_36.stl").mesh;
  std::vector<std::size_t> sizes;
  for (std::size_t i = 1; i < arguments.size(); ++i) sizes.push_back(std::stoul(arguments[i]));
  if (sizes.empty()) sizes = {6000, 12000, 25000, 50000, 100000};

  std::vector<Measurement> by_size, by_e;
  measure(molar, models, 0.5, 0, 1);  // the first run loads what is loaded once
  for (const std::size_t n : sizes)
    by_size.push_back(measure(test::refined_to(molar, n), models, 0.5, static_cast<double>(n), n < 40000 ? 3 : 2));
  for (const double e : {1.0, 0.75, 0.5, 0.35, 0.25, 0.2}) by_e.push_back(measure(molar, models, e, 1 / (e * e), 3));
  fmt::print("Lower first molar (samples/crown_36.stl), {} vertices; peak memory {:.0f} MB.\n", molar.vertices.size(),
             peak_memory_mb());
  print_table("Refined, e = 0.5 mm:", "vertices", by_size);
  print_table("As it is, by 1 / e^2:", "1/e^2, 1/mm2", by_e);
  if (arguments.empty()) return;
  std::FILE* file = std::fopen(arguments[0].c_str(), "w");
  if (file == nullptr) throw InputError(arguments[0] + " cannot be written");
  fmt::print(file, "by,size,wall_s,processor_s\n");
  write_rows(file, "vertices", by_size);
  write_rows(file, "1/e^2", by_e);
  std::fclose(file);
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  try {
    rhizodont::run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
