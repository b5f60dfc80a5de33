#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Packing rate of immediate mode: WallGL on a 1x1 wall against the bare packer behind GLVND, in turn, several rounds;
the best round of each counts, since whatever else the machine does only slows one down.

pack.py [--rounds N] [--json FILE] [FILTER]     exit code 1 below the bar
"""
from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

BAR = 0.94  # of the bare packer with a box
BARRED = "Vertex3f"
VENDORS = {"bare": "bare packer", "box": "bare packer with box", "wallgl": "WallGL"}


def measure(command: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Million vertices a second of each benchmark."""
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=120)
    report = json.loads(done.stdout)
    return {entry["name"]: entry["items_per_second"] / 1e6 for entry in report["benchmarks"]}


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--json", type=Path)
    arguments.add_argument("filter", nargs="?", default=".*")
    options = arguments.parse_args()
    folder = build_folder() / "bench"
    program = [str(folder / "pack_bench"), "--benchmark_format=json", "--benchmark_min_time=0.5",
               f"--benchmark_filter={options.filter}"]
    best: dict[str, dict[str, float]] = {vendor: {} for vendor in VENDORS}
    with XServer() as x, Wall(tiles=(1, 1), tile_size=(256, 256), name="pack") as wall:
        library_path = f"{folder / 'bare'}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        bare = x.environment(__GLX_VENDOR_LIBRARY_NAME="wallbare", LD_LIBRARY_PATH=library_path)
        runs = {"bare": (program, dict(bare, WALLBARE_BOX="0")), "box": (program, dict(bare, WALLBARE_BOX="1")),
                "wallgl": (wall.wallrun(*program), x.environment())}
        for _ in range(options.rounds):
            for vendor, (command, environment) in runs.items():
                for name, rate in measure(command, environment).items():
                    best[vendor][name] = max(rate, best[vendor].get(name, 0))
    print("M vertices/s".ljust(30) + "".join(title.rjust(24) for title in VENDORS.values()) + "   WallGL / with box")
    for name in best["bare"]:
        row = [best[vendor][name] for vendor in VENDORS]
        print(name.ljust(30) + "".join(f"{rate:24.1f}" for rate in row) + f"{row[2] / row[1]:20.2f}")
    if options.json:
        options.json.write_text(json.dumps(best, indent=1) + "\n")
    reached = best["wallgl"].get(BARRED, BAR) / best["box"].get(BARRED, 1) if BARRED in best["box"] else BAR
    print(f"{BARRED}: {reached:.2f} of the bare packer with a box, at least {BAR} wanted")
    return 0 if reached >= BAR else 1


if __name__ == "__main__":
    sys.exit(main())
