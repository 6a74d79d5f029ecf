#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the geometry's tests with sanitizers in a folder of their own and runs them.
# usage: sanitize.sh [BUILD=build-sanitize] [SANITIZERS=address,undefined]
# Vectors' index checks are on. Rooms that need torch are left out: its libraries are not built for sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build-sanitize}
sanitizers=${2:-address,undefined}
rooms=(mesh io poisson isosurface voronoi skirt fusion)
cmake -S . -B "$build" -G Ninja -DRHIZODONT_SANITIZE="$sanitizers" -DCMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS \
  -DRHIZODONT_BENCH=OFF ${CCACHE:+-DCMAKE_CXX_COMPILER_LAUNCHER=ccache} > /dev/null
ninja -C "$build" "${rooms[@]/#/test_}"
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_stack_use_after_return=1
for room in "${rooms[@]}"; do "$build/tests/$room/test_$room" --gtest_brief=1; done
