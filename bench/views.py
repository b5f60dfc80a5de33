#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Eight tiles around the user (docs/walls.md, "Views"; OCTAVIS, section 2): frames a second of a band of triangles
around the eye (bench/around.cpp), sorted by what each tile sees and with all of it sent to all (WALLGL_BROADCAST), in
turn; and how much of it all nodes together process, where one turn of a camera sees each triangle once.

views.py [--rounds N] [--json FILE]     exit code 1 if a figure is below its bar
"""
from __future__ import annotations

import argparse
import json
import re
import statistics
import subprocess
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / "tests" / "support"), str(Path(__file__).resolve().parent)]
from buffers import elements_of  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIDES, SIZE = 8, (400, 300)
CASES = {"immediate": 15, "lists": 20, "buffers": 20}  # frames
LEAST_FASTER = 2.0  # in immediate mode. What nodes keep costs them little where it is not seen, sorted or not
MOST_PROCESSED = 1.3  # of the band's elements, by all tiles together


def octagon() -> PlannedWall:
    """A node for each tile: it processes what it is sent."""
    width, height = SIZE
    plan = {f"node{i}": {f"side{i}": (i * width, 0, width, height)} for i in range(SIDES)}
    keys = {f"side{i}": f"yaw = {i * 360 / SIDES}\nfov = {360 / SIDES}" for i in range(SIDES)}
    return PlannedWall(plan, keys, name="views", swap_timeout_ms=10000, environment={"LP_NUM_THREADS": "0"})


def run(wall: PlannedWall, how: str, frames: int, triangles: int, environment: dict[str, str]) -> tuple[float, int]:
    """Frames a second, and elements of the band."""
    program = [str(build_folder() / "bench" / "around"), "--how", how, "--frames", str(frames), "--triangles",
               str(triangles), "--size", f"{SIZE[0]}x{SIZE[1]}"]
    done = subprocess.run(wall.wallrun(*program, fullscreen=True), env=environment, check=True, capture_output=True,
                          text=True, timeout=600)
    said = re.search(r"([\d.]+) frames/s, (\d+) elements", done.stdout)
    return float(said[1]), int(said[2])


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--triangles", type=int, default=1_000_000)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results, missed = {}, []
    with XServer() as x, octagon() as wall:
        for how, frames in CASES.items():
            rates: dict[str, list[float]] = {"sorted": [], "broadcast": []}
            for _ in range(options.rounds):
                for kind, environment in (("sorted", {}), ("broadcast", {"WALLGL_BROADCAST": "1"})):
                    rate, elements = run(wall, how, frames, options.triangles, x.environment(**environment))
                    rates[kind].append(rate)
            faster = statistics.median(a / b for a, b in zip(rates["sorted"], rates["broadcast"]))
            results[how] = {kind: statistics.median(all_of) for kind, all_of in rates.items()} | {"faster": faster}
            print(f"{how:10} {results[how]['sorted']:7.2f} frames/s, {results[how]['broadcast']:7.2f} without sorting: "
                  f"{faster:.2f} times", flush=True)
            if how == "immediate" and faster < LEAST_FASTER:
                missed.append(f"{how}: {faster:.2f} times, at least {LEAST_FASTER} wanted")
        before = elements_of(wall)
        few, many = 10, 60
        run(wall, "buffers", few, options.triangles, x.environment())
        between = elements_of(wall)
        _, elements = run(wall, "buffers", many, options.triangles, x.environment())
        # The frames that are not steady are in both.
        processed = (elements_of(wall) - between - (between - before)) / (many - few) / elements
        results["processed"] = processed
        print(f"all nodes together process {processed:.3f} times the band's elements a frame, at most {MOST_PROCESSED} "
              f"wanted", flush=True)
        if processed > MOST_PROCESSED:
            missed.append(f"{processed:.2f} times the elements, at most {MOST_PROCESSED} wanted")
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    for line in missed:
        print(line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
