#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Bytes a second from a program to a node by each transport, in batches of 1 MiB, beside the least that must happen
(transport_bench.cpp). All take turns; the median of several rounds.

transport.py [--rounds N] [--seconds S] [--json FILE]      exit code 1 if one is slower than 0.7 of its bare peer
"""
from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import build_folder  # noqa: E402

BAR = 0.7
TRANSPORTS = ("ring", "unix", "tcp", "tls")
GIB = 2**30


def rate(kind: str, seconds: float) -> float:
    return float(subprocess.run([build_folder() / "bench" / "transport_bench", kind, str(seconds)], check=True,
                                capture_output=True, text=True).stdout)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--seconds", type=float, default=1.0)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    rates: dict[str, list[tuple[float, float]]] = {name: [] for name in TRANSPORTS}
    for _ in range(options.rounds):
        for name, measured in rates.items():
            measured.append((rate(f"wallgl-{name}", options.seconds), rate(f"bare-{name}", options.seconds)))
    results = {}
    for name, measured in rates.items():
        ours, bare = (statistics.median(each) for each in zip(*measured))
        ratio = statistics.median(a / b for a, b in measured)
        results[name] = {"bytes_per_second": ours, "bare_bytes_per_second": bare, "ratio": ratio}
        print(f"{name:5} {ours / GIB:6.2f} GiB/s, bare {bare / GIB:6.2f} GiB/s: {ratio:.2f}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    worst = min(result["ratio"] for result in results.values())
    print(f"the slowest has {worst:.2f} of what is possible, {BAR} wanted")
    return 0 if worst >= BAR else 1


if __name__ == "__main__":
    sys.exit(main())
