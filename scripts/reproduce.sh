#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Makes every experiment of the paper's section 4 on the data at hand, beside the paper's own figures and beside other
# programs on the same crowns, and writes docs/reproduction.md and its pictures.
# usage: reproduce.sh [DATA] [--peers] [--alone COMMAND] [--repeats N] [--each N] [--out FOLDER] [--page-only]
# Without DATA: the sample crowns alone, which have no true roots. --peers installs what is compared with and missing
# (Debian packages); without it, what is there takes part. --alone: a command put before each one whose time is taken,
# such as "taskset -c 2,3". --page-only: writes the page again from the last run's figures.
# Needs a built program with its benchmarks (cmake -S . -B build -G Ninja && cmake --build build).
set -euo pipefail
cd "$(dirname "$0")/.."
words=()
for word in "$@"; do
  if [ "$word" = --peers ]; then scripts/install_dependencies.sh peers; else words+=("$word"); fi
done
for program in build/apps/rhizodont/rhizodont build/bench/reproduction/bench_reproduction; do
  [ -x "$program" ] || { echo "$program is not built: cmake -S . -B build -G Ninja && cmake --build build" >&2; exit 3; }
done
PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 bench/reproduction "${words[@]}"
