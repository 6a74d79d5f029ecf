#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes the sample crowns and, where they are there, the validation crowns, and has the independent oracle judge every
# result beside `check` and `measure`.
# usage: judge_completed.sh PROGRAM FOLDER, FOLDER for crowns and teeth. Ends with 77 (skipped) without the oracle.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$1
folder=$2
[ -f "$here/../../shared/tools/judge.py" ] || { echo "skipped: no judge.py in ../shared/tools"; exit 77; }
rm -rf "$folder"
mkdir -p "$folder"
for crown in "$here"/../samples/crown_* "$here"/../../shared/data/validation/crown_*.ply; do
  [ -f "$crown" ] || continue
  name=$(basename "${crown%.*}")
  fdi=${name#crown_}
  case $crown in */validation/*) label=real$fdi ;; *) label=$fdi ;; esac
  cp "$crown" "$folder/crown_$label.${crown##*.}"
  "$program" complete "$crown" --fdi "$fdi" -o "$folder/tooth_$label.ply" --quiet
done
exec "$here/compare_with_judge.sh" "$program" "$folder"
