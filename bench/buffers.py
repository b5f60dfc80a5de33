#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Meshes in buffer objects (bench/buffers.cpp): frames a second on plain Mesa, on one tile and on 2x2, taken in turns,
what travels for a frame once the nodes have the buffers, how much of the mesh all nodes together process, and how soon
a node that comes late has all of a program's objects.

buffers.py [--rounds N] [--json FILE]      exit code 1 if a figure is below its bar
"""
from __future__ import annotations

import argparse
import json
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

SIDE = 600  # pixels
TILES = ((1, 1), (2, 2))
# Options of the program, frames, and the least frames a second by those of Mesa, by wall; None: no bar.
CASES = {
    "static": ([], 40, {(1, 1): 0.95, (2, 2): 0.8}),
    "static, GLSL": (["--glsl"], 40, {(1, 1): 0.95, (2, 2): 0.8}),
    "rewritten": (["--rewrite"], 15, {(1, 1): None, (2, 2): None}),
    "100,000 draws": (["--draws", "100000"], 5, {(1, 1): 0.7, (2, 2): None}),
}
MOST_BYTES = 200  # of a static mesh, a touched node and frame
MESH_ELEMENTS = 3 * 1_001_000  # of the large mesh
MOST_PROCESSED = 1.3  # of a static mesh, on 2x2 tiles, by all nodes together
STEADY = ("state_bytes", "geometry_bytes")


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


def on_wall(tiles: tuple[int, int], program: list[str], x: XServer) -> tuple[float, dict[str, float]]:
    size = (SIDE // tiles[0], SIDE // tiles[1])
    with Wall(tiles=tiles, tile_size=size, name="buffers",
              swap_timeout_ms=10000) as wall, tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        rate = run(wall.wallrun(*program), x.environment(WALLGL_STATS=str(stats)))
        counted = json.loads(stats.read_text())
        elements = elements_of(wall)
    return rate, {"elements": elements / counted["frames"],
                  "steady": sum(counted["total"][kind] for kind in STEADY) / counted["frames"] / len(counted["nodes"]),
                  "objects": counted["total"]["object_bytes"] / counted["frames"]}


def measure(options: list[str], frames: int, rounds: int, x: XServer) -> dict:
    program = [str(build_folder() / "bench" / "buffers"), "--size", f"{SIDE}x{SIDE}", "--frames", str(frames), *options]
    rates: dict[str, list[float]] = {"Mesa": [], **{f"{c}x{r}": [] for c, r in TILES}}
    bytes_of = {}
    for _ in range(rounds):
        rates["Mesa"].append(run(program, x.environment()))
        for tiles in TILES:
            name = f"{tiles[0]}x{tiles[1]}"
            rate, bytes_of[name] = on_wall(tiles, program, x)
            rates[name].append(rate)
    return {"frames_per_second": {name: statistics.median(values) for name, values in rates.items()},
            "bytes": bytes_of}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=3)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results, missed = {}, []
    with XServer() as x:
        for case, (flags, frames, bars) in CASES.items():
            results[case] = result = measure(flags, frames, options.rounds, x)
            mesa = result["frames_per_second"]["Mesa"]
            print(f"{case:14} Mesa {mesa:8.1f} frames/s", flush=True)
            for tiles, bar in bars.items():
                name = f"{tiles[0]}x{tiles[1]}"
                rate, sent = result["frames_per_second"][name], result["bytes"][name]
                wanted = f", at least {bar} wanted" if bar else ""
                print(f"{case:14} {name}  {rate:8.1f} frames/s, {rate / mesa:.2f} of Mesa{wanted}; "
                      f"{sent['steady']:,.0f} bytes a node and frame, objects {sent['objects']:,.0f} a frame",
                      flush=True)
                processed = sent["elements"] / MESH_ELEMENTS
                if not case.startswith("100,000"):
                    print(f"{case:14} {name}  {processed:.2f} times the mesh's elements processed a frame", flush=True)
                if case.startswith("static") and processed > MOST_PROCESSED:
                    missed.append(f"{case} {name}: {processed:.2f} times its elements, at most {MOST_PROCESSED} wanted")
                if bar and rate < bar * mesa:
                    missed.append(f"{case} {name}: {rate / mesa:.2f}, at least {bar} wanted")
                if case.startswith("static") and sent["steady"] > MOST_BYTES:
                    missed.append(f"{case} {name}: {sent['steady']:.0f} bytes, at most {MOST_BYTES} wanted")
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    for line in missed:
        print(line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
