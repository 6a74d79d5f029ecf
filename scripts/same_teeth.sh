#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Whether another build of the program makes the same teeth, byte for byte, of the samples and of the real crowns.
# usage: same_teeth.sh OTHER_PROGRAM [DATA=../shared/data] [OTHER_MODELS=models]
# One line per crown; exit code 1 if any differs.
set -euo pipefail
[ $# -ge 1 ] || { sed -n 's/^# \(usage: .*\)/\1/p' "$0" >&2; exit 2; }
other=$(realpath "$1")
cd "$(dirname "$0")/.."
data=${2:-../shared/data} models=$(realpath "${3:-models}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
different=0 crowns=0
for crown in samples/crown_* "$data"/validation/crown_*.ply; do
  [ -e "$crown" ] || continue
  name=$(basename "${crown%.*}")
  fdi=${name#crown_}
  mkdir "$scratch/$name"
  build/apps/rhizodont/rhizodont complete "$crown" --fdi "$fdi" -o "$scratch/$name/this.ply" --quiet 2> "$scratch/$name/this.txt" || true
  "$other" complete "$crown" --fdi "$fdi" --models "$models" -o "$scratch/$name/other.ply" --quiet 2> "$scratch/$name/other.txt" || true
  crowns=$((crowns + 1))
  if [ ! -e "$scratch/$name/this.ply" ] && [ ! -e "$scratch/$name/other.ply" ]; then
    echo "$crown: no tooth from either"
  elif cmp -s "$scratch/$name/this.ply" "$scratch/$name/other.ply"; then
    echo "$crown: same"
  else
    echo "$crown: different"
    different=$((different + 1))
  fi
  rm -r "${scratch:?}/$name"
done
echo "$crowns crowns, $different different"
[ "$different" = 0 ]
