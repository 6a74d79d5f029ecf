#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Draws generated arches beside real scans: a row a scan, generated and real by turns, from above, the front, the side and
# obliquely. For a look only: the real scans' licence keeps their pictures out of docs/.
# usage: arch_sheet.sh [SEED=1] [PAIRS=4] [OUT=results/arch_sheet.png] [SCANS=../shared/data/arches] [DATA=../shared/data]
set -euo pipefail
cd "$(dirname "$0")/.."
seed=${1:-1}
pairs=${2:-4}
out=${3:-results/arch_sheet.png}
scans=${4:-../shared/data/arches}
data=${5:-../shared/data}
program=build/apps/rhizodont/rhizodont
mkdir -p "$(dirname "$out")"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
rows=()
mapfile -t real < <(ls "$scans"/*.ply)
for ((i = 0; i < pairs; ++i)); do
  scan=${real[$(((seed + i) % ${#real[@]}))]}
  jaw=lower
  [[ $scan == *upper* ]] && jaw=upper
  "$program" synth --arch --data "$data" --jaw "$jaw" --seed "$((seed + i))" --upright --triangles 16000 16000 \
    -o "$folder/$i" >/dev/null
  # Generated arches have an upper jaw's teeth down; the real scans all have them up.
  /usr/bin/python3 - "$folder/$i/arch_$((seed + i))_$jaw.ply" "$jaw" <<'PY'
import sys
import numpy as np
name, jaw = sys.argv[1:]
data = open(name, 'rb').read()
head, body = data.split(b'end_header\n', 1)
count = int([l for l in head.decode().splitlines() if l.startswith('element vertex')][0].split()[2])
size = 8 if b'property double x' in head else 4
points = np.frombuffer(body[:3 * size * count], f'<f{size}').reshape(-1, 3) * ([-1, -1, 1] if jaw == 'upper' else [1, 1, 1])
open(name, 'wb').write(head + b'end_header\n' + points.astype(f'<f{size}').tobytes() + body[3 * size * count:])
PY
  rows+=("$folder/$i/arch_$((seed + i))_$jaw.ply" "$scan")
done
"$program" render "${rows[@]}" --axis 0,1,0 --views top,front,left,oblique --width 480 --height 400 -o "$out"
echo "$out"
