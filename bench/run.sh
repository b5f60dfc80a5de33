#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the benchmarks of build/release and prints their tables.
# bench/run.sh [--json FILE] [FILTER]     FILTER: a regular expression on the benchmarks' names (state, execute, output,
#                                         order, switch, pack, mesh, buffers, late_node, notice, gpus, views, march,
#                                         sort_last, compose, off_wall, off_window, hand_on, recordings, scaling,
#                                         traffic, share, transport, coding, fair, streams, codec, simulate)
set -euo pipefail
cd "$(dirname "$0")/.."

json="" filter="."
while (($#)); do
  case "$1" in
    --json) json="$(realpath -m "$2")"; shift 2 ;;
    -h|--help) sed -n '3,7s/^# //p' "$0"; exit 0 ;;
    *) filter="$1"; shift ;;
  esac
done
build="${WALLGL_BUILD:-build/release}"
results="$(mktemp -d)"
trap 'rm -rf "$results"' EXIT
worst=0

# run NAME COMMAND...: each writes its figures to $results/NAME.json
run() {
  local name="$1"; shift
  [[ "$name" =~ $filter ]] || return 0
  printf '\n== %s\n' "$name"
  "$@" || { worst=1; printf '%s: below its bar\n' "$name"; }
}

run state "$build/bench/state_bench" --benchmark_out="$results/state.json" --benchmark_out_format=json \
  --benchmark_color=false
run execute "$build/bench/execute_bench" --benchmark_out="$results/execute.json" --benchmark_out_format=json \
  --benchmark_color=false
run output "$build/bench/output_bench" --benchmark_out="$results/output.json" --benchmark_out_format=json \
  --benchmark_color=false
run order "$build/bench/order_bench" --benchmark_out="$results/order.json" --benchmark_out_format=json \
  --benchmark_color=false
run switch bench/switch.py --json "$results/switch.json"
run pack bench/pack.py --json "$results/pack.json"
run mesh bench/mesh.py --json "$results/mesh.json"
run buffers bench/buffers.py --json "$results/buffers.json"
run late_node bench/late_node.py --json "$results/late_node.json"
run notice bench/notice.py --json "$results/notice.json"
run gpus bench/gpus.py --json "$results/gpus.json"
run views bench/views.py --json "$results/views.json"
run sort_last bench/sort_last.py --json "$results/sort_last.json"
run march bench/march.py --json "$results/march.json"
run compose bench/compose.py --json "$results/compose.json"
run off_wall bench/off_wall.py --json "$results/off_wall.json"
run off_window bench/off_window.py --json "$results/off_window.json"
run hand_on bench/hand_on.py --json "$results/hand_on.json"
run recordings bench/recordings.py --json "$results/recordings.json"
run scaling bench/scaling.py --json "$results/scaling.json"
run traffic bench/traffic.py --json "$results/traffic.json"
run share bench/share.py --json "$results/share.json"
run transport bench/transport.py --json "$results/transport.json"
run coding bench/coding.py --json "$results/coding.json"
run fair bench/fair.py --json "$results/fair.json"
run streams bench/stream_cost.py --json "$results/streams.json"
run codec bench/codec.py --json "$results/codec.json"
run simulate bench/simulate.py --json "$results/simulate.json"

if [[ -n "$json" ]]; then
  /usr/bin/python3 - "$results" "$json" <<'PYTHON'
import json, pathlib, platform, subprocess, sys
results, target = map(pathlib.Path, sys.argv[1:])
commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True).stdout.strip()
cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
           platform.machine())
benchmarks = {file.stem: json.loads(file.read_text()) for file in sorted(results.glob("*.json"))}
report = {"commit": commit, "machine": cpu, "benchmarks": benchmarks}
target.write_text(json.dumps(report, indent=1) + "\n")
PYTHON
fi
exit "$worst"
