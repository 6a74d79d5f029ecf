#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Trains completion networks of different sizes, each for as much processor time, and prints what each has learned by
# then as rows of a table: error of the best weights on held-out generated teeth. The learning rate falls to its end
# within each run. A variant whose row is in the folder already is not run again.
# usage: architecture_study.sh DATA FOLDER [CPU_MINUTES=20]
set -euo pipefail
cd "$(dirname "$0")/.."
data=${1:?folder with templates/}
out=${2:?where the runs go}
minutes=${3:-20}
program=build/apps/rhizodont-train/rhizodont-train
TIMEFORMAT='%U %S'
mkdir -p "$out"

# train FOLDER SAMPLES OPTIONS...: processor seconds, loading of the families included
train() {
  local folder=$1 samples=$2
  shift 2
  { time "$program" completion --data "$data" --out "$folder" --samples "$samples" "$@" > "$folder.log" 2>&1; } 2>&1 |
    tail -1 | awk '{ print $1 + $2 }'
}

echo "| width | blocks | patches x points | million parameters | samples | ms of processor per sample | root, mm | tooth, mm |"
echo "|---|---|---|---|---|---|---|---|"
while read -r width blocks queries points; do
  name="$out/${width}_${blocks}_${queries}_$points"
  shape=(--width "$width" --blocks "$blocks" --queries "$queries" --patch-points "$points")
  if [ ! -e "$name.row" ]; then
    # Two short runs tell loading from training.
    short=$(train "$name.trial" 160 "${shape[@]}")
    rm -rf "$name.trial"
    longer=$(train "$name.trial" 800 "${shape[@]}")
    rm -rf "$name.trial"
    each=$(awk "BEGIN { print ($longer - $short) / 640 }")
    samples=$(awk "BEGIN { print int($minutes * 60 / $each / 16) * 16 }")
    train "$name" "$samples" "${shape[@]}" > /dev/null
    figures=$(python3 scripts/weight_notes.py "$name/best.safetensors" validation.tooth_chamfer_l1_mm \
      validation.root_chamfer_l1_mm)
    read -r tooth root <<< "$figures"
    # A checkpoint holds each parameter four times in single precision.
    parameters=$(stat -c %s "$name/checkpoint.safetensors" | awk '{ printf "%.1f", $1 / 16e6 }')
    awk "BEGIN { printf \"| $width | $blocks | $queries x $points | $parameters | $samples | %.0f | $root | $tooth |\n\", 1000 * $each }" > "$name.row"
    rm -f "$name/checkpoint.safetensors"
  fi
  cat "$name.row"
done << VARIANTS
192 4 256 12
128 4 256 12
256 4 256 12
192 2 256 12
192 6 256 12
192 4 128 24
192 4 512 6
VARIANTS
