#!/usr/bin/env bash
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Makes the Debian packages of a finished build, unpacks them and completes a crown with the program and, where it was
# built, with the Python module; lintian must find no error where it is installed.
# usage: check_packages.sh [--fresh-root] [BUILD=build]
# --fresh-root: instead of unpacking, installs them with apt in a new Debian 12 that debootstrap makes below BUILD (needs root
# and a mirror; takes some minutes).
set -euo pipefail
cd "$(dirname "$0")/.."
fresh=no
if [ "${1:-}" = --fresh-root ]; then fresh=yes; shift; fi
build=$(realpath "${1:-build}")
packages=$build/packages root=$build/packages/root
rm -rf "$packages"
mkdir -p "$packages"
cpack --config "$build/CPackConfig.cmake" -B "$packages" > "$packages/cpack.log" 2>&1 || { cat "$packages/cpack.log"; exit 1; }
ls -l "$packages"/*.deb | awk '{ print $5, $9 }'
# Changelogs are written by whoever uploads to a distribution.
if command -v lintian > /dev/null; then
  lintian --fail-on error --suppress-tags no-changelog --tag-display-limit 5 "$packages"/*.deb | grep -E '^E:' || true
  lintian --fail-on error --suppress-tags no-changelog "$packages"/*.deb > /dev/null
fi

if command -v appstreamcli > /dev/null; then
  appstreamcli validate --no-net deploy/*.metainfo.xml > "$packages/appstream.log" || { cat "$packages/appstream.log"; exit 1; }
fi
python=$(find "$packages" -maxdepth 1 -name 'python3-rhizodont_*.deb')
mkdir -p "$root"
if [ $fresh = yes ]; then
  debootstrap --variant=minbase bookworm "$root" > "$packages/debootstrap.log" 2>&1
  mkdir -p "$root/packages"
  cp "$packages"/*.deb "$root/packages"
  cp samples/crown_11.stl "$root/"
  chroot "$root" sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends /packages/*.deb' > "$packages/apt.log" 2>&1 ||
    { tail -20 "$packages/apt.log"; exit 1; }
  run=(env -u RHIZODONT_MODELS chroot "$root")
  place= crown=/crown_11.stl
else
  for package in "$packages"/*.deb; do dpkg-deb -x "$package" "$root"; done
  run=(env -u RHIZODONT_MODELS "PYTHONPATH=$root/usr/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1)
  place=$root crown=samples/crown_11.stl
fi
for file in man/man1/rhizodont.1.gz man/man1/rhizodont-batch-status.1.gz bash-completion/completions/rhizodont zsh/vendor-completions/_rhizodont \
            fish/vendor_completions.d/rhizodont.fish metainfo/org.rhizodont.Rhizodont.metainfo.xml applications/org.rhizodont.Rhizodont.desktop \
            icons/hicolor/scalable/apps/org.rhizodont.Rhizodont.svg; do
  # a minimal Debian leaves out manuals
  [ -s "$root/usr/share/$file" ] || { [ $fresh = yes ] && [[ $file == man/* ]]; } || { echo "the packages lack $file"; exit 1; }
done
# by its name alone, as people call it: the models are those of the package
"${run[@]}" env "PATH=$place/usr/bin:$PATH" rhizodont doctor --json > "$packages/doctor.json"
grep -q "\"models_folder\": \"$place/usr/share/rhizodont/models\"" "$packages/doctor.json" || { cat "$packages/doctor.json"; exit 1; }
"${run[@]}" "$place/usr/bin/rhizodont" complete "$crown" --fdi 11 --e 1 -o "$place/tooth.ply" --overwrite
"${run[@]}" "$place/usr/bin/rhizodont" check "$crown" "$place/tooth.ply" | tail -1
if [ -n "$python" ]; then
  "${run[@]}" /usr/bin/python3 -c "
import rhizodont
tooth = rhizodont.complete('$crown', rhizodont.Models(), fdi=11, e=1)
tooth.save('$place/module.ply')
print(rhizodont.__file__, tooth)"
  cmp "$root/tooth.ply" "$root/module.ply"
fi
