#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes raw crowns, as segmentations leave them, with `--skirt auto` alone as a user runs it, proves promises 1 and 2
# on each tooth with `check`, and prints a table by kind of what was left: completed, promise 3 kept, longest time.
# usage: raw_crowns.sh [COUNT=200] [DATA=../shared/data] [OUT=results/raw]
# Needs the program and write_raw_crowns built (scripts/test.sh). Ends with 1 if a command takes longer than LIMIT
# (seconds, default 60) or `check` does not hold on a result. FIRST is the first seed (0), BUILD names the build folder,
# JOBS how many crowns are completed at a time.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
count=${1:-200}
data=${2:-../shared/data}
export out=${3:-results/raw}
export program=${BUILD:-build}/apps/rhizodont/rhizodont
export LIMIT=${LIMIT:-60}
mkdir -p "$out"

one_crown() {
  IFS='|' read -r file fdi kind euler touching crowded <<< "$1"
  local base=${file%.ply} outcome code start seconds third="-"
  start=$(date +%s.%N)
  timeout "$LIMIT" "$program" complete "$file" --fdi "$fdi" --skirt auto -o "$base.tooth.ply" --report "$base.json" --quiet \
    2> "$base.txt"
  code=$?
  seconds=$(echo "$(date +%s.%N) $start" | awk '{print $1 - $2}')
  outcome=$code
  [ $code = 124 ] && outcome="hangs"
  if [ $code = 0 ]; then
    "$program" check "$file" "$base.tooth.ply" --least-kept 0 --report "$base.json" > "$base.check.txt" 2>&1 || outcome="broken"
    third="missed"
    grep -q '"promise_3_holds": true' "$base.json" && third="kept"
  fi
  echo "$kind|$file|$fdi|$euler|$touching|$crowded|$outcome|$third|$seconds"
}
export -f one_crown

"${BUILD:-build}/tests/common/write_raw_crowns" "$data" "$out" "$count" "${FIRST:-0}" | tr '\n' '\0' |
  xargs -0 -P "${JOBS:-1}" -I{} bash -c 'one_crown "{}"' > "$out/outcomes.txt"

awk -F'|' '
  { all[$1]++; if (!($1 in place)) { place[$1] = ++n; name[n] = $1 }
    if ($7 == 0) done[$1]++; if ($8 == "kept") third[$1]++; if ($9 > most[$1]) most[$1] = $9
    if ($4 < euler[$1]) euler[$1] = $4; if ($5 > touching[$1]) touching[$1] = $5; if ($6 > crowded[$1]) crowded[$1] = $6
    if ($7 == "hangs" || $7 == "broken") bad++
    if ($7 != 0 || $8 != "kept") list = list "- " $1 ", " $2 ": " $7 ", promise 3 " $8 "\n" }
  END {
    print "| kind | crowns | completed | promise 3 kept | longest, s | least Euler number | touching vertices | crowded edges |"
    print "|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= n; i++) { k = name[i]
      printf "| %s | %d | %d | %d | %.1f | %d | %d | %d |\n", k, all[k], done[k], third[k], most[k], euler[k], touching[k], crowded[k]
      a += all[k]; d += done[k]; t += third[k]; if (most[k] > m) m = most[k] }
    printf "| all | %d | %d | %d | %.1f | | | |\n%s", a, d, t, m, list
    exit bad > 0 }' "$out/outcomes.txt"
