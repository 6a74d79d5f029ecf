#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# How much quicker or slower the program is than the last release: builds that state's program in a worktree of its own and times both,
# in turn, in one run (compare_speed.py), so that whatever else the machine does weighs on both.
# usage: compare_release.sh [BASE=last tag] [RUNS=7] [CROWN_FDI...=the samples]
# BASE is a tag or a commit. Each program works with the weights of its own state. The worktree and its build stay in
# build-release/BASE for the next time. Needs build/apps/rhizodont/rhizodont. The machine should do nothing else. Prints states, machine and a table
# in Markdown; LIMIT=1.1 makes it end with 1 where the median ratio of processor time is above that.
set -euo pipefail
cd "$(dirname "$0")/.."
base=${1:-$(git describe --tags --abbrev=0 2> /dev/null || true)}
[ -n "$base" ] || { echo "There is no release yet: name a commit (compare_release.sh BASE)." >&2; exit 2; }
commit=$(git rev-parse --verify --short "$base^{commit}")
runs=${2:-7}
shift $(($# < 2 ? $# : 2))
crowns=("$@")
[ ${#crowns[@]} -gt 0 ] || crowns=(samples/crown_*)
tree=$PWD/build-release/$commit
[ -e "$tree" ] || git worktree add --detach "$tree" "$commit" > /dev/null
if [ ! -x "$tree/build/apps/rhizodont/rhizodont" ]; then
  launcher=$(command -v ccache || true)
  cmake -S "$tree" -B "$tree/build" -G Ninja -DRHIZODONT_TESTS=OFF -DRHIZODONT_BENCH=OFF -DRHIZODONT_WEB=OFF \
    ${launcher:+-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher} > /dev/null
  CCACHE_BASEDIR=$tree cmake --build "$tree/build" --target rhizodont >&2
fi
changed=$(git diff --quiet HEAD -- src include apps models || echo ' with changes')
echo "$(git rev-parse --short HEAD)$changed beside $base ($commit), $runs runs each in turn, $(date -u +%F)," \
  "$(lscpu | sed -n 's/^Model name: *//p'), $(nproc) cores; load before: $(cut -d' ' -f1-3 /proc/loadavg)"
echo
python3 scripts/compare_speed.py build/apps/rhizodont/rhizodont "$tree/build/apps/rhizodont/rhizodont" "${crowns[@]}" \
  --models models --other-models "$tree/models" --runs "$runs" | tee "$tree/comparison.md"
[ -z "${LIMIT:-}" ] ||
  sed -n 's/^Median ratio.* processor \([0-9.]*\)$/\1/p' "$tree/comparison.md" |
    awk -v limit="$LIMIT" '{ if ($1 > limit) { print "The processor needs more than " limit " times as long."; exit 1 } }'
