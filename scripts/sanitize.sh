#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the program and the geometry's tests with AddressSanitizer and UndefinedBehaviorSanitizer in a folder of their
# own, runs the tests, completes and checks crowns, and ends with a line that says how many tests ran clean.
# usage: sanitize.sh [BUILD=build-sanitize] [SANITIZERS=address,undefined] [CROWN.ply FDI]
# The crown defaults to a real one of ../shared/data where that folder is, else only the sample is completed. Assertions
# and vectors' index checks are on. Any finding ends the test at once, and the script with 1.
# Left out: the tests of training and families, which are slow.
# ThreadSanitizer is of no use: libtbb is not built for it, it does not see how it synchronises, and reports races in every
# parallel loop. That results are the same for any number of threads is tested instead.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build-sanitize}
sanitizers=${2:-address,undefined}
crown=${3:-../shared/data/validation/crown_36.ply}
fdi=${4:-36}
rooms=(mesh io operators networks completion poisson isosurface voronoi skirt fusion evaluation pipeline hostile_crowns)
launcher=$(command -v ccache || true)
cmake -S . -B "$build" -G Ninja -DRHIZODONT_SANITIZE="$sanitizers" -DRHIZODONT_BENCH=OFF \
  ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
ninja -C "$build" "${rooms[@]/#/test_}" rhizodont

# Vectors that libraries not built for sanitizers fill would be reported.
export ASAN_OPTIONS=detect_stack_use_after_return=1:detect_container_overflow=0
export UBSAN_OPTIONS=print_stacktrace=1
clean=0 bad=0
for room in "${rooms[@]}"; do
  log="$build/$room.txt"
  folder=$room
  [ "$room" = hostile_crowns ] && folder=pipeline
  if "$build/tests/$folder/test_$room" > "$log" 2>&1; then
    passed=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) tests\{0,1\}\..*/\1/p' "$log")
    clean=$((clean + passed))
    echo "$room: $passed tests"
  else
    bad=$((bad + 1))
    echo "$room: see $log"
    grep -E -m 5 'runtime error|ERROR: AddressSanitizer|^\[  FAILED' "$log" || tail -5 "$log"
  fi
done
program="$build/apps/rhizodont/rhizodont"
[ -e "$crown" ] || crown=samples/crown_36.stl fdi=36
tooth="$build/tooth.ply"
if "$program" complete "$crown" --fdi "$fdi" -o "$tooth" --report "$build/tooth.json" --quiet &&
  "$program" check "$crown" "$tooth" > "$build/check.txt"; then
  clean=$((clean + 1))
  echo "complete and check of $crown"
else
  bad=$((bad + 1))
  echo "complete or check of $crown failed"
fi
echo "$clean tests ran clean with $sanitizers, $bad rooms or commands did not"
[ $bad -eq 0 ]
