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

"$root/scripts/install-deps.sh"
if [[ -n "${WALLGL_BUILD:-}" ]]; then
  echo "demo: using the build in $WALLGL_BUILD"
else
  echo "demo: building (the first time takes some minutes)"
  cd "$root"
  [[ -f build/release/build.ninja ]] || cmake --preset release --log-level=WARNING
  cmake --build --preset release --target walld tileserver wallrun wallctl wallgl_vendor | tail -n 1
  cd - >/dev/null
fi
exec /usr/bin/python3 "$root/scripts/demo.py" "$@"
