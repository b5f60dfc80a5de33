#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What it gains that each node draws only its part of a framebuffer object that is copied to the window as it is
(docs/framebuffers.md, "Drawn in parts"): a mesh of 1,001,000 triangles in buffers, drawn off the window
(bench/buffers.cpp) on plain Mesa and on 2x2 tiles, in parts and by every node as a whole, taken in turns.

off_window.py [--rounds N] [--json FILE]      exit code 1 if it is no faster in parts, or more is processed than wanted
"""
from __future__ import annotations

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIDE, TILES, FRAMES = 600, (2, 2), 40
PROGRAM = [str(build_folder() / "bench" / "buffers"), "--off-window", "--size", f"{SIDE}x{SIDE}", "--frames",
           str(FRAMES)]
ELEMENTS = 3 * 1_001_000  # of the mesh
CASES = {"fixed function": [], "GLSL": ["--glsl"]}
MOST_PROCESSED = 1.3  # of the mesh, by all nodes together, in parts
WARM_UP = 10  # frames, of which the first eight are drawn as a whole


def run(command: list[str], environment: dict[str, str]) -> float:
    """Frames a second, as the program says."""
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300)
    return float(re.search(r"([\d.]+) frames/s", done.stdout)[1])


def elements_of(wall: Wall) -> int:
    """What all nodes have processed, when they have said so: they do once a second."""
    def now() -> int:
        return sum(node["array_elements"] for node in wall.nodes())
    before = -1
    while (after := now()) != before:
        before = after
        time.sleep(2.5)
    return after


def on_wall(in_parts: bool, options: list[str], x: XServer) -> dict[str, float]:
    size = (SIDE // TILES[0], SIDE // TILES[1])
    with Wall(tiles=TILES, tile_size=size, name="off-window",
              swap_timeout_ms=10000) as wall, tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        rate = run(wall.wallrun(*PROGRAM, *options),
                   x.environment(WALLGL_STATS=str(stats), WALLGL_DRAWN_PARTS="1" if in_parts else "0"))
        counted = json.loads(stats.read_text())
        elements = elements_of(wall)
    whole = TILES[0] * TILES[1] * ELEMENTS * (8 if in_parts else 0)
    frames = FRAMES + WARM_UP - (8 if in_parts else 0)
    return {"frames_per_second": rate, "processed": (elements - whole) / frames / ELEMENTS,
            "geometry_bytes": counted["total"]["geometry_bytes"] / counted["frames"]}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results, missed = {}, []
    with XServer() as x:
        for case, flags in CASES.items():
            mesa, parts, whole = [], [], []
            for _ in range(options.rounds):
                mesa.append(run([*PROGRAM, *flags], x.environment()))
                parts.append(on_wall(True, flags, x))
                whole.append(on_wall(False, flags, x))
            rate = {how: statistics.median(one["frames_per_second"] for one in runs)
                    for how, runs in (("parts", parts), ("whole", whole))}
            rate["Mesa"] = statistics.median(mesa)
            processed = {how: runs[-1]["processed"] for how, runs in (("parts", parts), ("whole", whole))}
            results[case] = {"frames_per_second": rate, "processed": processed}
            print(f"{case:15} Mesa {rate['Mesa']:.1f} frames/s; 2x2 in parts {rate['parts']:.1f}, as a whole "
                  f"{rate['whole']:.1f}: {rate['parts'] / rate['whole']:.2f} times as fast; processed a frame "
                  f"{processed['parts']:.2f} and {processed['whole']:.2f} times the mesh", flush=True)
            if rate["parts"] <= rate["whole"]:
                missed.append(f"{case}: {rate['parts'] / rate['whole']:.2f} times as fast, more than 1 wanted")
            if processed["parts"] > MOST_PROCESSED:
                missed.append(f"{case}: {processed['parts']:.2f} times its elements, at most {MOST_PROCESSED} wanted")
    if options.json:
        options.json.write_text(json.dumps({"cores": os.cpu_count(), **results}, indent=1) + "\n")
    for line in missed:
        print(line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
