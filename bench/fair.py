#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What a greedy program costs the others on a wall that all share at equal weights: frames a second of a program that
wants 30, alone and beside each kind of greed. Both take turns; the median of several rounds. On 2x1 tiles of one node.

fair.py [--rounds N] [--seconds S] [--json FILE]
exit code 1 if the program has less than 80 % of the frames that it has alone, beside any of them
"""
from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from wall import Wall, build_folder, end_all  # noqa: E402
from xserver import XServer  # noqa: E402

BAR = 0.8
FPS = 30  # that the other program wants
TILE = (640, 480)
MODEST, GREEDY = (0, 0, 320, 480), (320, 0, 960, 480)
PROGRAMS = build_folder() / "tests"
GREED = {  # what it wants all of
    "frames": ["frame_clock"],
    "vertices": ["frame_clock", "--vertices", "300000"],
    "bandwidth": ["hungry", "--write", "16", "--fps", "0"],
    "pixels": ["hungry", "--keep", "64", "--fps", "0"],
}


def rates(wall: Wall, seconds: float, *sessions: int) -> list[float]:
    """Frames a second that the wall shows of each."""
    def frames() -> dict[int, int]:
        return {s["id"]: s["surfaces"][0]["frame"] for s in wall.sessions() if s["surfaces"]}
    begin, first = time.monotonic(), frames()
    time.sleep(seconds)
    last, spent = frames(), time.monotonic() - begin
    return [(last[session] - first[session]) / spent for session in sessions]


def start(wall: Wall, x: XServer, rect: tuple[int, int, int, int],
          program: list[str]) -> tuple[subprocess.Popen, int]:
    app = wall.run(PROGRAMS / program[0], "--size", f"{rect[2]}x{rect[3]}", *program[1:], rect=rect,
                   env=x.environment(), stdout=subprocess.DEVNULL)
    session = wall.wait_session(app)
    wall.wait(session, 3, limit=60)
    return app, session


def measure(options: argparse.Namespace, x: XServer) -> dict[str, dict]:
    out = {}
    with Wall(tiles=(2, 1), tile_size=TILE, one_node=True, name="fair", swap_timeout_ms=10000) as wall:
        _, modest = start(wall, x, MODEST, ["frame_clock", "--fps", str(FPS)])
        for kind, program in GREED.items():
            alone, beside, its = [], [], []
            for _ in range(options.rounds):
                alone += rates(wall, options.seconds, modest)
                app, greedy = start(wall, x, GREEDY, program)
                time.sleep(options.seconds)  # it has taken what it can get
                with_it, greedy_rate = rates(wall, options.seconds, modest, greedy)
                beside.append(with_it)
                its.append(greedy_rate)
                end_all([app])
            medians = {name: statistics.median(values)
                       for name, values in (("alone", alone), ("beside", beside), ("greedy", its))}
            out[kind] = {**medians, "kept": medians["beside"] / medians["alone"]}
    return out


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    with XServer() as x:
        found = measure(options, x)
    print(f"{'greed for':<12}{'alone':>8}{'beside':>8}{'kept':>7}{'its own':>9}   frames/s")
    for kind, row in found.items():
        print(f"{kind:<12}{row['alone']:>8.1f}{row['beside']:>8.1f}{row['kept']:>7.2f}{row['greedy']:>9.1f}")
    if options.json:
        options.json.write_text(json.dumps(found, indent=1) + "\n")
    return 0 if all(row["kept"] >= BAR for row in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
