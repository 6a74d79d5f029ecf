#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds everything with warnings as errors, has clang-tidy look at what has changed, and runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh
scripts/install_dependencies.sh documents || echo "What the documents need cannot be installed here: their tests are skipped."
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
/usr/bin/python3 scripts/check_lengths.py
/usr/bin/python3 scripts/check_rooms.py --self-test
/usr/bin/python3 scripts/check_rooms.py
cmake -S . -B build -G Ninja -DRHIZODONT_WERROR=ON -DRHIZODONT_TESTS=ON -DRHIZODONT_BENCH=ON -DRHIZODONT_TRAINING=ON -DRHIZODONT_PYTHON=ON
cmake --build build
scripts/tidy_changed.sh --at-most 12
rm -rf build/test_results
GTEST_OUTPUT="xml:$PWD/build/test_results/" ctest --test-dir build --output-on-failure --no-tests=error -j 2
/usr/bin/python3 scripts/check_skipped.py build/test_results
[ -f build/web/dist/app.js ] || echo "The page was neither built nor tested: npm or its packages could not be reached (see CMake's warning above)."
