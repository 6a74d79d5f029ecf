#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the fuzz targets with clang (Debian: clang), AddressSanitizer and UndefinedBehaviorSanitizer in a folder of their
# own, runs each over bytes of libFuzzer's making, and prints a table: seconds, executions, per second, inputs kept, findings.
# usage: fuzz.sh [MINUTES=5, of each target] [TARGET ...]
# BUILD names the build folder (build-fuzz). Inputs that reach new code are kept in BUILD/corpus, where the next run goes on;
# findings are in BUILD/findings. A finding, once mended, goes to tests/fuzz/regressions/TARGET, which the tests run.
# Ends with 1 if there is a finding: a crash, an undefined operation, a broken rule, 10 s or 2 GB for one input.
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:-5}
shift $(($# < 1 ? $# : 1))
build=${BUILD:-build-fuzz}
launcher=$(command -v ccache || true)
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-clang++}" -DRHIZODONT_FUZZ=ON -DRHIZODONT_UNITY=OFF -DRHIZODONT_BENCH=OFF \
  -DRHIZODONT_WEB=OFF ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
cmake --build "$build" --target fuzz_programs > "$build/log.txt" 2>&1 || { tail -20 "$build/log.txt"; exit 1; }

# Vectors that libraries not built for sanitizers fill would be reported.
export ASAN_OPTIONS=detect_container_overflow=0
export UBSAN_OPTIONS=print_stacktrace=1
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for folder in tests/fuzz/corpus/*/; do targets+=("$(basename "$folder")"); done
fi
bad=0
echo "| target | s | executions | per second | inputs kept | findings |"
echo "|---|---|---|---|---|---|"
for target in "${targets[@]}"; do
  corpus="$build/corpus/$target" findings="$build/findings/$target" log="$build/$target.txt"
  regressions="tests/fuzz/regressions/$target"
  mkdir -p "$corpus" "$findings"
  committed=("tests/fuzz/corpus/$target")
  [ -d "$regressions" ] && committed+=("$regressions")
  "$build/tests/fuzz/fuzz_$target" "$corpus" "${committed[@]}" -max_total_time="$(awk "BEGIN { print int(60 * $minutes) }")" \
    -dict="tests/fuzz/dictionaries/$target.dict" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$findings/" > "$log" 2>&1 || bad=1
  awk -v target="$target" -v kept="$(find "$corpus" -type f | wc -l)" -v findings="$(find "$findings" -type f -not -name 'slow-unit*' | wc -l)" '
    / DONE / { seconds = 0 } /^Done / { seconds = $(NF - 1) }
    /number_of_executed_units/ { runs = $2 } /average_exec_per_sec/ { each = $2 }
    END { printf "| %s | %s | %s | %s | %s | %s |\n", target, seconds + 0, runs, each, kept, findings }' "$log"
done
exit $bad
