#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Makes generated teeth that training never saw, crown and whole tooth, for `rhizodont evaluate`:
#   scripts/held_out_teeth.sh FOLDER [TEETH_PER_TYPE] [FIRST_NUMBER] [DATA_FOLDER]
# Left and right take turns. Numbers far from each other give teeth that are independent of each other.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:?where to?}
count=${2:-10}
first=${3:-2000000000000}
data=${4:-../shared/data}
program=build/apps/rhizodont/rhizodont
for position in 1 2 3 4 5 6 7 8; do
  left=$((position % 2))
  for jaw in "$((1 + left))" "$((3 + (1 - left)))"; do
    "$program" synth --data "$data" --type "$jaw$position" --count "$count" --seed "$first" --crowns --edge 0.25 \
      -o "$folder" > /dev/null
  done
done
