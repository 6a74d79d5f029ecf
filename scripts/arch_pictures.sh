#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Draws scans, the teeth that were found in them without labels, and the whole teeth: a row a scan.
# usage: arch_pictures.sh [OUT=docs/arches.png] [SCAN...]
# Without scans: three generated arches (SEEDS="5000:lower 5001:upper 5008:lower"), whose crown models DATA
# (../shared/data) holds. With scans: for a look only where their licence keeps their pictures out of docs/.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-docs/arches.png}
shift || true
program=build/apps/rhizodont/rhizodont
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
scans=("$@")
if [ ${#scans[@]} = 0 ]; then
  for seed in ${SEEDS:-5000:lower 5001:upper 5008:lower}; do
    "$program" synth --arch --data "${DATA:-../shared/data}" --jaw "${seed#*:}" --seed "${seed%:*}" --upright \
      --triangles 30000 30000 -o "$folder/made" > /dev/null
    scans+=("$folder/made/arch_${seed%:*}_${seed#*:}.ply")
  done
fi
meshes=()
for i in "${!scans[@]}"; do
  # Without the labels that may lie beside it.
  mkdir "$folder/$i"
  scan=$folder/$i/$(basename "${scans[$i]}")
  cp "${scans[$i]}" "$scan"
  "$program" segment "$scan" -o "$folder/$i/labels.ply" --quiet
  "$program" arch "$scan" -o "$folder/$i/arch" --quiet || [ $? = 6 ]
  meshes+=("$scan" "$folder/$i/labels.ply" "$folder/$i/arch/arch.ply")
done
"$program" render "${meshes[@]}" -o "$out" --per-row 3 --views oblique --width 520 --height 420
