#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Runs the tests built with sanitizers, in a build folder of their own, once a week:
# AddressSanitizer and UndefinedBehaviorSanitizer over the whole test suite, and then, if no room is named, completing and checking a crown;
# ThreadSanitizer over the stages that work in parallel.
# usage: sanitize.sh [--document] [address,undefined | thread] [ROOM ...]
#   ROOM: a test's name (base, mesh, ...); all rooms by default, with thread those whose code is parallel.
#   --document: writes or replaces the rooms' rows in docs/faults.md. BUILD names the folder (build-sanitize, build-sanitize-thread),
#   JOBS how much is compiled at a time, CROWN and FDI the crown (the validation crown 36 of ../shared/data, else the sample).
# Assertions and vectors' index checks are on. Any finding ends a room's tests at once, and the script with 1. Half an hour to build on
# two cores. Python's, the program's and the page's tests are no part of it: they run other processes.
# ThreadSanitizer sees only what it has built: Debian's oneTBB, not built for it, would look like a race in every parallel loop. So its
# source package is fetched (dpkg-dev; needs the network the first time) and built for it. BLAS has one thread meanwhile.
set -euo pipefail
cd "$(dirname "$0")/.."
document=
[ "${1:-}" != --document ] || { document=1; shift; }
sanitizers=${1:-address,undefined}
shift $(($# > 0 ? 1 : 0))
rooms=("$@")
program=
[ ${#rooms[@]} -gt 0 ] || [ "$sanitizers" = thread ] || program=rhizodont
case $sanitizers in
  thread)
    build=${BUILD:-build-sanitize-thread}
    [ ${#rooms[@]} -gt 0 ] || rooms=(base mesh networks completion segment poisson isosurface guiding voronoi skirt check fusion pipeline arch batch serve)
    ;;
  *)
    build=${BUILD:-build-sanitize}
    # Tests of training and of generated families take hours with sanitizers.
    [ ${#rooms[@]} -gt 0 ] ||
      mapfile -t rooms < <(sed -n 's/^ *rhizodont_test(\([a-z_]*\).*/\1/p' tests/*/CMakeLists.txt | grep -vxE 'app|bench|families|learning|training')
    ;;
esac
launcher=$(command -v ccache || true)
cmake -S . -B "$build" -G Ninja -DRHIZODONT_SANITIZE="$sanitizers" -DRHIZODONT_BENCH=OFF -DRHIZODONT_WEB=OFF \
  ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
build=$(realpath "$build")

# oneTBB of Debian's source package, in $build/tbb
build_tbb() {
  [ ! -e "$build/tbb/libtbb.so.12" ] || return 0
  local fetched="$build/tbb_source"
  mkdir -p "$fetched/parts" "$fetched/lists/partial" "$fetched/cache/archives/partial" "$build/tbb"
  sed 's/^Types: deb$/Types: deb-src/' /etc/apt/sources.list.d/debian.sources > "$fetched/parts/debian.sources"
  local apt=(apt-get -qq -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$fetched/parts"
    -o Dir::State::Lists="$fetched/lists" -o Dir::Cache="$fetched/cache")
  "${apt[@]}" update
  (cd "$fetched" && "${apt[@]}" source --download-only onetbb && mkdir -p tbb && tar xf onetbb_*.orig.tar.xz -C tbb --strip-components 1)
  cmake -S "$fetched/tbb" -B "$fetched/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DTBBMALLOC_BUILD=OFF -DTBB_SANITIZE=thread -DCMAKE_CXX_FLAGS="-O1 -g1" > /dev/null
  ninja -C "$fetched/build" ${JOBS:+-j "$JOBS"} > "$fetched/build.txt"
  cp -P "$fetched"/build/*_release/libtbb.so* "$build/tbb/"
}
[ "$sanitizers" != thread ] || build_tbb
ninja -C "$build" ${JOBS:+-j "$JOBS"} "${rooms[@]/#/test_}" $program

# Vectors that libraries not built for sanitizers fill would be reported.
export ASAN_OPTIONS=detect_stack_use_after_return=1:detect_container_overflow=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1:exitcode=66
run=()
if [ "$sanitizers" = thread ]; then
  export LD_LIBRARY_PATH="$build/tbb" OMP_NUM_THREADS=1
  # ThreadSanitizer does not know as widely strewn addresses as newer kernels give.
  run=(setarch "$(uname -m)" -R)
fi
state="$(git rev-parse --short HEAD)$(git diff --quiet HEAD -- src include tests || echo ' with changes'), $(date -u +%F)"
rows="$build/rows.md"
: > "$rows"
# note WHAT TESTS FINDINGS SECONDS
note() { echo "| $sanitizers | $1 | $2 | $3 | $4 | $state |" | tee -a "$rows"; }

bad=0
for room in "${rooms[@]}"; do
  log="$build/$room.txt"
  began=$(date +%s)
  found=0
  "${run[@]}" "$build"/tests/*/test_"$room" > "$log" 2>&1 || found=1
  passed=$(sed -n 's/^\[  PASSED  \] \([0-9]*\) tests\{0,1\}\..*/\1/p' "$log")
  note "$room" "${passed:-0}" "$found" "$(($(date +%s) - began))"
  if [ $found -ne 0 ]; then
    bad=$((bad + 1))
    echo "$room: see $log" >&2
    grep -E -m 5 'runtime error|ERROR: AddressSanitizer|WARNING: ThreadSanitizer|^\[  FAILED' "$log" >&2 || tail -5 "$log" >&2
  fi
done
if [ -n "$program" ]; then
  crown=${CROWN:-../shared/data/validation/crown_36.ply} fdi=${FDI:-36}
  [ -e "$crown" ] || crown=samples/crown_36.stl fdi=36
  program="$build/apps/rhizodont/rhizodont"
  tooth="$build/tooth.ply"
  began=$(date +%s)
  found=0
  { "$program" complete "$crown" --fdi "$fdi" -o "$tooth" --overwrite --report "$build/tooth.json" --quiet &&
    "$program" check "$crown" "$tooth"; } > "$build/program.txt" 2>&1 || found=1
  note 'program: complete and check' 1 $found "$(($(date +%s) - began))"
  bad=$((bad + found))
fi
if [ -n "$document" ]; then
  python3 - "$rows" << 'END'
import pathlib, sys
page, mark = pathlib.Path('docs/faults.md'), '<!-- rows of scripts/sanitize.sh -->'
key = lambda row: tuple(row.split(' | ')[:2])
rows = pathlib.Path(sys.argv[1]).read_text().splitlines()
lines = [line for line in page.read_text().splitlines() if key(line) not in {key(row) for row in rows}]
at = lines.index(mark)
page.write_text('\n'.join(lines[:at] + rows + lines[at:]) + '\n')
END
fi
echo "$((${#rooms[@]})) rooms with $sanitizers, $bad with findings"
[ $bad -eq 0 ]
