#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the geometry's rooms with assertions, of stated preconditions, of Eigen and CGAL and of vectors' indices, in a
# folder of their own and runs their tests. Slower than the product: for once a week, not for every change.
# usage: debug_build.sh [ROOM ...]    (all of the geometry by default)
set -euo pipefail
cd "$(dirname "$0")/.."
rooms=("$@")
[ $# -gt 0 ] || rooms=(mesh teeth operators skirt intake poisson isosurface guiding voronoi fusion)
launcher=$(command -v ccache || true)
cmake -S . -B build-debug -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-Og -g1 -D_GLIBCXX_ASSERTIONS" \
  -DRHIZODONT_BENCH=OFF ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
ninja -C build-debug ${JOBS:+-j "$JOBS"} "${rooms[@]/#/test_}"
bad=()
for room in "${rooms[@]}"; do
  log=build-debug/$room.txt
  if "build-debug/tests/$room/test_$room" > "$log" 2>&1; then
    echo "$room: $(sed -n 's/^\[  PASSED  \] \([0-9]* tests\{0,1\}\)\..*/\1/p' "$log")"
  else
    bad+=("$room")
    echo "$room: see $log"
    grep -E -m 5 'Assertion|assertion|^\[  FAILED' "$log" || tail -5 "$log"
  fi
done
echo "${#rooms[@]} rooms with assertions, ${#bad[@]} with findings"
[ ${#bad[@]} -eq 0 ]
