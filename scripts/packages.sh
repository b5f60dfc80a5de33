#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the Debian packages of this tree: scripts/packages.sh → build/packages/wallgl-*.deb
set -euo pipefail
cd "$(dirname "$0")/.."
out="$PWD/build/packages" log="$PWD/build/packages/build.log"

scripts/install-deps.sh packages || exit 2
rm -rf "$out"
mkdir -p "$out/source"
# A copy, for what the build leaves beside the sources: what git tracks and what it would offer to track.
git ls-files -z --cached --others --exclude-standard |
  tar --create --null --files-from=- --ignore-failed-read 2>/dev/null | tar --extract --directory="$out/source"

# debhelper builds with a home of its own, where the compiler's cache would be empty.
export CCACHE_DIR="${CCACHE_DIR:-$HOME/.cache/ccache}"

echo "packages: building; everything it prints is in build/packages/build.log"
begin=$SECONDS
# Ninja's own line before each command: each tenth is shown.
progress='match($0, /^\[[0-9]+\/[0-9]+\]/) { split(substr($0, 2, RLENGTH - 2), n, "/")
            if (int(n[1] * 10 / n[2]) != tenth) { tenth = int(n[1] * 10 / n[2])
              print "packages: " n[1] " of " n[2]; fflush() } }'
if ! (cd "$out/source" && DEB_BUILD_OPTIONS="nocheck parallel=$(nproc)" \
        dpkg-buildpackage --build=binary --no-sign 2>&1) | tee "$log" | awk "$progress"; then
  tail -n 40 "$log" >&2
  echo "packages: dpkg-buildpackage failed, see above" >&2
  exit 1
fi
rm -rf "$out/source"
printf 'packages: done after %d:%02d\n' $(((SECONDS - begin) / 60)) $(((SECONDS - begin) % 60))
ls "$out"/*.deb
