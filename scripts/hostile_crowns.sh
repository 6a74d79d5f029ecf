#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes bad crowns made by the tests' generator with the program as a user runs it, proves the promises on each
# tooth, and prints a table of outcomes by kind of defect.
# usage: hostile_crowns.sh [SEEDS=8] [VERTICES="800 4000"] [OUT=results/hostile] [options for complete, e.g. --repair]
# Needs the program and write_hostile_crown built (scripts/test.sh). Ends with 1 if any command ends otherwise than with
# 0, 3 or 4, takes longer than LIMIT (seconds, default 120), says no reason, leaves a file behind, or if `check` does not
# hold on a result. FIRST is the first seed (0), BUILD names the build folder, JOBS how many crowns are completed at a time.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
seeds=${1:-8}
sizes=${2:-800 4000}
out=${3:-results/hostile}
shift $(($# < 3 ? $# : 3))
export extra="$*" out
export program=${BUILD:-build}/apps/rhizodont/rhizodont
export writer=${BUILD:-build}/tests/common/write_hostile_crown
FIRST=${FIRST:-0}
export LIMIT=${LIMIT:-120} OMP_NUM_THREADS=1
mkdir -p "$out"

one_crown() {
  IFS='|' read -r kind seed vertices <<< "$1"
  local samples=(crown_36.stl crown_23.ply crown_16.ply crown_11.stl crown_34.ply)
  local sample=${samples[$((seed % 5))]}
  local fdi=${sample:6:2}
  local base="$out/${kind// /_}_${seed}_$vertices"
  local outcome code start
  "$writer" "samples/$sample" "$kind" "$seed" "$vertices" "$base.ply" 2> "$base.txt"
  code=$?
  if [ $code -ne 0 ]; then
    # What the writer refuses, such as a mesh without triangles, is no file for us.
    echo "$kind|$seed|$vertices|unwritten|0"
    return
  fi
  start=$(date +%s.%N)
  # shellcheck disable=SC2086
  timeout "$LIMIT" "$program" complete "$base.ply" --fdi "$fdi" -o "$base.tooth.ply" --report "$base.json" --quiet \
    --threads 1 $extra 2> "$base.txt"
  code=$?
  outcome=$code
  case $code in
    0) "$program" check "$base.ply" "$base.tooth.ply" --least-kept 0 ${extra:+--report "$base.json"} > "$base.check.txt" 2>&1 ||
         outcome="broken" ;;
    3 | 4) [ "$(wc -l < "$base.txt")" = 1 ] || outcome="no reason"
           [ -e "$base.tooth.ply" ] && outcome="left a file" ;;
    124) outcome="hangs" ;;
  esac
  case $outcome in
    0 | 3 | 4) rm -f "$base.ply" "$base.tooth.ply" "$base.json" "$base.check.txt" ;;
  esac
  echo "$kind|$seed|$vertices|$outcome|$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')"
}
export -f one_crown

"$writer" | while read -r kind; do
  for vertices in $sizes; do
    for ((seed = FIRST; seed < FIRST + seeds; ++seed)); do echo "$kind|$seed|$vertices"; done
  done
done | tr '\n' '\0' | xargs -0 -P "${JOBS:-2}" -I{} bash -c 'one_crown "{}"' | sort -t'|' -k1,1 -k3,3n -k2,2n > "$out/outcomes.txt"

awk -F'|' '
  { all[$1]++; if (!($1 in place)) { place[$1] = ++n; name[n] = $1 } count[$1, $4]++; if ($5 > most[$1]) most[$1] = $5
    if ($4 != 0 && $4 != 3 && $4 != 4) { bad[$1]++; list = list "- " $1 ", seed " $2 ", " $3 " vertices: " $4 "\n" } }
  END {
    print "| defect | crowns | completed | exit 3 | exit 4 | anything else | longest, s |\n|---|---|---|---|---|---|---|"
    for (i = 1; i <= n; i++) { k = name[i]
      printf "| %s | %d | %d | %d | %d | %d | %.1f |\n", k, all[k], count[k, 0], count[k, 3], count[k, 4], bad[k], most[k]
      a += all[k]; c += count[k, 0]; x += count[k, 3]; y += count[k, 4]; b += bad[k] }
    printf "| all | %d | %d | %d | %d | %d | |\n%s", a, c, x, y, b, list
    exit b > 0 }' "$out/outcomes.txt"
