#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A mesh of 35,156 small triangles in immediate mode (bench/mesh.cpp): bytes a frame on one tile and on 2x2, and frames
a second there and on plain Mesa.

mesh.py [--frames N] [--json FILE]      exit code 1 if 2x2 tiles cost more than 1.04 times the bytes of one
"""
from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

SIZE = (800, 600)
BAR = 1.04


def run(command: list[str], environment: dict[str, str]) -> float:
    """Frames a second, as the program says."""
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300)
    return float(re.search(r"([\d.]+) frames/s", done.stdout)[1])


def on_wall(tiles: tuple[int, int], program: list[str], x: XServer) -> dict:
    size = (SIZE[0] // tiles[0], SIZE[1] // tiles[1])
    with Wall(tiles=tiles, tile_size=size, name="mesh",
              swap_timeout_ms=10000) as wall, tempfile.TemporaryDirectory() as folder:
        stats = Path(folder) / "stats.json"
        rate = run(wall.wallrun(*program), x.environment(WALLGL_STATS=str(stats)))
        counted = json.loads(stats.read_text())
    return {"frames_per_second": rate, "bytes_per_frame": sum(counted["total"][kind] for kind in
            ("state_bytes", "object_bytes", "geometry_bytes")) / counted["frames"]}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--frames", type=int, default=60)
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results: dict[str, dict] = {}
    with XServer() as x:
        for kind, flags in (("one Begin", []), ("strips", ["--strips"])):
            program = [str(build_folder() / "bench" / "mesh"), "--size", f"{SIZE[0]}x{SIZE[1]}",
                       "--frames", str(options.frames), *flags]
            results[kind] = {"Mesa": {"frames_per_second": run(program, x.environment())}}
            for tiles in ((1, 1), (2, 2)):
                results[kind][f"{tiles[0]}x{tiles[1]}"] = on_wall(tiles, program, x)
            for where, figures in results[kind].items():
                print(f"{kind:10} {where:5} {figures['frames_per_second']:8.1f} frames/s "
                      f"{figures.get('bytes_per_frame', 0):12,.0f} bytes a frame", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    growth = max(result["2x2"]["bytes_per_frame"] / result["1x1"]["bytes_per_frame"] for result in results.values())
    print(f"bytes of 2x2 tiles to one: {growth:.3f}, at most {BAR} wanted")
    return 0 if growth <= BAR else 1


if __name__ == "__main__":
    sys.exit(main())
