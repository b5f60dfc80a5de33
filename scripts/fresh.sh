#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the README's commands where nothing is installed: in a clean Debian 12 root (mmdebstrap) with a clone of what is
# committed. The compiler's cache and the packages downloaded before (Debian's, npm's) are mounted, everything else is
# the root's own.
# As root: scripts/fresh.sh [--keep] [COMMAND]   COMMAND: of bash, in the clone; by default both commands of the README
set -euo pipefail
project="$(cd "$(dirname "$0")/.." && pwd)"
work="$project/build/fresh" root="$project/build/fresh/root"
keep=""
[[ ${1:-} != --keep ]] || { keep=1; shift; }
# The page of the demo would be everybody's; a port of its own lets a demo outside go on.
command=${1:-"time scripts/demo.sh --seconds 8 --http 0 --screenshot /tmp/wall.png && time scripts/test.sh"}

[[ $(id -u) -eq 0 ]] || { echo "fresh: mounting needs root: run this with sudo" >&2; exit 2; }
command -v mmdebstrap >/dev/null || { echo "fresh: mmdebstrap is missing: scripts/install-deps.sh test" >&2; exit 2; }
if [[ ${WALLGL_FRESH_INSIDE:-} != 1 ]]; then
  # Mounts and processes of a namespace end with it, however this ends.
  exec env WALLGL_FRESH_INSIDE=1 unshare --mount --pid --fork --kill-child --mount-proc "$0" ${keep:+--keep} "$command"
fi

mkdir -p "$work/archives" "$work/root"
rm -rf "${root:?}"
echo "fresh: making a clean Debian 12"
mmdebstrap --quiet --variant=apt bookworm "$root" || { echo "fresh: mmdebstrap failed, see above" >&2; exit 1; }
# A root is a mount of its own, which network namespaces rely on (ip netns exec).
mount --bind "$root" "$root"
cp /etc/resolv.conf "$root/etc/resolv.conf"
git clone --quiet --no-local "$project" "$root/srv/wallgl"
mount --bind "$work/archives" "$root/var/cache/apt/archives"
for folder in proc sys dev; do mount --rbind "/$folder" "$root/$folder"; done
mount -t tmpfs tmpfs "$root/tmp"
cache="${CCACHE_DIR:-$HOME/.cache/ccache}"
mkdir -p "$cache" "$root/ccache"
mount --bind "$cache" "$root/ccache"

mkdir -p "$HOME/.npm" "$root/root/.npm"
mount --bind "$HOME/.npm" "$root/root/.npm"
# Whom this machine trusts on its network, such as a proxy of its own, the root trusts as well. (Node.js has a list of
# its own, and adds to that.)
certificates=/etc/ssl/certs/ca-certificates.crt
[[ ! -f $certificates ]] || cp "$certificates" "$root/srv/certificates.crt"

echo "fresh: $command"
result=0
env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 CCACHE_DIR=/ccache \
  NODE_EXTRA_CA_CERTS=/srv/certificates.crt \
  chroot "$root" bash -c "cd /srv/wallgl && $command" </dev/null || result=$?
[[ ! -f "$root/tmp/wall.png" ]] || cp "$root/tmp/wall.png" "$work/wall.png"
if [[ -z $keep ]]; then
  umount -R "$root"
  rm -rf --one-file-system "${root:?}"
fi
echo "fresh: exit code $result"
exit "$result"
