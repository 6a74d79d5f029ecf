#!/bin/bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
# Judges how scans without labels are read: judge_segmentation.sh [SCANS [MODELS [POSES]]]. SCANS (../shared/data/arches):
# meshes with true labels SCAN.json beside them. Each is read as it lies and in POSES (0) random poses; figures of the first,
# and the least share of vertices that keep their labels in the others. For judging alone: nothing may be tuned by it.
# RHIZODONT: the program (build/apps/rhizodont/rhizodont). OUT: a folder for the labels found (else a temporary one).
set -eu
cd "$(dirname "$0")/.."
scans=${1:-../shared/data/arches}
models=${2:-models}
poses=${3:-0}
program=${RHIZODONT:-build/apps/rhizodont/rhizodont}
out=${OUT:-$(mktemp -d)}
mkdir -p "$out/asis"
for scan in "$scans"/*.ply; do
  name=$(basename "$scan" .ply)
  "$program" segment "$scan" -o "$out/asis/$name.json" --models "$models" --overwrite > "$out/asis/$name.txt" 2>&1 ||
    echo "$name: $(tail -1 "$out/asis/$name.txt")"
done
"$program" evaluate "$scans" --labels "$out/asis"
[ "$poses" -gt 0 ] || exit 0
python3 - "$scans" "$out" "$poses" "$program" "$models" <<'PYTHON'
import json, pathlib, subprocess, sys
import numpy as np
scans, out, poses, program, models = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3]), *sys.argv[4:6]


def read_ply(path):
    data = path.read_bytes()
    end = data.index(b'end_header') + len(b'end_header')
    end += 2 if data[end:end + 2] == b'\r\n' else 1
    return data[:end], data[end:]


rng = np.random.default_rng(1)
worst = 1.0
for path in sorted(scans.glob('*.ply')):
    asis = out / 'asis' / (path.stem + '.json')
    if not asis.exists():
        continue
    header, body = read_ply(path)
    lines = header.decode().split('\n')
    count = int(next(l for l in lines if l.startswith('element vertex')).split()[2])
    vertex = lines[next(i for i, l in enumerate(lines) if l.startswith('element vertex')) + 1:]
    kinds = {'float': 'f4', 'float32': 'f4', 'double': 'f8', 'uchar': 'u1', 'uint8': 'u1', 'int': 'i4', 'int32': 'i4'}
    fields = []
    for line in vertex:
        if not line.startswith('property') or line.startswith('property list'):
            break
        fields.append((line.split()[2].strip(), '<' + kinds[line.split()[1]]))
    points = np.frombuffer(body, np.dtype(fields), count).copy()
    rest = body[points.nbytes:]
    first = np.array(json.loads(asis.read_text())['labels'])
    shares = []
    for pose in range(poses):
        q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        if np.linalg.det(q) < 0:
            q[:, 0] *= -1
        xyz = np.stack([points[a] for a in 'xyz'], 1).astype(float) @ q.T + rng.uniform(-200, 200, 3)
        moved = points.copy()
        for i, a in enumerate('xyz'):
            moved[a] = xyz[:, i]
        turned = out / 'turned.ply'
        turned.write_bytes(header + moved.tobytes() + rest)
        done = subprocess.run([program, 'segment', turned, '-o', out / 'turned.json', '--models', models, '--overwrite', '--quiet'])
        if done.returncode != 0:
            shares.append(0.0)
            continue
        labels = np.array(json.loads((out / 'turned.json').read_text())['labels'])
        shares.append(float(np.mean(labels == first)))
    print(f'{path.stem}: same labels in other poses {min(shares):.4f}')
    worst = min(worst, *shares)
print(f'worst {worst:.4f}')
PYTHON
