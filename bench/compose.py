#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What it gains that the nodes that draw also put together what they have drawn (docs/sort-last.md, `role` "compose"),
where they draw over each other's pixels: frames a second of sheets that each cover the whole window (bench/layers.cpp),
drawn by one, two, four and eight nodes for one that shows them, which compose or do not. Machines are network
namespaces whose links have a rate, each over TLS.

compose.py [--rate RATE] [--rounds N] [--seconds S] [--json FILE]      exit code 1 if a figure is below its bar
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
from machine_wall import MachineWall  # noqa: E402
from wall import build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

SIZE = (480, 270)  # pixels of the tile
NODES = (1, 2, 4, 8)
SHEETS = 8
HOW = {"shown": 'role = "render"', "composed": 'role = ["render", "compose"]'}
LEAST_GAINED = 2.0  # by eight nodes


def wall_of(nodes: int, how: str) -> MachineWall:
    """Pictures go as they are, so that the bytes are those of pixels."""
    keys = HOW[how] + '\npartial_codec = "none"'
    return MachineWall((1, 1), SIZE, node_keys='role = "display"', workers={f"draws{i}": keys for i in range(nodes)},
                       swap_timeout_ms=10000, environment={"LP_NUM_THREADS": "0"})


@contextlib.contextmanager
def layers(wall: MachineWall, x: XServer):
    app = wall.run_at("desk", build_folder() / "bench" / "layers", "--sheets", SHEETS, "--size",
                      f"{SIZE[0]}x{SIZE[1]}", rect=(0, 0, *SIZE), sort_last=True, env=x.environment(vblank_mode="0"),
                      stdout=subprocess.DEVNULL)
    session = wall.wait_session(app)
    wall.wait(session, 10, limit=60)
    try:
        yield session
    finally:
        end_all([app])


def figures_of(nodes: int, how: str, rate: str, x: XServer, rounds: int, seconds: float) -> dict[str, float]:
    """Frames a second, and bytes a frame that the node that shows them has got."""
    with wall_of(nodes, how) as wall:
        for host in ("desk", *wall.node_names):
            wall.hosts.limit(host, rate)
        with layers(wall, x) as session:
            state = lambda: (next(n for n in wall.nodes() if n["name"] == "node-0")["bytes_received"],  # noqa: E731
                             next(s for s in wall.sessions() if s["id"] == session)["surfaces"][0]["frame"])
            time.sleep(1)
            measured = []
            before = state()
            for _ in range(rounds):
                measured.append(rates(wall, seconds, session)[0])
            time.sleep(1.2)  # until its statistics have come
            after = state()
    return {"frames_per_second": statistics.median(measured),
            "bytes_a_frame": (after[0] - before[0]) / max(after[1] - before[1], 1)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rate", default="100mbit", help="of each machine's link, as tc has it: 100mbit, 1gbit")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--nodes", type=int, nargs="*", default=NODES)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    picture = 8 * SIZE[0] * SIZE[1]
    print(f"{SHEETS} sheets in {SIZE[0]}x{SIZE[1]} pixels, links of {options.rate}; a colour and a depth for each "
          f"pixel are {picture / 1e6:.2f} MB")
    figures: dict[int, dict[str, dict[str, float]]] = {}
    with XServer() as x:
        for nodes in options.nodes:
            figures[nodes] = {how: figures_of(nodes, how, options.rate, x, options.rounds, options.seconds)
                              for how in HOW}
            print(f"{nodes} nodes: " + ", ".join(
                f"{how} {now['frames_per_second']:.2f} frames/s, {now['bytes_a_frame'] / 1e6:.2f} MB a frame to it"
                for how, now in figures[nodes].items()), flush=True)
    most = max(figures)
    gained = figures[most]["composed"]["frames_per_second"] / figures[most]["shown"]["frames_per_second"]
    print(f"{most} nodes that compose are {gained:.2f} times as fast; wanted of 8: {LEAST_GAINED}")
    if options.json:
        options.json.write_text(json.dumps({"cores": os.cpu_count(), "rate": options.rate, "picture_bytes": picture,
                                            "gained": gained, "nodes": figures}, indent=1) + "\n")
    return 1 if most == 8 and gained < LEAST_GAINED else 0


if __name__ == "__main__":
    sys.exit(main())
