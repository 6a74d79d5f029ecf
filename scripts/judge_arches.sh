#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes every arch of real data with --resolve-collisions and proves each tooth against its cut crown: a row an arch, how
# many teeth have roots, how many of those `rhizodont check` confirms, which roots still run into a neighbour, and
# each refusal with its reason.
# usage: judge_arches.sh [DATA=../shared/data]
# Of DATA: arches/*.ply with labels beside them (else their teeth are found), crowns/patient* (both jaws, a crown a file), lower_scan. Needs a built
# program (BUILD=build). OUT: keeps the results there. OPTIONS: more for rhizodont arch.
set -euo pipefail
shopt -s nullglob
cd "$(dirname "$0")/.."
data=$(realpath "${1:-../shared/data}")
program=$(realpath "${BUILD:-build}/apps/rhizodont/rhizodont")
out=${OUT:-$(mktemp -d)}
mkdir -p "$out/in"
[ -n "${OUT:-}" ] || trap 'rm -rf "$out"' EXIT
read -r -a options <<<"${OPTIONS:-}"

inputs=("$data"/arches/*.ply)
for patient in "$data"/crowns/patient*; do
  for jaw in 'upper:[12]' 'lower:[34]'; do
    folder=$out/in/$(basename "$patient")_${jaw%:*}
    mkdir -p "$folder"
    for crown in "$patient"/crown_${jaw#*:}?.ply; do ln -sf "$crown" "$folder/"; done
    inputs+=("$folder")
  done
done
for crown in "$data"/lower_scan/crown_??.ply; do
  mkdir -p "$out/in/lower_scan"
  ln -sf "$crown" "$out/in/lower_scan/"
done
[ ! -d "$out/in/lower_scan" ] || inputs+=("$out/in/lower_scan")

echo "| arch | teeth | with roots | checked | roots in a neighbour |"
echo "|---|---|---|---|---|"
for input in "${inputs[@]}"; do
  name=$(basename "$input" .ply)
  rm -rf "${out:?}/$name"
  code=0
  "$program" arch "$input" -o "$out/$name" --resolve-collisions --quiet "${options[@]}" || code=$?
  [ $code = 0 ] || [ $code = 4 ] || [ $code = 6 ] || { echo "$name: rhizodont arch ended with $code" >&2; exit 1; }
  checked=0
  for tooth in "$out/$name"/tooth_??.ply; do
    fdi=${tooth: -6:2}
    if "$program" check "$out/$name/crown_$fdi.ply" "$tooth" --report "$out/$name/tooth_$fdi.json" > /dev/null; then
      checked=$((checked + 1))
    else
      echo "$name $fdi: not confirmed" >&2
    fi
  done
  /usr/bin/python3 - "$out/$name/arch.json" "$name" "$checked" <<'PY'
import json
import sys

report, name, checked = json.load(open(sys.argv[1])), sys.argv[2], int(sys.argv[3])
teeth = report["teeth"]
rooted = [t for t in teeth if t["rooted"]]
apart = ("root_root_mm", "root_crown_mm", "crown_root_mm")
into = [f'{c["teeth"][0]}-{c["teeth"][1]} {-d:.2f} mm' for c in report["clearances"]
        if (d := min((c[k] for k in apart if c[k] is not None), default=1)) < 0]
print(f'| {name} | {len(teeth)} | {len(rooted)} | {checked} | {", ".join(into)} |')
for t in teeth:
    if not t["rooted"]:
        print(f'{name} {t["fdi"]}: {t["refusal"]}', file=sys.stderr)
PY
done | tee "$out/table.txt"
awk -F'|' '{ teeth += $3; rooted += $4; checked += $5; pairs += gsub(/ mm/, " mm", $6) }
  END { printf "%d teeth, %d with roots, %d of those checked, %d roots in a neighbour\n", teeth, rooted, checked, pairs
    exit checked < rooted }' \
  "$out/table.txt"
