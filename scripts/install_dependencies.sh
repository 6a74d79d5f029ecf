#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Installs from Debian 12's packages what this machine lacks of what is needed: for the program alone, or for everything,
# that is, tests, benchmarks and training too. Beside these there are groups without which nothing fails: what builds the
# documents as pages, and what the integrations are tested in; a last one is what scripts/reproduce.sh compares with.
# usage: install_dependencies.sh [program|all|documents|integrations|peers]
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libcgal-dev libeigen3-dev libtbb-dev libnanoflann-dev libcli11-dev nlohmann-json3-dev libfmt-dev libpugixml-dev
  zlib1g-dev liblz4-dev libpng-dev libssl-dev libcpp-httplib-dev libzip-dev pkg-config
)
case ${1:-all} in
  program) ;;
  all)
    packages+=(
      chromium fonts-dejavu-core clang-format clang-tidy libgtest-dev libbenchmark-dev valgrind libtorch-dev libgloo-dev libopenblas0-openmp
      python3-numpy python3-scipy python3-open3d python3-jsonschema python3-dev pybind11-dev python3-pytest python3-pip python3-venv mypy
      man-db zsh fish appstream
      slurmctld slurmd slurm-client munge
    )
    ;;
  documents) packages=(python3-sphinx furo python3-myst-parser python3-breathe doxygen python3-numpy) ;;
  peers) packages=(python3-open3d meshlab xvfb xauth libgl1-mesa-dri) ;;
  integrations) packages=(blender python3-vtk9 python3-numpy python3-pytest) ;;
  *)
    echo "usage: install_dependencies.sh [program|all|documents|integrations|peers]" >&2
    exit 2
    ;;
esac

# Debian's npm does not go with a nodejs from elsewhere, so an npm that is there is taken as it is.
case ${1:-all} in
  program | all) command -v npm > /dev/null || packages+=(npm) ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
