#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Builds the documents as pages (Sphinx, MyST, Breathe with Doxygen, Furo), every warning an error, and checks their links.
# usage: documents.sh [BUILD=build] [--external]
# --external: also asks for each address outside, as far as there is a network.
# Ends with 77 where what builds them is not installed: scripts/install_dependencies.sh documents.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$(realpath "${1:-build}")
shift $(($# < 1 ? 0 : 1))
/usr/bin/python3 scripts/check_links.py "$@"
missing=()
command -v doxygen > /dev/null || missing+=(doxygen)
for module in sphinx myst_parser breathe furo numpy; do
  /usr/bin/python3 -c "import $module" 2> /dev/null || missing+=("python3: $module")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "The pages are not built, for want of ${missing[*]}; scripts/install_dependencies.sh documents installs it."
  exit 77
fi

out=$build/documents
rm -rf "$out"
mkdir -p "$out/source"
# With git, what is under version control; without, all Markdown.
files=$( (git ls-files -co --exclude-standard '*.md' docs 2> /dev/null || find . -name '*.md' -not -path './build*' -o -path './docs/*' -type f) |
  grep -v -e '^tests/' -e '__pycache__')
tar -cf - $files LICENSE scripts/slurm | tar -xf - -C "$out/source"

(cat docs/Doxyfile; echo "INPUT = include/rhizodont"; echo "OUTPUT_DIRECTORY = $out/doxygen") > "$out/Doxyfile"
mkdir -p "$out/doxygen"
doxygen "$out/Doxyfile" > "$out/doxygen.log" 2>&1 || { cat "$out/doxygen.log"; exit 1; }
if grep -E 'warning|error' "$out/doxygen.log"; then exit 1; fi

programs=("$build/apps/rhizodont/rhizodont")
[ ! -x "$build/apps/rhizodont-train/rhizodont-train" ] || programs+=("$build/apps/rhizodont-train/rhizodont-train")
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 docs/generated_pages.py . "$out/source/docs/reference/generated" "$out/doxygen/xml" "${programs[@]}"

RHIZODONT_SOURCE=$PWD RHIZODONT_DOXYGEN=$out/doxygen/xml PYTHONDONTWRITEBYTECODE=1 \
  /usr/bin/python3 -m sphinx -W --keep-going -q -b html -c docs -d "$out/doctrees" "$out/source" "$out/html"
echo "Pages: $out/html/docs/index.html"
