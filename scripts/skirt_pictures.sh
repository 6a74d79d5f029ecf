#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Draws each crown of a folder before and after its skirt was dropped: above the crown as cut, dark what goes; below the
# tooth that came of it. For a look at crowns whose licence keeps their pictures out of docs/.
# usage: skirt_pictures.sh [CROWNS=../shared/data/lower_scan] [OUT=results/skirt]
set -euo pipefail
cd "$(dirname "$0")/.."
crowns=${1:-../shared/data/lower_scan}
out=${2:-results/skirt}
program=build/apps/rhizodont/rhizodont
mkdir -p "$out"
for crown in "$crowns"/crown_*.ply; do
  fdi=$(basename "${crown%.ply}" | sed s/crown_//)
  if ! "$program" complete "$crown" --fdi "$fdi" --skirt auto --skirt-confidence "$out/cut_$fdi.ply" \
    -o "$out/tooth_$fdi.ply" --report "$out/tooth_$fdi.json" --quiet; then
    echo "$crown: no tooth, no picture" >&2
    continue
  fi
  axis=$(/usr/bin/python3 -c 'import json, sys; print(*json.load(open(sys.argv[1]))["frame"]["growth_axis"], sep=",")' \
    "$out/tooth_$fdi.json")
  look=(--axis="$axis" --views front,back,left,right --wireframe --width 480 --height 480)
  "$program" render "$out/cut_$fdi.ply" --color-by kept "${look[@]}" -o "$out/cut_$fdi.png"
  "$program" render "$out/tooth_$fdi.ply" --color-by source "${look[@]}" -o "$out/tooth_$fdi.png"
done
echo "$out"
