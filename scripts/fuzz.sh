#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the fuzz targets with clang (Debian: clang), AddressSanitizer and UndefinedBehaviorSanitizer in a folder of their
# own and runs each over bytes of libFuzzer's making. Prints a table of all runs in that folder so far: hours, executions,
# per second, inputs kept, findings.
# usage: fuzz.sh [MINUTES=5, of each target] [TARGET ...]    those that have run least come first
#        fuzz.sh --table
# BUILD names the build folder (build-fuzz), JOBS how many targets run at a time (1). Inputs that reach new code are kept in
# BUILD/corpus, where the next run goes on, and what each run did is a line of BUILD/runs.tsv; findings are in BUILD/findings.
# A finding, once mended, goes to tests/fuzz/regressions/TARGET, which the tests run.
# Ends with 1 if there is a finding: a crash, an undefined operation, a broken rule, 10 s or 2 GB for one input.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build-fuzz}
export build

table() {
  echo "| target | hours | executions | per second | inputs kept | findings |"
  echo "|---|---|---|---|---|---|"
  awk -F '\t' '{ seconds[$1] += $2; runs[$1] += $3 } END { for (t in seconds) print t, seconds[t], runs[t] }' "$build/runs.tsv" | sort |
    while read -r target seconds runs; do
      kept=$(find "$build/corpus/$target" -type f | wc -l)
      findings=$(find "$build/findings/$target" -type f -not -name 'slow-unit*' | wc -l)
      awk -v target="$target" -v s="$seconds" -v runs="$runs" -v kept="$kept" -v findings="$findings" \
        'BEGIN { printf "| %s | %.2f | %d | %d | %d | %d |\n", target, s / 3600, runs, runs / (s > 0 ? s : 1), kept, findings }'
    done
}

if [ "${1:-}" = --table ]; then table; exit; fi
export minutes=${1:-5}
shift $(($# < 1 ? $# : 1))
launcher=$(command -v ccache || true)
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="${CXX:-clang++}" -DRHIZODONT_FUZZ=ON -DRHIZODONT_UNITY=OFF -DRHIZODONT_BENCH=OFF \
  -DRHIZODONT_WEB=OFF ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
cmake --build "$build" --target fuzz_programs > "$build/log.txt" 2>&1 || { tail -20 "$build/log.txt"; exit 1; }

# Vectors that libraries not built for sanitizers fill would be reported.
export ASAN_OPTIONS=detect_container_overflow=0
export UBSAN_OPTIONS=print_stacktrace=1
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  mapfile -t targets < <(
    for folder in tests/fuzz/corpus/*/; do
      target=$(basename "$folder")
      awk -F '\t' -v t="$target" '$1 == t { s += $2 } END { print s + 0, t }' "$build/runs.tsv" 2> /dev/null || echo "0 $target"
    done | sort -n | cut -d ' ' -f 2)
fi

# shellcheck disable=SC2317 # called by xargs
run_one() {
  local target=$1 failed=0 corpus="$build/corpus/$1" findings="$build/findings/$1" log="$build/$1.txt"
  mkdir -p "$corpus" "$findings"
  local committed=("tests/fuzz/corpus/$target")
  [ -d "tests/fuzz/regressions/$target" ] && committed+=("tests/fuzz/regressions/$target")
  "$build/tests/fuzz/fuzz_$target" "$corpus" "${committed[@]}" -max_total_time="$(awk "BEGIN { print int(60 * $minutes) }")" \
    -dict="tests/fuzz/dictionaries/$target.dict" -max_len=8192 -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$findings/" > "$log" 2>&1 || failed=1
  awk -v target="$target" -v commit="$(git rev-parse --short HEAD)" -v OFS='\t' '
    /^Done / { seconds = $(NF - 1) } /number_of_executed_units/ { runs = $2 } /average_exec_per_sec/ { each = $2 }
    END { print target, seconds ? seconds : runs / (each ? each : 1), runs + 0, commit }' "$log" >> "$build/runs.tsv"
  return "$failed"
}
export -f run_one

bad=0
# shellcheck disable=SC2016 # for the inner shell
printf '%s\n' "${targets[@]}" | xargs -P "${JOBS:-1}" -I{} bash -c 'run_one "$1"' - {} || bad=1
table
exit $bad
