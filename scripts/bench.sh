#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Measures everything that the geometry promises and prints one Markdown page: machine, versions, commands, tables.
# usage: bench.sh [DATA=../shared/data] > docs/benchmarks.md
# Needs a built program with its benchmarks, python3-open3d for the comparison, a machine that does nothing else, and
# about 20 minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
data=${1:-../shared/data}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

version() { dpkg-query -W -f='${Version}' "$1" 2> /dev/null || echo "not installed"; }

# run TITLE COMMAND...: the command as one types it, then what it prints
run() {
  printf '\n## %s\n\n' "$1"
  shift
  printf '`%s`\n\n' "${*//$scratch/SCRATCH}"
  "$@" | sed -E 's/^(#+ )/#\1/'  # its headings one level down
}

cat << END
<!--
SPDX-FileCopyrightText: Rhizodont contributors
SPDX-License-Identifier: GPL-3.0-or-later
-->
# Measured

Written by \`scripts/bench.sh\`; the paper's figures stand beside ours where it has them.

| What | Which |
|---|---|
| Processor | $(lscpu | sed -n 's/^Model name: *//p'), $(nproc) cores |
| Memory | $(free -g | awk '/^Mem/ {print $2}') GB |
| System | $(. /etc/os-release && echo "$PRETTY_NAME"), $(c++ --version | head -1), $(sed -n 's/^ *FLAGS = \(-O[^ ]* [^ ]*\).*/\1/p' build/build.ninja | head -1) |
| Libraries | CGAL $(version libcgal-dev), Eigen $(version libeigen3-dev), oneTBB $(version libtbb-dev), libtorch $(version libtorch-dev), OpenBLAS $(version libopenblas0-openmp), Open3D $(version python3-open3d) |
| State | $(git rev-parse --short HEAD)$(git diff --quiet HEAD -- src include apps models bench || echo " with changes"), $(date -u +%F) |
| Load before | $(cut -d' ' -f1-3 /proc/loadavg) |
END

run "Crown: every real crown" scripts/real_crowns.sh "$data" "$scratch/real"
run "Crown and triangles of the validation teeth, beside tables 3 and 5 of the paper; time by stage" \
  build/bench/fusion/bench_fusion "$data" models
run "Triangles of iterative Poisson, beside table 5" build/bench/poisson/bench_poisson "$data" ipsr
run "Guiding surface, beside table 1" build/bench/poisson/bench_poisson "$data" distance
run "Indicator function beside Open3D and CGAL" build/bench/poisson/bench_poisson "$data" peers
run "Indicator function: growth" build/bench/poisson/bench_poisson "$data" growth
run "GradNormal: angles and growth" build/bench/isosurface/bench_isosurface "$data"
run "Restricted Voronoi diagram; crown triangles given by the dual" build/bench/voronoi/bench_voronoi "$data"
if [ -x build/bench/networks/bench_networks ]; then
  run "Networks beside torch" build/bench/networks/bench_networks "$data" models
else
  printf '\n## Networks beside torch\n\nNot measured: this build has no torch (RHIZODONT_TRAINING).\n'
fi
# Two teeth's stages beside each other, wall-clock and processor time in ms, from Google Benchmark's CSV
stage_times() {
  build/bench/stages/bench_stages --benchmark_format=csv 2> /dev/null | awk -F, '
    /^"/ { gsub(/"/, "", $1); split($1, name, "/"); stage = name[1]; tooth = name[2]
           if (!(stage in seen)) { seen[stage] = 1; order[++n] = stage }
           if (!(tooth in teeth)) { teeth[tooth] = 1; column[++m] = tooth }
           wall[stage, tooth] = $3; processor[stage, tooth] = $4 }
    END { printf "| stage |"; for (j = 1; j <= m; j++) printf " tooth %s, ms | processor, ms |", column[j]
          printf "\n|---|"; for (j = 1; j <= m; j++) printf "---|---|"
          for (i = 1; i <= n; i++) { printf "\n| %s |", order[i]
            for (j = 1; j <= m; j++) printf " %.1f | %.1f |", wall[order[i], column[j]], processor[order[i], column[j]] }
          print "" }'
}
if [ -x build/bench/stages/bench_stages ]; then
  run "Each stage by itself, samples 36 and 23, e = 0.5 mm: what build/bench/stages/bench_stages measures" stage_times
else
  printf '\n## Each stage by itself\n\nNot measured: Google Benchmark was not there (libbenchmark-dev).\n'
fi
run "Whole tooth: growth with the crown and with 1/e^2, peak memory" \
  build/bench/pipeline/bench_pipeline "$scratch/growth.csv" 5000 10000 20000 50000 100000
/usr/bin/python3 bench/pipeline/plot_growth.py "$scratch/growth.csv" docs/growth.svg
printf '\n![Processor seconds by crown vertices and by 1/e^2](growth.svg)\n'
