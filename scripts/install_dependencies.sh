#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Installs what the build and the tests need and this machine lacks, from Debian 12's packages.
set -euo pipefail

packages=(
  g++ cmake ninja-build clang-format
  libtorch-dev libgloo-dev libopenblas0-openmp libcgal-dev libeigen3-dev libboost-dev libgmp-dev libmpfr-dev
  libtbb-dev libnanoflann-dev libcli11-dev nlohmann-json3-dev libfmt-dev libpugixml-dev zlib1g-dev liblz4-dev pkg-config
  libpng-dev libssl-dev libgtest-dev
  python3-numpy python3-scipy python3-open3d python3-jsonschema
)

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
