#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A wall of virtual tiles on this machine with programs on it: installs and builds what is missing, then runs it.
# scripts/demo.sh --help tells the options.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"

for word in "$@"; do
  case "$word" in
    --) break ;;
    -h|--help) exec /usr/bin/env python3 "$root/scripts/demo.py" --help ;;
  esac
done

"$root/scripts/install-deps.sh" demo
if [[ -n "${WALLGL_BUILD:-}" ]]; then
  echo "demo: using the build in $WALLGL_BUILD"
else
  "$root/scripts/build.py" --keep --folder release --name "demo: building" demo \
    walld tileserver wallrun wallctl wallgl_vendor
fi
exec /usr/bin/python3 "$root/scripts/demo.py" "$@"
