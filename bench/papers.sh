#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Measures what the papers measured and writes docs/papers.md, theirs beside ours.
# bench/papers.sh [--from REPORT]... [--json FILE] [BENCHMARK...]
#   BENCHMARK: only these are measured; without, all that the page has figures of (an hour)
#   --from:    reports of earlier runs, for what is not measured now
#   --json:    keeps the report of what is measured now
set -euo pipefail
cd "$(dirname "$0")/.."

reports=() wanted=() json=""
while (($#)); do
  case "$1" in
    --from) reports+=("$(realpath "$2")"); shift 2 ;;
    --json) json="$(realpath -m "$2")"; shift 2 ;;
    -h|--help) sed -n '3,7s/^# //p' "$0"; exit 0 ;;
    *) wanted+=("$1"); shift ;;
  esac
done
mapfile -t known < <(bench/papers/page.py --benchmarks)
((${#wanted[@]})) || wanted=("${known[@]}")
for name in "${wanted[@]}"; do
  [[ " ${known[*]} " == *" $name "* ]] ||
    { printf "papers.sh: no figure is of benchmark '%s': expected some of %s\n" "$name" "${known[*]}" >&2; exit 2; }
done
if [[ -z $json ]]; then
  json="$(mktemp --suffix=.json)"
  trap 'rm -f "$json"' EXIT
fi
result=0
bench/run.sh --json "$json" "^($(IFS='|'; echo "${wanted[*]}"))\$" || result=1
bench/papers/page.py "${reports[@]}" "$json" || result=1
exit "$result"
