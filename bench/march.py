#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A parallel program (examples/march) on 2x2 tiles: triangles a second from 1, 2 and 4 processes, beside one process on
plain Mesa. The triangles are computed and sent by the processes, and drawn by the tiles' nodes.

march.py [--frames N] [--cells N] [--json FILE]      exit code 1 if the last pictures of the runs on the wall are not
the same
"""
from __future__ import annotations

import argparse
import hashlib
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

TILES, TILE = (2, 2), (400, 300)
RANKS = (1, 2, 4)


def run(command: list[str], environment: dict[str, str], picture: Path) -> dict:
    """What all processes say together, and a sum of the last picture."""
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=600)
    said = [tuple(map(float, found)) for found in re.findall(r"([\d.]+) frames/s, ([\d.]+) triangles/s", done.stdout)]
    return {"frames_per_second": min(frames for frames, _ in said),
            "triangles_per_second": sum(triangles for _, triangles in said),
            "picture": hashlib.sha256(picture.read_bytes()).hexdigest()}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--frames", type=int, default=60)
    arguments.add_argument("--cells", type=int, default=64)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results: dict[str, dict] = {}
    size = (TILES[0] * TILE[0], TILES[1] * TILE[1])
    with XServer() as x, Wall(tiles=TILES, tile_size=TILE, name="march",
                              swap_timeout_ms=10000) as wall, tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "last.ppm"
        program = [str(build_folder() / "examples" / "march"), "--size", f"{size[0]}x{size[1]}", "--cells",
                   str(options.cells),
                   "--frames", str(options.frames), "--picture", str(picture)]
        results["Mesa"] = run(program, x.environment(), picture)
        for ranks in RANKS:
            line = wall.wallrun(*program, rect=(0, 0, *size))
            line[1:1] = ["--parallel", str(ranks)]
            results[f"{ranks} on the wall"] = run(line, x.environment(), picture)
    for where, figures in results.items():
        print(f"{where:14} {figures['triangles_per_second']:12,.0f} triangles/s {figures['frames_per_second']:8.2f} "
              f"frames/s", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    same = len({results[f"{ranks} on the wall"]["picture"] for ranks in RANKS}) == 1
    print("the same picture from any number of processes" if same else "the pictures differ")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
