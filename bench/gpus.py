#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What several GPUs of a machine gain (docs/gpus.md; OCTAVIS, section 5): frames a second of a mesh of a million
triangles that the nodes keep, and of atlantis, on walls of two and three tiles that one GPU draws, or a GPU for each in
one tileserver, or a tileserver for each. Contexts of the software renderer stand for GPUs, each with the one thread
that tells it. All walls stand side by side and have their turns; medians.

Then what moving tiles by measured cost gains (OCTAVIS, section 5.3): two windows of that mesh lie on the two tiles of
2x2 that one of two GPUs was dealt; frames a second of both together as it was dealt, and after the wall has moved one.

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
import time
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / "tests" / "support"), str(Path(__file__).resolve().parent)]
from fair import rates  # noqa: E402
from planned_wall import PlannedWall  # noqa: E402
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (300, 600)  # pixels
MESH, ATLANTIS = "mesh", "atlantis"
FOREVER = "1000000"  # frames
LEAST_FASTER = {MESH: 1.7, ATLANTIS: 1.3}  # two GPUs, by one
MOST_LOST = 0.05  # three GPUs of a tileserver, by three tileservers
SIDE = 300  # pixels of each of 2x2 tiles
SQUARES = {name: (x * SIDE, y * SIDE, SIDE, SIDE) for name, (x, y) in
           {"one": (0, 0), "two": (1, 0), "three": (0, 1), "four": (1, 1)}.items()}
DEALT = {"one": 0, "two": 1, "three": 1, "four": 0}  # as gpus = 2 does
LEAST_GAINED = 1.3  # by a move
MOVES_WITHIN = 60.0  # seconds


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


def meshes(wall: Wall, x: XServer, costly: tuple[str, ...]) -> list[int]:
    """Sessions: a window of the mesh on each of these tiles."""
    out = []
    for tile in costly:
        left, top, width, height = SQUARES[tile]
        app = wall.run(build_folder() / "bench" / "buffers", "--size", f"{width}x{height}", "--frames", FOREVER,
                       rect=(left, top, width, height), env=x.environment(vblank_mode="0"), stdout=subprocess.DEVNULL)
        out.append(wall.wait_session(app))
    for session in out:
        wall.wait(session, 5, limit=60)
    return out


def uneven(x: XServer, rounds: int, seconds: float) -> dict[str, list[float]]:
    """Frames a second of both windows, as dealt and moved, side by side and in turns."""
    costly = ("one", "four")
    measured: dict[str, list[float]] = {"as dealt": [], "moved": []}
    keys = {tile: f"gpu = {gpu}" for tile, gpu in DEALT.items()}
    for _ in range(rounds):
        for how, options in {"as dealt": {"keys": keys}, "moved": {"node_keys": {"a": "gpus = 2"}}}.items():
            with PlannedWall({"a": SQUARES}, name="gpus", swap_timeout_ms=10000, environment={"LP_NUM_THREADS": "0"},
                             **options) as wall:
                sessions = meshes(wall, x, costly)
                end = time.monotonic() + MOVES_WITHIN
                while how == "moved" and len({t["node"] for t in wall.ctl("tiles") if t["name"] in costly}) == 1:
                    if time.monotonic() > end:
                        sys.exit("no tile has moved")
                    time.sleep(0.2)
                measured[how].append(sum(rates(wall, seconds, *sessions)))
    return measured


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
        measured = uneven(x, options.rounds, options.seconds)
        results["uneven on 2x2"] = {"frames_per_second": {how: statistics.median(values)
                                                          for how, values in measured.items()}, "all": measured}
    missed = []
    both = results["uneven on 2x2"]["frames_per_second"]
    gained = both["moved"] / both["as dealt"]
    print(f"two meshes on one of two GPUs: {both['as dealt']:.1f} frames/s, {both['moved']:.1f} after a tile has "
          f"moved: {gained:.2f} times as many, at least {LEAST_GAINED} wanted")
    if gained < LEAST_GAINED:
        missed.append("uneven")
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
