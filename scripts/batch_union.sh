#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Whether what a batch gives depends on how it was run: N cases once undisturbed, and once in two shards side by side of
# which one is killed at a random moment and started again. Results must be the same byte for byte, and the ledgers must
# say the same of every tooth.
# usage: batch_union.sh [N=200] [SCANS]
# SCANS: a folder of labelled scans, used one after the other until there are N cases. Without it the cases are sample
# crowns, each fifth one an arch of two of them, each a little elsewhere.
# Needs a built program (BUILD=build). OPTIONS: of rhizodont batch (default --e 1). OUT: where it works (default: a
# temporary folder). Ends with 1 if anything differs.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-200}
scans=${2:+$(realpath "$2")}
# Shards have a thread each, unless OPTIONS says otherwise.
threads=(--threads 1)
program=$(realpath "${BUILD:-build}/apps/rhizodont/rhizodont")
read -r -a options <<<"${OPTIONS:---e 1}"
[[ " ${options[*]} " != *" --threads "* ]] || threads=()
if [ -n "${OUT:-}" ]; then mkdir -p "$OUT"; work=$(realpath "$OUT"); else
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
fi

/usr/bin/python3 - "$count" "$work" "$scans" <<'PY'
import pathlib
import struct
import sys

count, work, scans = int(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


def moved(name, x):
    """A sample's bytes (binary STL), moved along x."""
    data = bytearray(pathlib.Path("samples", name).read_bytes())
    for facet in range(struct.unpack_from("<I", data, 80)[0]):
        for corner in range(3):
            at = 84 + 50 * facet + 12 + 12 * corner
            struct.pack_into("<f", data, at, struct.unpack_from("<f", data, at)[0] + x)
    return bytes(data)


lines = ["scan,fdi,root_lengths"]
if scans:
    files = sorted(p for p in pathlib.Path(scans).iterdir() if p.suffix in (".ply", ".obj", ".stl", ".vtp", ".vtk") or p.is_dir())
    for i in range(count):
        lines.append(f'"{files[i % len(files)]}",,')
    if count > len(files):
        print(f"{len(files)} scans for {count} cases: the same scan gives the same results, once", file=sys.stderr)
else:
    for i in range(count):
        x = 0.015625 * i
        if i % 5 == 4:
            folder = work / f"scans/arch{i}"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "36.stl").write_bytes(moved("crown_36.stl", x))
            (folder / "37.stl").write_bytes(moved("crown_36.stl", x + 11))
            lines.append(f"scans/arch{i},,")
        else:
            name = ("crown_11.stl", "crown_36.stl")[i % 2]
            (work / "scans").mkdir(exist_ok=True)
            (work / f"scans/crown{i}.stl").write_bytes(moved(name, x))
            lines.append(f"scans/crown{i}.stl,{name[6:8]},")
(work / "manifest.csv").write_text("\n".join(lines) + "\n")
PY

cd "$work"
rm -rf whole parts
# Ends with the code of the batch; cases without a result (6) are a part of what is compared.
batch() {
  local code=0
  "$program" batch manifest.csv "$@" "${options[@]}" --quiet || code=$?
  [ $code = 0 ] || [ $code = 6 ] || { echo "rhizodont batch $* ended with $code"; exit 1; }
}
begin=$(date +%s.%N)
batch -o whole
whole=$(awk "BEGIN { print $(date +%s.%N) - $begin }")

begin=$(date +%s.%N)
"$program" batch manifest.csv -o parts --shard 1/2 "${threads[@]}" "${options[@]}" --quiet &
victim=$!
batch -o parts --shard 2/2 "${threads[@]}" &
other=$!
# At some case of its own, some time after its beginning.
cases=$(((count + 1) / 2))
before=$((RANDOM % cases)) moment=$(awk -v seed="$RANDOM" 'BEGIN { srand(seed); print 0.7 * rand() }')
while kill -0 "$victim" 2>/dev/null; do
  [ "$(cat parts/ledger/1-of-2.*.jsonl 2>/dev/null | grep -c '^{"event":"case"')" -lt "$before" ] || break
  sleep 0.05
done
sleep "$moment"
if kill -KILL "$victim" 2>/dev/null; then killed="killed $moment s after its case $before"; else killed="was through"; fi
wait "$victim" 2>/dev/null || true
# It may have been killed before either shard had begun.
! grep -qs '"event":"run"' parts/ledger/*.jsonl || "$program" batch status parts
batch -o parts --shard 1/2 "${threads[@]}"
wait "$other"
parts=$(awk "BEGIN { print $(date +%s.%N) - $begin }")
"$program" batch status parts

teeth() { cat "$1"/ledger/*.jsonl | grep -a '^{"event":"tooth"' | sed 's/,"time":[0-9]*}$/}/' | sort -u; }
diff -r whole/cases parts/cases
diff <(teeth whole) <(teeth parts)
echo "$count cases, shard 1 $killed: $(find parts/cases -type f | wc -l) files in $(find parts/cases -mindepth 1 -maxdepth 1 | wc -l) folders and" \
  "$(teeth parts | wc -l) teeth as in one run (one run $whole s, shards $parts s)"
