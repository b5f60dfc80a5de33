#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Switching one driver between contexts (bench/switch_bench.cpp), in turn with what it is compared with, several
rounds; the best round of each counts, since whatever else the machine does only slows one down. What a switch costs
beside drawing in one context is measured in turn on one driver, and is the median of all rounds' medians.

switch.py [--rounds N] [--json FILE]     exit code 1 below a bar
"""
from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import build_folder  # noqa: E402

IDENTICAL_BAR = 100e6  # switches a second
VARYING_BAR = 5e6  # switches and triangles a second, null driver
KEPT_BAR = 0.95  # of the rate of the same drawing in one context
THREADS = {"llvmpipe in one thread": "0", "llvmpipe with rasteriser threads": ""}  # LP_NUM_THREADS


def measure(threads: str, only: str) -> dict[str, float]:
    """Switches a second of each benchmark whose name matches: of the processor's time where all is done in one thread,
    since what else the machine does takes no part of that."""
    environment = dict(os.environ, **({"LP_NUM_THREADS": threads} if threads else {}))
    command = [str(build_folder() / "bench" / "switch_bench"), "--benchmark_format=json", "--benchmark_min_time=0.1",
               f"--benchmark_filter={only}"]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300)
    one_thread = threads == "0" or "null" in only

    def rate(entry: dict) -> float:
        return entry["items_per_second"] * (entry["real_time"] / entry["cpu_time"] if one_thread else 1)

    return {entry["name"].removesuffix("/real_time"): rate(entry)
            for entry in json.loads(done.stdout)["benchmarks"] if "items_per_second" in entry}


def kept(threads: str) -> float:
    """What the soft switch reaches of the rate of the same drawing in one context: the median of 101 pairs in turn on
    one driver."""
    environment = dict(os.environ, **({"LP_NUM_THREADS": threads} if threads else {}))
    command = [str(build_folder() / "bench" / "switch_bench"), "--benchmark_format=json", "--benchmark_filter=in turn"]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300)
    return json.loads(done.stdout)["benchmarks"][0]["kept"]


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    best: dict[str, dict[str, float]] = {"null driver": {}, **{how: {} for how in THREADS}}
    for _ in range(options.rounds):
        for how, figures in best.items():
            for name, rate in measure(THREADS.get(how, ""),
                                      "identical|null" if how == "null driver" else "llvmpipe").items():
                figures[name] = max(rate, figures.get(name, 0))
    for how, figures in best.items():
        print(f"{how}, a second")
        for name, rate in figures.items():
            print(f"  {name:50}{rate:16,.0f}")
    ratios = {how: statistics.median(kept(threads) for _ in range(options.rounds)) for how, threads in THREADS.items()}
    if options.json:
        options.json.write_text(json.dumps({**best, "kept": ratios}, indent=1) + "\n")
    null = best["null driver"]
    reached = [("identical", min(null["identical/soft switch/fresh"], null["identical/soft switch/equal values"]),
                IDENTICAL_BAR),
               ("varying, null driver", null["varying/null driver/soft switch"], VARYING_BAR)]
    reached += [(f"varying, {how}, to one context in turn", ratio, KEPT_BAR) for how, ratio in ratios.items()]
    for what, figure, bar in reached:
        print(f"{what}: {figure:,.2f}, at least {bar:,} wanted")
    return 0 if all(figure >= bar for _, figure, bar in reached) else 1


if __name__ == "__main__":
    sys.exit(main())
