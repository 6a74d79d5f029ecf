#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the program, completes the crowns in samples/, has each tooth proved by `check` and draws all in one picture.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh program
mkdir -p build results
if ! cmake -S . -B build -G Ninja -DRHIZODONT_TESTS=OFF -DRHIZODONT_BENCH=OFF > build/configure.log 2>&1; then
  cat build/configure.log
  exit 1
fi
echo "Building the program; takes some minutes the first time"
NINJA_STATUS='[%f of %t, %e s] ' cmake --build build --target rhizodont
program=build/apps/rhizodont/rhizodont
teeth=()
for crown in samples/crown_*; do
  name=$(basename "${crown%.*}")
  tooth=results/tooth_${name#crown_}
  "$program" complete "$crown" --fdi "${name#crown_}" -o "$tooth.ply" --report "$tooth.json"
  "$program" check "$crown" "$tooth.ply" > "$tooth.txt" || { cat "$tooth.txt"; exit 4; }
  "$program" measure "$tooth.ply" >> "$tooth.txt"
  teeth+=("$tooth.ply")
done
"$program" render "${teeth[@]}" -o results/teeth.png --views front,right,oblique --width 320 --height 400
echo "Teeth, their reports (.json), proofs and figures (.txt) are in $(pwd)/results, drawn together in teeth.png"
echo "To look and work with them in the browser: $(pwd)/$program serve, then open http://127.0.0.1:8080/"
