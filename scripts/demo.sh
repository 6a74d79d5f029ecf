#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the program, completes the crowns in samples/, proves the promises on each result and draws them.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh
cmake -S . -B build -G Ninja -DRHIZODONT_TESTS=OFF
cmake --build build --target rhizodont
program=build/apps/rhizodont/rhizodont
mkdir -p results
for crown in samples/crown_*; do
  name=$(basename "${crown%.*}")
  fdi=${name#crown_}
  echo "== tooth $fdi"
  "$program" complete "$crown" --fdi "$fdi" -o "results/tooth_$fdi.ply" --report "results/tooth_$fdi.json"
  "$program" check "$crown" "results/tooth_$fdi.ply"
  "$program" measure "results/tooth_$fdi.ply"
  "$program" render "results/tooth_$fdi.ply" -o "results/tooth_$fdi.png" --color-by source
done
echo "Teeth, reports and pictures are in $(pwd)/results"
