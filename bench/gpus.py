#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What several GPUs of a machine gain (docs/gpus.md; OCTAVIS, section 5): frames a second of a mesh of a million
triangles that the nodes keep, and of atlantis, on walls of two and three tiles that one GPU draws, or a GPU for each in
one tileserver, or a tileserver for each. Contexts of the software renderer stand for GPUs, each with the one thread
that tells it. All walls stand side by side and have their turns; medians.

gpus.py [--rounds N] [--seconds S] [--json FILE]      exit code 1 if a figure is below its bar
"""
from __future__ import annotations

import argparse
import contextlib
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / "tests" / "support"), str(Path(__file__).resolve().parent)]
from fair import rates  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (300, 600)  # pixels
MESH, ATLANTIS = "mesh", "atlantis"
FOREVER = "1000000"  # frames
LEAST_FASTER = {MESH: 1.7, ATLANTIS: 1.3}  # two GPUs, by one
MOST_LOST = 0.05  # three GPUs of a tileserver, by three tileservers


def program(name: str, columns: int) -> list[str]:
    size = f"{columns * TILE[0]}x{TILE[1]}"
    if name == ATLANTIS:
        return ["/usr/libexec/xscreensaver/atlantis", "--window", "--geometry", size, "-delay", "0"]
    return [str(build_folder() / "bench" / "buffers"), "--size", size, "--frames", FOREVER]


def walls(columns: int) -> dict[str, Wall]:
    """By what draws them."""
    def wall(**options) -> Wall:
        return Wall(tiles=(columns, 1), tile_size=TILE, name="gpus", swap_timeout_ms=10000,
                    environment={"LP_NUM_THREADS": "0"}, **options)
    return {"1 GPU": wall(one_node=True, gpus=1), f"{columns} GPUs": wall(one_node=True, gpus=columns),
            f"{columns} tileservers": wall()}


def rate(wall: Wall, x: XServer, name: str, columns: int, seconds: float) -> float:
    """Of the program, all over the wall."""
    app = wall.run(*program(name, columns), fullscreen=True, env=x.environment(vblank_mode="0"),
                   stdout=subprocess.DEVNULL)
    session = wall.wait_session(app)
    wall.wait(session, 5, limit=60)
    try:
        return rates(wall, seconds, session)[0]
    finally:
        end_all([app])
        while any(s["id"] == session for s in wall.sessions()):
            pass


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    results: dict[str, dict] = {}
    with XServer() as x:
        for columns in (2, 3):
            with contextlib.ExitStack() as stack:
                there = {how: stack.enter_context(wall) for how, wall in walls(columns).items()}
                for name in (MESH, ATLANTIS):
                    measured: dict[str, list[float]] = {how: [] for how in there}
                    for _ in range(options.rounds):
                        for how, wall in there.items():
                            measured[how].append(rate(wall, x, name, columns, options.seconds))
                    figures = {how: statistics.median(values) for how, values in measured.items()}
                    results[f"{name} on {columns}x1"] = {"frames_per_second": figures, "all": measured}
                    print(f"{name:9} on {columns}x1: " +
                          ", ".join(f"{how} {value:.1f} frames/s" for how, value in figures.items()), flush=True)
    missed = []
    for name, least in LEAST_FASTER.items():
        two = results[f"{name} on 2x1"]["frames_per_second"]
        faster = two["2 GPUs"] / two["1 GPU"]
        three = results[f"{name} on 3x1"]["frames_per_second"]
        kept = three["3 GPUs"] / three["3 tileservers"]
        print(f"{name}: two GPUs are {faster:.2f} times faster than one, at least {least} wanted; three have "
              f"{kept:.3f} of the frames of three tileservers, at least {1 - MOST_LOST} wanted")
        if faster < least or kept < 1 - MOST_LOST:
            missed.append(name)
    if options.json:
        options.json.write_text(json.dumps({"cores": os.cpu_count(), **results}, indent=1) + "\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
