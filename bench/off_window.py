#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What it gains that each node draws only its part of a framebuffer object that is brought to the window as it is
(docs/framebuffers.md, "Drawn in parts"), by a blit or as a texture: a mesh of 1,001,000 triangles in buffers, drawn off
the window (bench/buffers.cpp) on plain Mesa and on 2x2 tiles, in parts and by every node as a whole, taken in turns.

off_window.py [--rounds N] [--json FILE]      exit code 1 if it is no faster in parts, or more is processed than wanted
"""
from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from buffers import MESH_ELEMENTS as ELEMENTS, MOST_PROCESSED, elements_of, run  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIDE, TILES, FRAMES = 600, (2, 2), 40
PROGRAM = [str(build_folder() / "bench" / "buffers"), "--off-window", "--size", f"{SIDE}x{SIDE}", "--frames",
           str(FRAMES)]
CASES = {"fixed function": [], "GLSL": ["--glsl"], "as a texture": ["--as-texture"]}
WARM_UP = 10  # frames, of which the first eight are drawn as a whole


def on_wall(in_parts: bool, options: list[str], x: XServer) -> dict[str, float]:
    size = (SIDE // TILES[0], SIDE // TILES[1])
    with Wall(tiles=TILES, tile_size=size, name="off-window", swap_timeout_ms=10000) as wall:
        rate = run(wall.wallrun(*PROGRAM, *options), x.environment(WALLGL_DRAWN_PARTS="1" if in_parts else "0"))
        elements = elements_of(wall)
    whole = TILES[0] * TILES[1] * ELEMENTS * (8 if in_parts else 0)
    frames = FRAMES + WARM_UP - (8 if in_parts else 0)
    return {"frames_per_second": rate, "processed": (elements - whole) / frames / ELEMENTS}


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
