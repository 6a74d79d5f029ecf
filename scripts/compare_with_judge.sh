#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Compares `rhizodont check` and `rhizodont measure` with an oracle that shares no code with them.
# usage: compare_with_judge.sh PROGRAM [FOLDER...]
# Each FOLDER holds pairs crown_NAME.ply (or .stl, .obj) and tooth_NAME.*; without one, the validation teeth in ../shared/data and pairs
# broken on purpose are taken. Ends with 77 (skipped) where the oracle or what it needs is missing.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
tools=$here/../../shared/tools
if [ ! -f "$tools/judge.py" ]; then
  echo "skipped: $tools/judge.py is not there"
  exit 77
fi
if ! /usr/bin/python3 -c 'import numpy, scipy, open3d' 2>/dev/null; then
  echo "skipped: /usr/bin/python3 lacks numpy, scipy or open3d"
  exit 77
fi
PYTHONPATH=$tools exec nice -n 10 /usr/bin/python3 "$here/compare_with_judge.py" "$@"
