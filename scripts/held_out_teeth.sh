#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Makes generated teeth that training never saw, crown and whole tooth, for `rhizodont evaluate`:
#   scripts/held_out_teeth.sh FOLDER [TEETH_PER_TYPE] [FIRST_NUMBER] [DATA_FOLDER]
# Numbers far from each other give teeth that are independent of each other.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:?where to?}
count=${2:-10}
first=${3:-2000000000000}
data=${4:-../shared/data}
program=build/apps/rhizodont/rhizodont
"$program" synth --data "$data" --count "$count" --seed "$first" --crowns --edge 0.3 --overwrite -o "$folder" \
  --type 11 22 13 24 15 26 17 28 31 42 33 44 35 46 37 48 > /dev/null
