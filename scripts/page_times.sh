#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Prints how quick the page is in Debian's Chromium, which draws by the processor: from a drop to the tooth, from a slider to the
# root, and how an arch of 14 teeth (400,000 triangles) turns. Needs everything built (scripts/test.sh); on a machine that does
# nothing else, or the figures are of that, too.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$PWD/${BUILD:-build}
RHIZODONT_SOURCE=$PWD RHIZODONT_PROGRAM=$build/apps/rhizodont/rhizodont npm --prefix "$build/web" run --silent times -- --reporter=line "$@" |
  grep -E 's \(median|frames/s|opened in|[0-9]+ (passed|failed)|Error'
