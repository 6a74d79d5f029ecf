#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Format, lengths of functions and files, and naming rules; takes some minutes. Needs a configured build folder (compile_commands.json).
set -euo pipefail
cd "$(dirname "$0")/.."
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
/usr/bin/python3 scripts/check_lengths.py
git ls-files 'src/*.cpp' 'apps/*.cpp' | xargs -P "$(nproc)" -n 4 clang-tidy -p build --quiet \
  --checks='-*,readability-identifier-naming' --warnings-as-errors='*' --extra-arg=-Wno-undefined-internal
