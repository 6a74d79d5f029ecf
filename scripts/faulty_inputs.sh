#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Completes every file of a folder of faulty inputs, plain and with --repair, proves each result with `check`, and prints a
# table: exit code, seconds, what was said. The folder's README.md names the files and, in brackets, their FDI numbers.
# usage: faulty_inputs.sh [FOLDER=../shared/data/faults] [OUT=results/faults]
# Needs a built program. Ends with 1 if a command takes longer than LIMIT seconds (20), ends otherwise than with 0, 2, 3
# or 4, leaves a tooth behind without 0, if `check` does not hold on a result, or if --repair makes a tooth of what was
# refused without a word of it.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
folder=${1:-../shared/data/faults}
out=${2:-results/faults}
program=${BUILD:-build}/apps/rhizodont/rhizodont
limit=${LIMIT:-20}
mkdir -p "$out"
bad=0

# One run: sets code, seconds and said.
run() {
  local file=$1 fdi=$2 tooth=$3 start check
  shift 3
  rm -f "$tooth" "$tooth.json"
  start=$(date +%s.%N)
  timeout "$limit" "$program" complete "$file" --fdi "$fdi" -o "$tooth" --report "$tooth.json" "$@" > "$tooth.txt" 2>&1
  code=$?
  seconds=$(echo "$(date +%s.%N) $start" | awk '{ printf "%.1f", $1 - $2 }')
  said=$(grep -v '^ *root length' "$tooth.txt" | sed -e "s|$tooth: ||" -e "s|^rhizodont: ||" -e "s|$folder/||g" | tr '\n' ' ' |
    cut -c1-260 | sed -e 's/|/\//g')
  case $code in
    0) check=$("$program" check "$file" "$tooth" --report "$tooth.json" 2>&1) || code="0, but check: $(echo "$check" | tail -1)" ;;
    2 | 3 | 4) [ -e "$tooth" ] && code="$code, but left a tooth" ;;
    124) code="no end in $limit s" ;;
  esac
  case $code in 0 | 2 | 3 | 4) ;; *) bad=1 ;; esac
}

echo "| file | FDI | exit | s | said | with --repair | s | said |"
echo "|---|---|---|---|---|---|---|---|"
while read -r name fdi; do
  [ -e "$folder/$name" ] || continue
  run "$folder/$name" "$fdi" "$out/$name.ply"
  row="| $name | $fdi | $code | $seconds | $said" plain=$code
  run "$folder/$name" "$fdi" "$out/$name.repaired.ply" --repair
  if [[ $plain == [34] && $code == 0 ]] && ! grep -q -e --repair "$out/$name.ply.txt"; then
    code="0, but not hinted at"
    bad=1
  fi
  echo "$row | $code | $seconds | $said |"
done < <(sed -n 's/^| \([^|]*\[[^]]*\]\) |.*/\1/p' "$folder/README.md" | awk '
  { open = index($0, "["); list = substr($0, open + 1); sub(/\].*/, "", list); files = substr($0, 1, open - 1)
    n = split(files, name, /, */); m = split(list, number, /, */)
    for (i = 1; i <= n; i++) { gsub(/ /, "", name[i]); print name[i], (m == n ? number[i] : number[1]) } }')
exit $bad
