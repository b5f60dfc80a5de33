#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what drives the browser in tests: install_playwright.sh FOLDER. Does nothing when it is there.
set -euo pipefail
readonly version=1.57.0  # the last for Debian's Node.js 18
folder=$1
have=$(node -p "require('$folder/node_modules/playwright-core/package.json').version" 2>/dev/null || true)
[[ $have == "$version" ]] && exit 0
mkdir -p "$folder"
npm install --prefix "$folder" --no-save --no-package-lock --no-audit --no-fund --loglevel=error \
  "playwright-core@$version" ||
  { echo "install_playwright: npm cannot install playwright-core $version into $folder;" \
         "the browser tests need it (and network, once)" >&2
    exit 1; }
