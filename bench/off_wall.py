#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a window costs half of which no tile shows, and which its program never reads: frames a second and the
program's processor time a frame, in turn with and without keeping what is drawn there (docs/off-the-wall.md).

off_wall.py [--rounds N] [--json FILE]     exit code 1 if keeping costs a program over 5 % of its frames a second
"""
from __future__ import annotations

import argparse
import json
import re
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1] / "tests"
sys.path[:0] = [str(TESTS / "support"), str(TESTS / "golden"), str(Path(__file__).resolve().parent)]
from traffic import ATLANTIS, record  # noqa: E402
from wall import Wall, build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

BAR = 0.95
TILE = (800, 600)
HALF_OFF = (TILE[0] // 2, 0, *TILE)  # of the window, on the wall


def run(command: list[str], environment: dict[str, str]) -> dict[str, float]:
    """Of a program that says its own frames a second: `glretrace -b` or bench/mesh."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True, timeout=300)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    said = re.search(r"Rendered (?P<frames>\d+) frames in .* average of (?P<rate>[\d.]+) fps|"
                     r"(?P<mesh>[\d.]+) frames/s", done.stdout)
    rate = float(said["rate"] or said["mesh"])
    seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    return {"frames_per_second": rate, "program_seconds": seconds}


def measure(program: list[str], rounds: int, x: XServer) -> dict[str, dict[str, float]]:
    """Medians of the rounds, and of the ratios of each."""
    figures: dict[str, list[dict[str, float]]] = {"kept": [], "not kept": []}
    with Wall(tiles=(1, 1), tile_size=TILE, name="off-wall", swap_timeout_ms=10000,
              environment={"LP_NUM_THREADS": "0"}) as wall:
        line = wall.wallrun(*program, rect=HALF_OFF)
        for _ in range(rounds):
            figures["kept"].append(run(line, x.environment()))
            figures["not kept"].append(run(line, x.environment(WALLGL_SHOWN_ONLY="1")))
    keys = figures["kept"][0].keys()
    told = {how: {key: statistics.median(each[key] for each in runs) for key in keys} for how, runs in figures.items()}
    told["ratio"] = {key: statistics.median(with_it[key] / without[key] for with_it, without in
                                            zip(figures["kept"], figures["not kept"])) for key in keys}
    return told


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--rounds", type=int, default=7)
    arguments.add_argument("--seconds", type=float, default=10, help="how long atlantis is recorded")
    arguments.add_argument("--json", type=Path)
    options = arguments.parse_args()
    results = {}
    with XServer() as x, tempfile.TemporaryDirectory() as folder:
        clip = record(ATLANTIS, options.seconds, Path(folder), x)
        mesh = [str(build_folder() / "bench" / "mesh"), "--size", f"{TILE[0]}x{TILE[1]}", "--frames", "200"]
        programs = {"atlantis": ["eglretrace", "-b", str(clip.path)], "a mesh, one Begin": mesh,
                    "a mesh, strips": [*mesh, "--strips"]}
        for name, program in programs.items():
            result = results[name] = measure(program, options.rounds, x)
            kept, without, ratio = result["kept"], result["not kept"], result["ratio"]
            print(f"{name:18} {kept['frames_per_second']:8.1f} frames/s, {without['frames_per_second']:8.1f} without "
                  f"keeping ({ratio['frames_per_second']:.3f}); the program's processor time "
                  f"{kept['program_seconds']:.2f} s, {without['program_seconds']:.2f} s "
                  f"({ratio['program_seconds']:.3f})", flush=True)
    if options.json:
        options.json.write_text(json.dumps(results, indent=1) + "\n")
    least = min(result["ratio"]["frames_per_second"] for result in results.values())
    print(f"frames a second, kept to not kept: {least:.3f}, at least {BAR} wanted")
    return 0 if least >= BAR else 1


if __name__ == "__main__":
    sys.exit(main())
