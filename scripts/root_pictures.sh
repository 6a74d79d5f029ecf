#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Draws predicted roots beside true ones, for a look: generated crowns of all 16 types are completed; a tooth takes two tiles,
# the completed one and the one that it was cut from, from the front and the side.
# usage: root_pictures.sh [OUT=results/roots] [EACH=3] [FIRST=2100000000000] [MODELS=models] [DATA=../shared/data]
# Writes OUT/incisors.png, premolars.png and molars.png: a line each of a few teeth.
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:-results/roots} each=${2:-3} first=${3:-2100000000000} models=${4:-models} data=${5:-../shared/data}
program=build/apps/rhizodont/rhizodont
mkdir -p "$out"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
draw() {  # NAME FDI...
  local name=$1 tiles=() crown fdi stem
  shift
  "$program" synth --data "$data" --count "$each" --seed "$first" --crowns --edge 0.3 --type "$@" -o "$scratch/$name" > /dev/null
  for fdi in "$@"; do
    for crown in "$scratch/$name"/crown_"$fdi"_*.ply; do
      stem=$(basename "$crown" .ply)
      "$program" complete "$crown" --fdi "$fdi" --models "$models" --repair -o "$scratch/$name/made_$stem.ply" --quiet || continue
      tiles+=("$scratch/$name/made_$stem.ply" "$scratch/$name/tooth_${stem#crown_}.ply")
    done
  done
  "$program" render "${tiles[@]}" --per-row $((2 * each)) --width 220 --height 330 -o "$out/$name.png"
  echo "$out/$name.png"
}
draw incisors 11 12 13 31 32 33
draw premolars 14 15 34 35
draw molars 16 17 18 36 37 38
