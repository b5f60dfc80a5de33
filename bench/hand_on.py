#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What it gains that nodes hand on to each other what several of them need (docs/hand-on.md), on machines that are
network namespaces whose links have a rate, each over TLS.

A film: frames a second of a program that writes a texture anew for every frame, on walls of one, two, four and eight
nodes, with and without handing on. A picture: seconds until all nodes have drawn a texture that is written once. The
limit is the program's link, over which every byte goes once.

hand_on.py [--rate RATE] [--rounds N] [--json FILE]      exit code 1 if a figure is below its bar
"""
from __future__ import annotations

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from machine_wall import MachineWall  # noqa: E402
from wall import build_folder  # noqa: E402
from xserver import XServer  # noqa: E402

TILE = (100, 100)  # pixels: what nodes draw shall not be what takes long
NODES = (1, 2, 4, 8)
FILM, FILM_FRAMES = (640, 360), 40
STILL = (1280, 1280)  # 6.3 MiB
LEAST_OF_LIMIT = 0.8  # of the program's link, by eight nodes
LEAST_GAINED = 4.0  # by eight nodes


def megabits(rate: str) -> float:
    number, unit = re.fullmatch(r"(\d+)(mbit|gbit)", rate).groups()
    return float(number) * {"mbit": 1, "gbit": 1000}[unit]


def run(wall: MachineWall, x: XServer, hand_on: bool, picture: tuple[int, int], *options: object) -> str:
    """What the program says; its window is over all tiles."""
    width = TILE[0] * wall.tiles[0]
    environment = x.environment(WALLGL_HAND_ON="1" if hand_on else "0", WALLGL_CODING="0")
    app = wall.run_at("desk", build_folder() / "bench" / "cinema", "--window", f"{width}x{TILE[1]}", "--picture",
                      f"{picture[0]}x{picture[1]}", *options, rect=(0, 0, width, TILE[1]), env=environment,
                      stdout=subprocess.PIPE, text=True)
    said, _ = app.communicate(timeout=240)
    if app.returncode != 0:
        raise RuntimeError(f"cinema ended with {app.returncode}")
    return said


def film(wall: MachineWall, x: XServer, hand_on: bool) -> float:
    said = run(wall, x, hand_on, FILM, "--frames", FILM_FRAMES)
    return float(re.search(r"([\d.]+) frames/s", said).group(1))


def still(wall: MachineWall, x: XServer, hand_on: bool) -> float:
    said = run(wall, x, hand_on, STILL, "--still", "--frames", 1)
    return float(re.search(r"after ([\d.]+) s", said).group(1))


def measure(nodes: int, rate: str, x: XServer, rounds: int) -> dict:
    measured: dict[str, dict[str, list[float]]] = {"film": {}, "still": {}}
    with MachineWall((nodes, 1), TILE, swap_timeout_ms=10000, environment={"LP_NUM_THREADS": "0"}) as wall:
        for host in ("desk", *wall.node_names):
            wall.hosts.limit(host, rate)
        for _ in range(rounds):
            for hand_on in (False, True):
                how = "handed on" if hand_on else "to each"
                measured["film"].setdefault(how, []).append(film(wall, x, hand_on))
                measured["still"].setdefault(how, []).append(still(wall, x, hand_on))
    return {what: {how: statistics.median(values) for how, values in by.items()} for what, by in measured.items()}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rate", default="100mbit", help="of each machine's link, as tc has it: 100mbit, 1gbit")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--nodes", type=int, nargs="*", default=NODES)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rate = megabits(options.rate)
    limit = rate * 1e6 / 8 / (4 * FILM[0] * FILM[1])
    least_seconds = 4 * STILL[0] * STILL[1] * 8 / (rate * 1e6)
    print(f"links of {rate:.0f} Mbit/s: a film of {FILM[0]}x{FILM[1]}, at most {limit:.1f} frames/s; a picture of "
          f"{STILL[0]}x{STILL[1]}, at least {least_seconds:.2f} s")
    figures = {}
    with XServer() as x:
        for nodes in options.nodes:
            figures[nodes] = now = measure(nodes, options.rate, x, options.rounds)
            print(f"{nodes} nodes: film {now['film']['to each']:.2f} frames/s, handed on "
                  f"{now['film']['handed on']:.2f}; picture {now['still']['to each']:.2f} s, handed on "
                  f"{now['still']['handed on']:.2f} s", flush=True)
    most = max(figures)
    gained = figures[most]["film"]["handed on"] / figures[most]["film"]["to each"]
    kept = figures[most]["film"]["handed on"] / limit
    print(f"{most} nodes: {gained:.2f} times as fast, {kept:.2f} of the program's link; wanted of 8: {LEAST_GAINED} "
          f"and {LEAST_OF_LIMIT}")
    if options.json:
        options.json.write_text(json.dumps({"cores": os.cpu_count(), "rate_mbit": rate, "limit_frames": limit,
                                            "least_seconds": least_seconds, "gained": gained, "of_limit": kept,
                                            "nodes": figures}, indent=1) + "\n")
    return 1 if most == 8 and (gained < LEAST_GAINED or kept < LEAST_OF_LIMIT) else 0


if __name__ == "__main__":
    sys.exit(main())
