#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes every real crown of a data folder, proves the promises on each result and counts the outcomes.
# usage: real_crowns.sh [DATA=../shared/data] [OUT=results/real] [OPTIONS of complete, such as --skirt auto]
# Needs a built program (scripts/demo.sh or scripts/test.sh). Ends with 1 if a command ends otherwise than with 0, 3 or 4, or
# if `check` does not hold on a result.
set -uo pipefail
cd "$(dirname "$0")/.."
data=${1:-../shared/data}
out=${2:-results/real}
shift $(($# < 2 ? $# : 2))
program=build/apps/rhizodont/rhizodont
mkdir -p "$out"
bad=0
for group in validation crowns/patient0 crowns/patient1 lower_scan; do
  done_here=0 all=0 kept=0 triangles=0 good=0 skirt=0 most=0 opened=0
  for crown in "$data/$group"/crown_*.ply; do
    name=$(basename "${crown%.ply}")
    fdi=${name#crown_}
    tooth="$out/${group//\//_}_$fdi.ply"
    all=$((all + 1))
    rm -f "$tooth"
    "$program" complete "$crown" --fdi "$fdi" -o "$tooth" --report "${tooth%.ply}.json" --quiet "$@" 2> "${tooth%.ply}.txt"
    code=$?
    if [ $code -eq 0 ]; then
      read -r k n p <<< "$("$program" check "$crown" "$tooth" --json | /usr/bin/python3 -c '
import json, sys
report = json.load(sys.stdin)
print(report["crown"]["kept_triangles"], report["crown"]["triangles"], int(report["promise_3_holds"]))')"
      if "$program" check "$crown" "$tooth" > /dev/null; then
        done_here=$((done_here + 1)) kept=$((kept + k)) triangles=$((triangles + n)) good=$((good + p))
        # Vertices dropped as skirt or spike, of those that no cap had.
        read -r s o share <<< "$(/usr/bin/python3 -c '
import json, sys
crown = json.load(open(sys.argv[1]))["crown"]
dropped = crown["dropped_vertices_by_reason"]
skirt = sum(len(dropped.get(reason, [])) for reason in ("skirt", "spike"))
opened = skirt + len(crown["kept_vertices"])
print(skirt, opened, round(10000 * skirt / opened))' "${tooth%.ply}.json")"
        skirt=$((skirt + s)) opened=$((opened + o)) most=$((share > most ? share : most))
      else
        echo "$crown: exit 0, but check does not hold"
        bad=1
      fi
    else
      echo "$crown: exit $code: $(head -c 300 "${tooth%.ply}.txt")"
      [ $code -eq 3 ] || [ $code -eq 4 ] || bad=1
      [ -e "$tooth" ] && echo "$tooth was written all the same" && bad=1
    fi
  done
  echo "$group: $done_here of $all completed, promise 3 kept on $good, $kept of $triangles triangles kept, $skirt of $opened vertices beside caps dropped as skirt or spike," \
    "$((most / 100)).$(printf %02d $((most % 100))) % of the worst crown"
done
exit $bad
