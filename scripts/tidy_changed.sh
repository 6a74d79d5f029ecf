#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# The whole set of clang-tidy that .clang-tidy names, on the sources that differ from a commit, saved or not; of a changed
# header the source of its name, else the first that includes it. Any finding is an error.
# usage: tidy_changed.sh [--at-most COUNT] [BASE]
# --at-most: checks nothing, and says so, where more sources than that differ: each takes half a minute.
# BASE: by default where this branch left the one it follows; on that one itself, the commit before.
# Needs a configured build folder (compile_commands.json). Does nothing where clang-tidy is not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-tidy > /dev/null || { echo "tidy_changed.sh: clang-tidy is not installed, nothing is checked"; exit 0; }
[ -e build/compile_commands.json ] || { echo "tidy_changed.sh: configure the folder build first" >&2; exit 2; }
at_most=100000
if [ "${1:-}" = --at-most ]; then at_most=$2; shift 2; fi
base=${1:-$(git merge-base HEAD '@{upstream}' 2> /dev/null || echo HEAD~1)}
if [ $# = 0 ] && [ "$base" = "$(git rev-parse HEAD)" ] && git diff --quiet HEAD; then base=HEAD~1; fi
git rev-parse --quiet --verify "$base^{commit}" > /dev/null || {
  echo "tidy_changed.sh: there is no commit $base here, nothing is checked"; exit 0; }

# The sources that a changed file is checked with. Training needs torch, which may not be there.
sources_of() {
  case $1 in
    *.cpp) echo "$1" ;;
    *.hpp)
      if [ -e "${1%.hpp}.cpp" ]; then echo "${1%.hpp}.cpp"; else
        local name=${1#src/}
        name=${name#include/} name=${name#apps/}
        git grep -l --untracked -F "#include \"$name\"" -- 'src/*.cpp' 'apps/*.cpp' | sed -n 1p
      fi ;;
  esac
}
sources=$({ git diff --name-only --diff-filter=d "$base" -- src apps include
            git ls-files --others --exclude-standard -- src apps include; } | sort -u |
          while read -r file; do sources_of "$file"; done | sort -u)
if ! grep -q 'RHIZODONT_TRAINING:BOOL=ON' build/CMakeCache.txt; then
  sources=$(grep -v -e '^src/learning/' -e '^apps/rhizodont-train/' <<< "$sources" || true)
fi
[ -n "$sources" ] || { echo "tidy_changed.sh: no source differs from $base"; exit 0; }
if [ "$(wc -l <<< "$sources")" -gt "$at_most" ]; then
  echo "tidy_changed.sh: $(wc -l <<< "$sources") sources differ from $base, nothing is checked; run scripts/tidy_changed.sh"
  exit 0
fi
echo "clang-tidy on $(wc -l <<< "$sources") sources that differ from $base"
xargs -P "${JOBS:-$(nproc)}" -n 2 clang-tidy -p build --quiet --warnings-as-errors='*' --extra-arg=-Wno-undefined-internal --extra-arg=-Wno-unknown-warning-option \
  <<< "$sources"
