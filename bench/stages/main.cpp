// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Every stage of completing a crown as a Google Benchmark, on two samples; then what scripts/count_guard.py counts.
// usage: bench_stages [--benchmark_filter=REGEX and the library's other options]
//        bench_stages --once: runs every stage once in `rhizodont_counted`, on the small sample with a peg for a root
//                             and one thread, and prints their names in that order
//        bench_stages --compiler: what it was built with, as far as counts hang on it

#include "base/with_threads.hpp"
#include "stages/stages.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Known by its name to callgrind, which counts from its entry to its exit.
extern "C" [[gnu::noinline]] void rhizodont_counted(const rhizodont::BenchStage& stage) { stage.run(); }

namespace rhizodont {
namespace {

const std::filesystem::path source = RHIZODONT_SOURCE_DIR;

std::shared_ptr<const CompletionModels> models() {
  return std::make_shared<CompletionModels>(CompletionModels::load(source / "models"));
}

/// On the smallest sample, coarse, so that it is quick under callgrind. What is made of several stages is left out.
void run_once() {
  with_threads(1, [] {
    for (const BenchStage& stage : stages_of(source / "samples/crown_23.ply", 23, 1, RootOfBench::peg, models())) {
      if (stage.name.starts_with("whole_")) continue;
      rhizodont_counted(stage);
      fmt::print("{}\n", stage.name);
    }
  });
}

void register_stages(const std::string& crown, int fdi, const std::shared_ptr<const CompletionModels>& models) {
  for (BenchStage& stage : stages_of(source / "samples" / crown, fdi, 0.5, RootOfBench::network, models))
    benchmark::RegisterBenchmark(fmt::format("{}/{}", stage.name, fdi).c_str(),
                                 [run = std::move(stage.run)](benchmark::State& state) {
                                   for ([[maybe_unused]] auto iteration : state) run();
                                 })
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime()
        ->UseRealTime();
}

int run(int argc, char** argv) {
  const std::vector<std::string_view> words(argv + 1, argv + argc);
  if (words.size() == 1 && words[0] == "--compiler")
    fmt::print("{} {}, glibc {}\n", RHIZODONT_COMPILER, RHIZODONT_FLAGS, gnu_get_libc_version());
  else if (words.size() == 1 && words[0] == "--once")
    run_once();
  else {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const std::shared_ptr<const CompletionModels> shared = models();
    register_stages("crown_36.stl", 36, shared);
    register_stages("crown_23.ply", 23, shared);
    benchmark::RunSpecifiedBenchmarks();
  }
  return 0;
}

}  // namespace
}  // namespace rhizodont

int main(int argc, char** argv) {
  try {
    return rhizodont::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
